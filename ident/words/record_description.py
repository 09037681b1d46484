"""What a caller states of a record that has no matrix.yaml, in the words that matrix.yaml has."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypedDict


class Stated(TypedDict, total=False):
    """What a caller states of a record. Units are always stated: nothing is guessed.

    `units` has the unit of each channel by its name, `columns` the column of those that are not called as the channel.
    The clock is a `sample_rate` ("4096 Hz") or `time` ({"column": "t", "unit": "s"}). All else as in matrix.yaml:
    quantities carry their units, as specimen={"mass": "0.87 kg"}.
    """

    units: Mapping[str, str]
    columns: Mapping[str, str | int]
    sample_rate: str
    time: Mapping[str, Any]
    actuator: Mapping[str, Any]
    id: str
    specimen: Mapping[str, str]
    gain: float | str
    amplitude: str
    kind: str
    hold: str
    output: str | list[str]
    use: str
    skip_rows: int
    dialect: Mapping[str, str | int]
    rows: tuple[int, int]
    split: Mapping[str, Any]
    trend: str
