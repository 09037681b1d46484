"""What acts on a machine beside its command and was measured: where it adds to the equations of a chain."""

from __future__ import annotations

from dataclasses import replace

from ident.chain.chain import DISTURBANCE, Chain
from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.stages import Stage

_ADDS = {"flow": ("Q", "+"), "load": ("R", "-"), "sensor": ("y_fb", "+")}
"""To the load flow (m³/s), to the force that drives the rod (N), to the reading of the transducer (m)."""


def can_be_disturbed(chain: Chain, place: str) -> bool:
    """Whether there is something at the place that a measured disturbance adds to."""
    return bool(_at(chain, place))


def disturbed(chain: Chain, place: str) -> Chain:
    """The chain with a measured disturbance at a place. Raises Unusable where it has nothing there to add to."""
    found = _at(chain, place)
    if not found:
        what = f"the model has nothing that a disturbance of the {place} adds to"
        raise Unusable("no-place", what, "disturbance", "leave it out, or choose a model that has the place")
    ((stage, equation),) = found
    signal, sign = _ADDS[place]
    right = equation.text.partition("=")[2].strip()
    added = (f"{signal} = {right} {sign} {DISTURBANCE}", f"{equation.meaning}, and what was measured there")
    stages = tuple(stage.with_equations(added) if each is stage else each for each in chain.stages)
    return replace(chain, stages=stages)


def _at(chain: Chain, place: str) -> list[tuple[Stage, Equation]]:
    signal, _ = _ADDS[place]
    return [(s, e) for s in chain.stages if s.place == place for e in s.equations if e.target == signal]
