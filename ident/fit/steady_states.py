"""The states in which runs of one kind stand while their commands are held."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ident.presets import Preset
from ident.run import Run
from ident.simulation.equilibrium import equilibrium

Array = NDArray[np.float64]
Held = tuple[float, float]
"""A command that is held, and where the output is of a position that nothing holds."""


def steady_states(preset: Preset, runs: Sequence[Run], values: Mapping[str, Array], held: Sequence[Held]) -> Array:
    """The states in which runs of one kind stand, near those of the linear chain, (runs, v, n).

    `values` has every symbol of the chain, each an array that broadcasts to (runs, v); `held` is that of each run.
    """
    core, output = preset.core, runs[0].output
    u, y = (np.array(of)[:, None] for of in zip(*held, strict=True))
    linear = core.linearise({name: values[name] for name in core.symbols}, output).standing(u, y)
    near = np.zeros((*linear.shape[:-1], len(preset.chain.states)))
    near[..., [preset.chain.states.index(name) for name in core.states]] = linear
    return equilibrium(preset.chain, output, values, u, runs[0].sample_rate, near)
