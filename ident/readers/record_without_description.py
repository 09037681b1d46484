"""A record without a matrix.yaml: a bare file, arrays or a table of the caller's, and what the caller states of it.

What is stated has the words of matrix.yaml and goes the same way: the same units, checks and refusals.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from ident.errors import Unusable
from ident.matrix import Matrix
from ident.readers.description import describe_actuator
from ident.readers.hold import with_hold
from ident.readers.run import read_run
from ident.readers.run_description import RunDescription, describe_run
from ident.readers.suggestion import suggestion
from ident.readers.table import Array, Table
from ident.units.quantity import shown
from ident.words.arguments import of_kind
from ident.words.nearest import did_you_mean
from ident.words.record_description import Stated
from ident.words.run_name import run_name

_OF_NO_RUN = ("units", "columns", "actuator")
_EXAMPLE = 'state them, as units={"command": "mm", "displacement": "mm"}'


def described(stated: Mapping[str, Any], file: str, name: str) -> RunDescription:
    """What is stated of the record in `file`, as an entry of matrix.yaml; `name` is its id where none is stated."""
    unknown = [key for key in stated if key not in Stated.__annotations__]
    if unknown:
        remedy = did_you_mean(unknown[0], Stated.__annotations__)
        raise Unusable("unknown-key", f"unknown key {unknown[0]!r}", file, remedy)
    for key in _OF_NO_RUN:
        of_kind(file, key, stated.get(key), Mapping[str, Any] | None)
    units, columns = stated.get("units") or {}, stated.get("columns") or {}
    for channel in (*columns, *(() if units else ("",))):
        if channel not in units:
            raise Unusable("missing-unit", f"no unit of {channel or 'any channel'} is stated", file, _EXAMPLE)
    channels = {channel: {"column": columns.get(channel, channel), "unit": unit} for channel, unit in units.items()}
    run = {key: list(value) if isinstance(value, tuple) else value for key, value in stated.items()}
    for key in _OF_NO_RUN:
        run.pop(key, None)
    return describe_run({"id": name, "file": file, "channels": channels, **run}, run_name(name))


def of_file(
    path: Path, parts: list[bytes], stated: Mapping[str, Any], read: Callable[[RunDescription], Table]
) -> Matrix:
    """The matrix of one file, which `read` makes a table of. What is to be stated is told with the file's columns.

    `parts` are its bytes, and those of the files beside it that `read` adds.
    """
    if not stated.get("units"):
        laid_out = {key: stated[key] for key in ("skip_rows", "dialect") if key in stated}
        some = {"units": {"command": "1", "displacement": "1"}, "sample_rate": "1 Hz"}
        table = read(described({**some, **laid_out}, path.name, path.stem))
        what = "a file without a matrix.yaml does not state its units"
        found = suggestion(table)
        asked = f"state them, as {found}" if found else f"{_EXAMPLE}, and the clock"
        made = f"make a data set of it: servoident init {path.name}"
        raise Unusable("missing-unit", what, path.name, f"{made}; or in Python {asked}; {table.listed()}")
    run = described(stated, path.name, path.stem)
    return _matrix(run, read(run), stated, parts)


def from_arrays(arrays: Mapping[str, ArrayLike], **stated: Unpack[Stated]) -> Matrix:
    """The matrix of one record: arrays (n,) by name, and what is known of them, in the words of matrix.yaml.

    Units are always stated: ``from_arrays({"command": u, "displacement": x}, sample_rate="4096 Hz",
    units={"command": "mm", "displacement": "mm"}, gain=7)``. Records of one actuator add up: ``first + second``.
    Raises Unusable as reading a file does.
    """
    of_kind("from_arrays", "arrays", arrays, Mapping[str, Any])
    columns = {name: np.asarray(values) for name, values in arrays.items()}

    def load(numbers: Sequence[int]) -> list[Array]:
        found = [(list(columns)[number], list(columns.values())[number]) for number in numbers]
        for name, values in found:
            if values.ndim != 1:
                what = f"{shown(name)!r} has the shape {values.shape}"
                raise Unusable("not-numeric", what, "arrays", "give arrays of one dimension")
        return [values for _, values in found]

    return _matrix(described(stated, "arrays", "run"), Table(tuple(columns), load), stated)


def from_table(table: Any, **stated: Unpack[Stated]) -> Matrix:
    """The matrix of one record in a table that speaks ``__arrow_c_stream__``, as those of pandas, polars, pyarrow.

    All else as :func:`from_arrays`.
    """
    import pyarrow as pa  # noqa: PLC0415

    if not hasattr(table, "__arrow_c_stream__"):
        what = f"{type(table).__name__} does not speak __arrow_c_stream__"
        raise Unusable("not-a-table", what, "table", "give a table of pandas, polars or pyarrow, or use from_arrays")
    read = pa.table(table)

    def load(numbers: Sequence[int]) -> list[Array]:
        return [read.column(number).to_numpy() for number in numbers]

    return _matrix(described(stated, "table", "run"), Table(tuple(read.column_names), load), stated)


def _matrix(run: RunDescription, table: Table, stated: Mapping[str, Any], parts: Sequence[bytes] = ()) -> Matrix:
    """The run as a matrix, hashed by the `parts` of its file, else by its samples."""
    read, told = read_run(run, table)
    actuator = describe_actuator({"serial": "unnamed", **(stated.get("actuator") or {})})
    digest = hashlib.sha256(json.dumps(stated, sort_keys=True, default=str).encode())
    for part in parts or [samples.tobytes() for one in read for samples in one.channels.values()]:
        digest.update(part)
    held, chosen = with_hold(read, [run.hold_stated] * len(read))
    runs = tuple(output for part in held for output in part.of_outputs(run.outputs))
    return Matrix(actuator, runs, digest.hexdigest(), notices=(*table.notices, *told, *chosen))
