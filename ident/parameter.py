"""A quantity that a fit may find: symbol, unit, bounds, off value, meaning, and where its search begins."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from ident.errors import Unusable


class Starts(Enum):
    """From where the search of a parameter begins. The value is what a user's definition calls it.

    A sensitivity at one value leads to the nearest optimum alone. What each of these needs is another set of values.
    """

    ALONG_RANGE = "along the range"
    """Places along its axis between the bounds."""
    PHASE = "phase"
    """An angle, rad: all around."""
    SPECTRAL_LINES = "spectral lines"
    """A frequency, 1/s: where the residual's rate beats with the motion's."""
    STROKE_END = "end of the stroke"
    """The inverse of a way, 1/m: of the largest way that was covered, where a stop that was hit stands."""
    STROKE_MIDDLE = "middle of the stroke"
    """A place, m: held at the middle of the stroke, to both sides of which the effect acts."""
    TIME = "time"
    """A time, s: as long as the model's own lag, which becomes as much shorter."""
    FRICTION = "friction"
    """A pressure, Pa: a share of the pressure difference that dry friction takes."""
    FRICTION_GRADIENT = "friction gradient"
    """A pressure over a way, Pa/m: a share of the dry friction's over a tenth of a metre."""


@dataclass(frozen=True)
class Parameter:
    """A model parameter in SI.

    `name` is what the user calls it, in results and requests; `symbol` how it is written in the literature; `of` the
    effect that it belongs to, none for a model's own. `lower` and `upper` are the physical bounds of the search;
    `value` is the default (for a strength: 0, off), `relative` that of a way on a machine of unknown size, in standard
    deviations of its motion. `searched`: of a shape without which the effect could not be found, free wherever the
    effect is; other shapes are held at their default. `start` is from where its search begins. `of_motion`: a way,
    the inverse of one, or a speed of the machine's motion, by which it is measured, and not by the drive signal.
    `sets_steps`: a way that has to be long against what is covered in a step of a simulation about a reversal. A range
    of more than two decades is searched on a logarithmic scale, any other on a linear one.
    """

    name: str
    symbol: str
    unit: str
    lower: float
    upper: float
    value: float
    meaning: str
    source: str = ""
    of: str = ""
    relative: float = 0.0
    searched: bool = False
    start: Starts = Starts.ALONG_RANGE
    of_motion: bool = False
    sets_steps: bool = False

    def __post_init__(self) -> None:
        if not self.lower < self.upper:
            raise Unusable(
                "empty-bounds",
                f"lower bound {self.lower:g} is not below upper bound {self.upper:g} {self.unit}",
                f"parameter {self.name}",
                "give bounds as NAME=LOWER:UPPER with LOWER < UPPER",
            )

    @property
    def in_equations(self) -> str:
        """Its name in the equations of a chain: ``dead_zone.half_width`` is ``dead_zone__half_width`` there."""
        return self.name.replace(".", "__")

    def of_effect(self, effect: str) -> Parameter:
        """The same as a model has it that has the effect."""
        return replace(self, name=f"{effect}.{self.name}", of=effect)

    @property
    def logarithmic(self) -> bool:
        """True where the range spans more than two decades of one sign."""
        return self.lower > 0 and self.upper > 100 * self.lower

    def within(self, lower: float, upper: float) -> Parameter:
        """The same parameter with other bounds."""
        return replace(self, lower=lower, upper=upper)
