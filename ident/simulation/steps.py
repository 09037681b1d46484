"""How finely a chain is to be simulated: the steps that a sample is divided into."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import INPUT_RATE, Chain
from ident.effects.effect import Effect

Array = NDArray[np.float64]
FINE = 0.4  # radians or time constants a step: the largest eigenvalue times the step, above which steps are divided
_STIFF = 1.0  # the same for a mode so fast that it does nothing but follow; from 2.6 a step would go astray
_FOLLOWING = 4.0  # times the band of the commands: where such modes begin
_KINKED = 0.3  # radians a sample of the band for which an effect says how many steps its kinks ask for
MOST = 32  # steps a sample
FASTEST = FINE * MOST  # radians a sample of the fastest mode that is followed closely; one beyond is said


def rates(chain: Chain, values: Mapping[str, Any], output: str) -> Array:
    """The largest eigenvalue of the chain's small-signal behaviour in magnitude, 1/s, for a batch of values."""
    jacobian = chain.linearise({name: values[name] for name in chain.symbols}, output).A
    jacobian = np.where(np.isfinite(jacobian), jacobian, 0.0)
    return np.asarray(np.abs(np.linalg.eigvals(jacobian)).max(axis=-1))


def steps_needed(
    chain: Chain, fastest: Array, hold: str, on: Sequence[Effect], band: float = np.pi / 2, kinks: int = 1
) -> NDArray[np.int64]:
    """Steps a sample, a power of two up to :data:`MOST`, for eigenvalues `fastest`, (v,).

    They and the `band` up to which the command excites the machine are in radians a sample. A mode that does nothing
    but follow is given fewer: a Runge-Kutta step of one time constant is off by 2 % in how fast it decays, and not in
    where it tends to. Kinks of effects that are on, and those of the core, `kinks`, ask for more, the fewer the slower
    the motion is for the samples, and so does a held command whose jumps act at once or between the samples.
    """
    least = max(kinks, *(effect.steps for effect in on), 1) * min(band / _KINKED, 1.0)
    if hold == "zoh" and any(chain.reads(name) for name in (INPUT_RATE, "delay")):
        least = max(least, 2.0)
    following = min(_FOLLOWING * band, np.pi / 2)  # at the latest at half of what a record can show
    closely = np.maximum(np.minimum(fastest, following) / FINE, fastest / _STIFF)
    ratio = np.maximum(closely, max(least, 1.0))
    return np.asarray(np.minimum(2 ** np.ceil(np.log2(ratio)), MOST).astype(np.int64))
