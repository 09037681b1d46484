"""What the rig allows: the limits of the machine that drives a test, and how much of each a run takes.

The share that a run takes of a limit is its peak over the limit; a run stays inside where no share is above 1. Both
directions share the stroke, so that a piston may go half of it from the middle.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

from ident.words.engineering import quantity
from ident.words.percent import percent

DIMENSIONS: Mapping[str, str] = {
    "stroke": "length",
    "speed": "velocity",
    "acceleration": "acceleration",
    "force": "force",
    "flow": "flow",
    "supply_pressure": "pressure",
}
"""What may be limited, with the dimension that its unit must have."""
UNITS: Mapping[str, str] = {
    "stroke": "m",
    "speed": "m/s",
    "acceleration": "m/s^2",
    "force": "N",
    "flow": "m^3/s",
    "supply_pressure": "Pa",
}
"""The SI unit of each."""
PEAKS: Mapping[str, str] = {
    "stroke": "displacement from the middle",
    "speed": "speed",
    "acceleration": "acceleration",
    "force": "force",
    "flow": "valve flow",
    "supply_pressure": "load pressure",
}
"""What is compared with each limit: the largest size that it has in a run."""


@dataclass(frozen=True)
class Utilisation:
    """The share that a run takes of one limit, whose name is `limit`; `peak` and `allowed` are sizes in SI."""

    limit: str
    peak: float
    allowed: float

    @property
    def share(self) -> float:
        """Peak over what is allowed: above 1 the run leaves the limit."""
        return self.peak / self.allowed

    @property
    def exceeded(self) -> bool:
        """Whether the run leaves the limit."""
        return not self.share <= 1.0

    def __str__(self) -> str:
        unit = UNITS[self.limit]
        return (
            f"{PEAKS[self.limit]} {quantity(self.peak, unit)}, {percent(self.share)} of {quantity(self.allowed, unit)}"
        )


@dataclass(frozen=True)
class RigLimits:
    """The limits of a rig, SI; what is not stated is None and limits nothing.

    `stroke` is the way from one end to the other (m), `speed` (m/s) and `acceleration` (m/s²) are those of the piston,
    `force` (N) is what it may put on the load, `flow` (m³/s) what the valve passes, `supply_pressure` (Pa) what a load
    pressure may reach.
    """

    stroke: float | None = None
    speed: float | None = None
    acceleration: float | None = None
    force: float | None = None
    flow: float | None = None
    supply_pressure: float | None = None

    def __bool__(self) -> bool:
        return bool(self.stated)

    @property
    def stated(self) -> dict[str, float]:
        """The limits that are stated, by name, SI."""
        return {each.name: value for each in fields(self) if (value := getattr(self, each.name)) is not None}

    @property
    def allowed(self) -> dict[str, float]:
        """The largest size that each quantity of :data:`PEAKS` may have: of a stroke its half."""
        return {name: value / 2 if name == "stroke" else value for name, value in self.stated.items()}

    def over(self, other: RigLimits) -> RigLimits:
        """These limits, and those of the other where this states none."""
        return RigLimits(**{**other.stated, **self.stated})

    def utilisation(self, peaks: Mapping[str, float]) -> tuple[Utilisation, ...]:
        """The share that peaks (SI, by the name of the limit) take of each limit that is stated, the largest first."""
        found = [Utilisation(name, peaks[name], allowed) for name, allowed in self.allowed.items() if name in peaks]
        return tuple(sorted(found, key=lambda each: each.share, reverse=True))

    def leaving(self, peaks: Mapping[str, float]) -> tuple[str, ...]:
        """A sentence for each limit that peaks leave, the worst first, with the factor that would keep it."""
        left = (each for each in self.utilisation(peaks) if each.exceeded)
        return tuple(
            f"beyond the rig: {each}; {each.limit} is kept at {1 / each.share:.3g} times that" for each in left
        )

    def unjudged(self, peaks: Mapping[str, float]) -> tuple[str, ...]:
        """The limits that are stated, and that these peaks say nothing of."""
        return tuple(name for name in self.stated if name not in peaks)

    def __str__(self) -> str:
        return ", ".join(f"{name} {quantity(value, UNITS[name])}" for name, value in self.stated.items()) or "none"
