"""What an actuator with any effect answers to a record of the current: its chain, simulated as any other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.matrix import Actuator
from ident.run import Run
from ident.simulation.simulate import responses
from ident.simulation.steps import fastest_mode, steps_needed

Array = NDArray[np.float64]
SHOWN = {"position": "y", "pressure": "P", "after_play": "wb"}
"""The signal of Kononykhin's blocks that each answer is."""
_KEPT = 64
"""Chains whose answers are kept compiled. No answer depends on it."""


def chain_response(
    chain: Chain,
    values: Mapping[str, Array],
    supply: float,
    current: Array,
    rate: float,
    hold: str,
    start: float,
    what: str = "position",
) -> Array:
    """One of :data:`SHOWN` for vectors of values, (vectors, n), of an actuator that stands at `start` (m).

    `current` is in rated currents, `values` maps what the chain's equations read to arrays (vectors,), SI.
    """
    shown = _showing(chain, what)
    run = Run("", "", rate, {"command": current, what: current}, output=what, hold=hold, rated_current=1.0)
    at: dict[str, Any] = conditions(run, Actuator("", supply_pressure=supply if np.isfinite(supply) else None)) | dict(
        values
    )
    vectors = len(next(iter(values.values())))
    stacked = {name: np.broadcast_to(at[name], (1, vectors)) for name in shown.symbols}
    fastest = fastest_mode(shown, {name: value[0] for name, value in stacked.items()}, what) / rate
    steps = int(steps_needed(shown, fastest, hold, chain.effects).max())
    states = np.zeros((1, vectors, len(shown.states)))
    for name, value in (("q1", current[0]), ("x", start)):
        states[..., shown.states.index(name)] = value
    return responses(shown, [run], stacked, steps, states)[:, 0].T


@lru_cache(maxsize=_KEPT)
def _showing(chain: Chain, what: str) -> Chain:
    """The chain with one answer as its output; a chain keeps what is derived from its equations."""
    return replace(chain, outputs={what: SHOWN[what]})
