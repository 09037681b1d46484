"""The least margins of the position loop in which an actuator is to work, for its acceptance sheet."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ident.bench.estimate import BenchEstimate
from ident.bench.least_squares import Solution
from ident.bench.model import DELAY, Model
from ident.bench.position_loop import AmplitudeMargin, margins, usual_amplitudes
from ident.bench.time_constant import DelayCheck
from ident.rig.regulator import PositionControl

Array = NDArray[np.float64]


def least_margins(solution: Solution, loop: PositionControl, delay: DelayCheck | None) -> dict[str, BenchEstimate]:
    """`gain_margin` (dB) and `phase_margin` (rad) over the amplitudes, each with its standard deviation.

    A delay that the records ask for is in the loop, with the T and B of the fit with a delay. A margin that no gain
    ends is left out, and both where the actuator stands.
    """
    model, known = solution.model, delay if delay is not None and delay.doubt else None
    amplitudes = loop.amplitudes or usual_amplitudes(model)

    @cache
    def at_point(point: tuple[tuple[str, float], ...], late: float) -> list[AmplitudeMargin]:
        values = dict(point)
        moved = {**values, **({} if known is None else _beside(known, model, values)), DELAY: late}
        at = model.with_values(moved)
        return [margins(at, loop.regulator, amplitude) for amplitude in amplitudes]

    def with_values(values: Mapping[str, float], late: float) -> list[AmplitudeMargin]:
        return at_point(tuple(values.items()), late)  # both margins are of the same loops

    late = 0.0 if known is None else max(known.delay.value, 0.0)
    here = with_values(solution.values, late)
    found = {}
    for name, unit in (("gain_margin", "dB"), ("phase_margin", "rad")):
        value = _least(here, name)
        if value is None:
            continue

        def of(values: Mapping[str, Array], name: str = name) -> Array:
            rows = ({key: float(column[i]) for key, column in values.items()} for i in range(_length(values)))
            return np.array([_number(_least(with_values(row, late), name)) for row in rows])

        deviation = solution.deviation(of)
        if known is not None:
            later = _number(_least(with_values(solution.values, late + known.delay.deviation), name))
            deviation = math.hypot(deviation, later - value)
        found[name] = BenchEstimate(value, deviation, unit)
    return found


def _beside(known: DelayCheck, model: Model, values: Mapping[str, float]) -> dict[str, float]:
    """T and B of the fit with a delay, moved as the values are from those of the model."""
    return {"T": known.T + values["T"] - model.T, "B": known.B + values["B"] - model.B}


def _length(values: Mapping[str, Array]) -> int:
    return max(np.size(column) for column in values.values())


def _least(found: Iterable[AmplitudeMargin], name: str) -> float | None:
    """The smallest margin of this name, SI; None where there is none."""
    known = [value for one in found if (value := getattr(one, name)) is not None]
    return None if not known else math.radians(min(known)) if name == "phase_margin" else min(known)


def _number(value: float | None) -> float:
    return math.nan if value is None else value
