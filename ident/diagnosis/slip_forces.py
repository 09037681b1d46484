"""Dry friction and a constant force: friction that is not the same in both directions is the same to the data.

A friction Fc sgn v with a constant force F is Fc + F against a motion forwards, and Fc − F against a motion backwards.
Where the machine slides most of the time no record distinguishes the two readings, so a verdict says both. The constant
force is that of a static load, or the offset of the transducer of a force.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from math import hypot

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.effects.effect import Effect
from ident.effects.static_load import STATIC_LOAD


@dataclass(frozen=True)
class SlipForces:
    """The forces at which a machine slides `forward` and `backward`, and the friction with a constant force, SI."""

    forward: float
    backward: float
    friction: float
    constant: float
    unit: str


def slip_forces(refit: FittedModel, effects: Collection[Effect]) -> SlipForces | None:
    """The two forces of a model with these effects; None without friction, or where no constant force is determined.

    A constant force as large as the friction is no part of it.
    """
    found = refit.parameters
    sliding = [found[name] for effect in effects if effect.slides and (name := effect.added[0].name) in found]
    if not sliding:
        return None
    friction, unit = sum(force.value for force in sliding), sliding[0].unit
    constants: list[tuple[float, float | None]] = [
        (offset.value, offset.std_error) for name, offset in refit.transducer_offset.items() if name == "force"
    ]
    load = found.get(STATIC_LOAD.added[0].name)
    if load is not None:
        constants.append((-load.value, load.std_error))  # a load that pushes forward is less to slide against
    errors = [error for _, error in constants if error is not None]
    constant = sum(value for value, _ in constants)
    all_determined = 0 < len(constants) == len(errors)
    if not all_determined or not CRITERIA.verification.deviations * hypot(*errors) < abs(constant) < friction:
        return None
    return SlipForces(friction + constant, friction - constant, friction, abs(constant), unit)
