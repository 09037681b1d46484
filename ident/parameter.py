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
    FINELY = "finely along the range"
    """Many places along its axis: of what makes the output jump, which no step from one place to another tells."""
    AS_KNOWN = "as known"
    """What whoever builds the machine knows, as a gear: at its value, which no search moves."""
    PHASE = "phase"
    """An angle, rad: all around."""
    SPECTRAL_LINES = "spectral lines"
    """A frequency, 1/s: where the residual's rate beats with the motion's."""
    RESONANCE = "resonance"
    """A frequency, 1/s, of a part that is held still: below the one at which the output answers its command by ringing,
    by what of the mass hangs there."""
    RELAXATION = "relaxation"
    """A time, s, in which a part relaxes: along its axis, which goes to many times the time of an answer."""
    STROKE_END = "end of the stroke"
    """The inverse of a way, 1/m: of the largest way that was covered, where a stop that was hit stands."""
    TOP_SPEED = "top speed"
    """The inverse of a speed, s/m: of the largest speed that was measured, at which a limit begins to act."""
    STROKE_MIDDLE = "middle of the stroke"
    """A place, m: held at the middle of the stroke, to both sides of which the effect acts."""
    TIME = "time"
    """A time, s: as long as the model's own lag, which becomes as much shorter."""
    FRICTION = "friction"
    """A pressure, Pa: a share of the pressure difference that dry friction takes."""
    FRICTION_GRADIENT = "friction gradient"
    """A pressure over a way, Pa/m: a share of the dry friction's over half of the way that was covered."""


class AtReversals(Enum):
    """What a parameter measures of a force where the motion reverses."""

    WAY = "way"
    """A way, m, over which the force builds up."""
    SPEED = "speed"
    """A speed, m/s, over which it falls."""
    FORCE = "force"
    """The force itself, N, which jumps there."""


@dataclass(frozen=True)
class Parameter:
    """A model parameter in SI.

    A range of more than two decades is searched on a logarithmic scale, any other on a linear one.
    """

    name: str
    """What the user calls it, in results and requests; of an effect's "effect.parameter" once a model has it."""
    symbol: str
    """How it is written in the literature."""
    unit: str
    """SI, in the grammar of units: "m^3/(s*Pa)"."""
    lower: float
    """Physical bounds of the search: the lower,"""
    upper: float
    """and the upper."""
    value: float
    """Default; of a strength 0, off."""
    meaning: str
    """What it is, as a clause."""
    source: str = ""
    """Where its bounds are from."""
    of: str = ""
    """Effect that it belongs to; "" for a model's own."""
    relative: float = 0.0
    """Default of a way on a machine of unknown size, in standard deviations of its motion; 0 is `value`."""
    searched: bool = False
    """Of a shape: whether it is free wherever the effect is, since without it the effect could not be found."""
    start: Starts = Starts.ALONG_RANGE
    """From where its search begins."""
    of_motion: bool = False
    """Whether it is a way, the inverse of one, a speed, or the torque of a weight that the motion lifts: the motion
    measures it, in place of the command."""
    at_reversals: AtReversals | None = None
    """What happens over it where the motion reverses, so that a simulation takes steps as short as that asks for."""

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

    @property
    def is_force(self) -> bool:
        """Whether it is a force, or a torque where an angle was recorded."""
        return self.unit == "N"

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
