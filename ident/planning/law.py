"""The laws of Kononykhin's procedures as a control unit plays them: a file of what is set, and what it does with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.synthesis.bench_laws import CONTINUOUS, FREQUENCY, LEVELS, STATIC
from ident.synthesis.bench_matrix import RATE, STEEPEST, Plan
from ident.units.quantity import quantity

Array = NDArray[np.float64]
SETTINGS: Mapping[int, tuple[str, ...]] = {
    STATIC: ("offset", "gain", "rate", "width"),
    FREQUENCY: ("offset", "amplitude", "frequency", "compensation"),
    LEVELS: ("offset", "level", "length", "rest"),
    CONTINUOUS: ("offset", "lowest", "highest", "travel"),
}
"""The names of a law's settings: currents in rated currents, lengths in m, times in s, gains in rated currents a m."""
TEXTS: Mapping[int, str] = {
    STATIC: (
        "Closed loop on the position: at every sample current = offset + gain x (set position - position), the set "
        "position being the column of the file. Begin at the file's first position."
    ),
    FREQUENCY: (
        "Current from the file, plus a compensation c of the drift: c is 0 in the first two periods; at the end of "
        "each later period c decreases by `compensation` x (mean position of this period - that of the one before). "
        "It changes between periods only. Bring the link to `start`, let periods run until the mean position stands, "
        "and record the number of periods in the file."
    ),
    LEVELS: "Current from the file: a level, a rest, the level with the other sign, a rest. Bring the link to `start`.",
    CONTINUOUS: (
        "Current by the position, from the file: from `start` forth with the current of the way done so far, until "
        "97 % of the travel; then back with the other sign, and so on until the time is over."
    ),
}
"""What the control unit does."""
_POINTS = 200  # of a current over the position


@dataclass(frozen=True)
class Law:
    """A record of a bench: its law, the settings in the order of :data:`SETTINGS`, length (s), first position (m)."""

    number: int
    settings: tuple[float, ...]
    seconds: float
    start: float
    position_range: tuple[float, ...] = ()

    @classmethod
    def of(cls, plan: Plan) -> Law:
        """The law of one record of :func:`ident.synthesis.bench_matrix.plans`."""
        around = tuple(quantity(end, "m", "position_range") for end in plan.labels.get("position_range", ()))
        return cls(plan.law, plan.settings, plan.seconds, plan.start, around)

    @property
    def named(self) -> dict[str, float]:
        """The settings by name."""
        return dict(zip(SETTINGS[self.number], self.settings, strict=True))

    @property
    def size(self) -> float:
        """What is scaled of it: the current of sine, level or stroke, in rated currents; the width of a tooth, m."""
        return self.settings[{STATIC: 3, FREQUENCY: 1, LEVELS: 1, CONTINUOUS: 2}[self.number]]

    def times(self, factor: float, stroke: float) -> Law:
        """The law with that size times a factor up to 1: a sine stays about the middle, a stroke takes longer."""
        one, two, three, four = self.settings
        middle = 0.5 * stroke
        match self.number:
            case 0:
                return Law(
                    STATIC, (one, two, factor * three, factor * four), self.seconds, self.start, self.position_range
                )
            case 1:
                start = middle - factor * (middle - self.start)
                return Law(FREQUENCY, (one, factor * two, three, four), self.seconds, start)
            case 2:
                return Law(LEVELS, (one, factor * two, three, four), self.seconds, self.start)
        highest = max(two, factor * three)
        return Law(CONTINUOUS, (one, two, highest, four), self.seconds * three / highest, self.start)

    @property
    def by_position(self) -> bool:
        """Whether the file has a current for each position, not for each time."""
        return self.number == CONTINUOUS

    def columns(self) -> dict[str, Array]:
        """What the file holds: time (s) and set position (m) or current (rated currents); or way (m) and current."""
        settings, time = self.named, np.arange(round(self.seconds * RATE)) / RATE
        if self.number == CONTINUOUS:
            way = np.linspace(0.0, settings["travel"], _POINTS)
            share = 1.0 - np.abs(2.0 * way / settings["travel"] - 1.0)
            return {
                "way": way,
                "current": settings["offset"] + settings["lowest"] + (settings["highest"] - settings["lowest"]) * share,
            }
        if self.number == STATIC:
            way = (time * settings["rate"] / settings["width"]) % 4.0
            tooth = np.where(way < 1.0, way, np.where(way < 3.0, 2.0 - way, way - 4.0))
            return {"time": time, "set_position": self.start + settings["width"] * tooth}
        if self.number == FREQUENCY:
            angle = 2.0 * np.pi * settings["frequency"] * time
            return {"time": time, "current": settings["offset"] + settings["amplitude"] * np.sin(angle)}
        half = settings["length"] + settings["rest"]
        place = time % (2.0 * half)
        sign = np.where(place < half, 1.0, -1.0) * (place % half < settings["length"])
        return {"time": time, "current": settings["offset"] + _slowed(settings["level"] * sign)}


def _slowed(current: Array) -> Array:
    """With ramps in and out: no faster than the control unit changes a current."""
    out, most = np.empty_like(current), STEEPEST / RATE
    last = 0.0
    for k, wanted in enumerate(current):
        last += min(max(float(wanted) - last, -most), most)
        out[k] = last
    return out
