"""Is the residual of a model noise: its correlation with itself and with the command (Ljung 1999, section 16.6).

With e = x_m − x without its mean and u the command without its own,

    ρ_e(k) = Σ e(t + k) e(t) / Σ e²,      ρ_eu(k) = Σ e(t + k) u(t) / √(Σ e² Σ u²)

Of white e the first lies within ±z/√n but for chance, and of an e that the command has no part in the second within
±z √(Σ ρ_e ρ_u / n), the sum over all lags. What lies outside at k > 0 is dynamics that the model lacks; at k < 0 the
command answers to the output, or the model is late.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from ident.comparison.compare import RunComparison
from ident.errors import Unusable
from ident.words.run_name import run_name

Array = NDArray[np.float64]
SURE = 0.99
_Z = 2.5758293035489004  # of the normal distribution: 99 % lie within ±z
_FEWEST, _MOST = 25, 400  # lags, where nobody asks: two mean periods of the command


@dataclass(frozen=True)
class Correlation:
    """At `lags` (k,) in samples, the values (k,) and half the width of the band that holds 99 % of chance."""

    lags: Array
    values: Array
    band: float

    @property
    def outside(self) -> float:
        """The share of the lags, zero aside, that lie outside the band; chance puts 1 % there."""
        others = self.lags != 0
        return float(np.mean(np.abs(self.values[others]) > self.band))


@dataclass(frozen=True)
class Residual:
    """Both correlations of one run; the second is None where the run has no command."""

    auto: Correlation
    cross: Correlation | None


def memory(residual: Array, lags: int) -> float:
    """The largest of |ρ_e(k)| of a residual (n,) at 1 to `lags` samples: what swings has it at half a period."""
    e = residual - residual.mean()
    power = float(e @ e) or 1.0
    return max(abs(float(e[k:] @ e[:-k])) / power for k in range(1, min(lags, len(e) - 1) + 1))


def correlation(compared: RunComparison, lags: int | None = None) -> Residual:
    """What is left of a run, up to so many lags. Raises Unusable for lags beyond half the record."""
    run = compared.run
    e = _centred(run.measured - compared.modelled)
    u = _centred(run.command) if "command" in run.channels else None
    most = _usual(u, len(e)) if lags is None else lags
    if not 1 <= most <= len(e) // 2:
        raise Unusable("out-of-range", f"{most} lags of {len(e)} samples", run_name(run.id), f"give 1 to {len(e) // 2}")
    own = _products(e, e, most)[most:]
    auto = Correlation(np.arange(most + 1.0), own / own[0], _Z / np.sqrt(len(e)))
    if u is None:
        return Residual(auto, None)
    scale = float(np.sqrt((e @ e) * (u @ u)))
    every = len(e) - 1
    together = float(_products(e, e, every) @ _products(u, u, every)) / scale**2
    band = _Z * float(np.sqrt(max(together, 0.0) / len(e)))
    return Residual(auto, Correlation(np.arange(-most, most + 1.0), _products(e, u, most) / scale, band))


def _centred(signal: Array) -> Array:
    return np.asarray(signal - signal.mean())


def _products(first: Array, second: Array, most: int) -> Array:
    """Σ first(t + k) second(t) for k from −most to most, (2·most + 1,)."""
    size = next_fast_len(len(first) + most + 1, real=True)
    found = irfft(rfft(first, size) * np.conj(rfft(second, size)), size)
    return np.asarray(np.concatenate([found[-most:], found[: most + 1]]), dtype=np.float64)


def _usual(u: Array | None, samples: int) -> int:
    """Two mean periods of the command, by its crossings of the mean."""
    crossings = 0 if u is None else int(np.count_nonzero(np.diff(np.signbit(u))))
    return min(max(_FEWEST, min(_MOST, 4 * samples // max(crossings, 1))), samples // 2)
