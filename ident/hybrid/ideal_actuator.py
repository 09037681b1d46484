"""An ideal actuator: it lags its command by a delay and has no other fault, as a critical delay supposes."""

from __future__ import annotations

import numpy as np

from ident.chain.chain import Chain
from ident.effects import effect
from ident.hybrid.case import Case
from ident.hybrid.machine import DISPLACEMENT, FORCE, Machine
from ident.stages import IDEAL_SENSOR, INSTANT_VALVE, OPENED_BY_COMMAND, RIGID_SPOOL, Quantity
from ident.stages.stage import stage

_FOLLOWING = stage(
    "load",
    (
        Quantity("v", "m/s", "speed, that of a command which stands between samples"),
        Quantity("X", "m", "position"),
        Quantity("xL", "m", "position of the specimen"),
        Quantity("F", "N", "force on the specimen"),
        Quantity("idle", "1", "nothing: a chain has a state"),
    ),
    ("v = 0", "a held command moves in jumps"),
    ("X = w", "the rod is where it is told to be"),
    ("xL = w", "the specimen moves with the rod"),
    ("F = k * xL", "the spring of the specimen; a damper or a mass would see the jumps alone"),
    ("idle' = 0", "nothing"),
)
_CHAIN = Chain(
    (OPENED_BY_COMMAND, INSTANT_VALVE, RIGID_SPOOL, _FOLLOWING, IDEAL_SENSOR), {DISPLACEMENT: "y", FORCE: "F"}
)


def ideal_actuator(case: Case, delay: float) -> Machine:
    """The machine whose measured displacement in the loop of a case lags what is wanted by `delay` s and no more.

    The computing delay of the case is part of it: at least that is needed. Springs alone give back what they should.
    """
    late = effect("command_delay")
    own = delay - case.delay / case.sample_rate
    chain = _CHAIN.with_effects((late,))
    return Machine(chain, {late.added[0].in_equations: float(np.maximum(own, 0.0))})
