"""How much of a residual the inputs predict: a model of the model's error (Ljung 1999, section 16.6).

Noise of any colour is predicted by its own past alone. A missing effect answers to an input. So the residual e of a
fitted model is predicted by features of the inputs u, of the model's output y and of the slope of y: each of them, its
size, its sign, its square and its cube with the sign kept, their products, and all of these behind first-order lags,

    A(q) e = Σ c_j A(q) φ_j + ν      φ_j the features, ν white

with A(q) the autoregression of e less its prediction by the features (Cochrane and Orcutt 1949). So ν has no memory,
and the coefficients c are efficient whatever the colour of the noise. Their penalty is that which makes A(q) e most
likely (MacKay 1992). Each record is cut into stretches; the odd ones predict the even ones, and the even ones the odd
ones. The share of the power of A(q) e that is predicted there has its error from blocks of all records in a row. It is
above zero where an input has a part in the residual.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import scipy  # optimize, which takes long to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.diagnosis.evidence.blocks import block_ratio
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.evidence import BlockMean
from ident.linear_filter import linear_filter
from ident.noise.autoregression import Autoregression
from ident.residuals.decimation import averaged
from ident.rounding import EPSILON

Array = NDArray[np.float64]


def predicted_share(
    residuals: Sequence[Array],
    inputs: Sequence[Sequence[Array]],
    outputs: Sequence[Array],
    most_averaged: int = 1,
    criteria: EvidenceCriteria = EVIDENCE_CRITERIA,
) -> BlockMean:
    """The share of the power of the whitened residuals (n,) of some runs that their inputs predict out of fold.

    At most `most_averaged` neighbouring samples of a long record make one. Where these are too many, parts of the
    record are used.
    """
    slopes = [np.gradient(y) if len(y) > 1 else y for y in outputs]
    runs = [(r, *given, y, v) for r, given, y, v in zip(residuals, inputs, outputs, slopes, strict=True)]
    parts = _shortened(runs, most_averaged, criteria)
    of_all_runs = [_alike(signal) for signal in list(zip(*parts, strict=True))[1:]]
    lags = _lags(min(len(part[0]) for part in parts), criteria)
    whitened = [_whitened(part[0], _features(of, lags)) for part, *of in zip(parts, *of_all_runs, strict=True)]
    e, rows = np.concatenate([e for e, _ in whitened]), np.concatenate([rows for _, rows in whitened], axis=1)
    fold = np.concatenate([np.arange(len(e)) * criteria.enough_blocks // max(len(e), 1) % 2 for e, _ in whitened])
    (_, penalty), predicted = _most_likely(rows, e), np.zeros(len(e))
    for held_out in (0, 1):
        seen = fold != held_out
        predicted[~seen] = _coefficients(rows[:, seen], e[seen], penalty) @ rows[:, ~seen]
    return block_ratio([e**2 - (e - predicted) ** 2], [e**2], criteria)


def _shortened(
    runs: Sequence[tuple[Array, ...]], most_averaged: int, criteria: EvidenceCriteria
) -> list[tuple[Array, ...]]:
    """The signals of runs averaged over neighbouring samples, and where these are too many the first part of each of
    twelve stretches of each run."""
    total, most = sum(len(run[0]) for run in runs), criteria.model_error_samples
    every = max(1, min(-(-total // most), most_averaged))
    coarse = [tuple(averaged(signal, every) for signal in run) for run in runs]
    if total <= every * most:
        return coarse
    share = every * most / total
    stretches = [
        tuple(zip(*(np.array_split(signal, criteria.enough_blocks) for signal in run), strict=True)) for run in coarse
    ]
    return [tuple(signal[: int(len(signal) * share)] for signal in stretch) for of in stretches for stretch in of]


def _alike(signals: Sequence[Array]) -> list[Array]:
    """A signal of all runs less its mean and over its deviation, both those of all runs: runs may differ in level."""
    every = np.concatenate(signals)
    mean, size = float(every.mean()), float(every.std()) or 1.0
    return [(signal - mean) / size for signal in signals]


def _whitened(residual: Array, features: Sequence[Array]) -> tuple[Array, Array]:
    """The innovations (n,) of a residual over their deviation, and the features (features, n) behind the same filter
    and over the same deviation."""
    e, rows = residual - residual.mean(), np.array([feature - feature.mean() for feature in features])
    size = float(e.std()) or 1.0
    noise = e / size - _most_likely(rows, e / size)[0] @ rows
    polynomial = Autoregression.of(noise).polynomial
    innovations, behind = _filtered(polynomial, e), np.array([_filtered(polynomial, row) for row in rows])
    size = float(innovations.std()) if len(innovations) and innovations.any() else 1.0
    return innovations / size, behind / size


def _filtered(polynomial: Array, signal: Array) -> Array:
    """The signal behind a polynomial in z⁻¹, from the first sample on that has a whole past."""
    return np.convolve(signal, polynomial)[len(polynomial) - 1 : len(signal)]


def _lags(samples: float, criteria: EvidenceCriteria) -> Array:
    """Lags of 4, 16, 64 … samples, of which a record holds ten."""
    octaves = float(np.log2(max(samples / criteria.correlation_times, 1.0)))
    return np.asarray(np.exp2(2.0 * np.arange(1, int(octaves / 2) + 1)))


def _features(signals: Sequence[Array], lags: Array) -> list[Array]:
    """The features of the inputs, the output and its slope, each as it is and behind the lags."""
    found = [part for s in signals for part in (s, np.abs(s), np.sign(s), s * np.abs(s), s * s * s)]
    found += [product for a, b in combinations(signals, 2) for product in (a * b, a * np.sign(b), b * np.sign(a))]
    return found + [_lagged(one, lag) for lag in lags for one in found]


def _lagged(signal: Array, lag: float) -> Array:
    """The signal behind a first-order lag of so many samples."""
    kept = float(np.exp(-1 / lag))
    return linear_filter(np.array([1 - kept]), np.array([1.0, -kept]), signal)


def _most_likely(rows: Array, e: Array) -> tuple[Array, float]:
    """The coefficients of the features, and the penalty on their squares that makes e (n,) most likely (MacKay 1992).

    −2 ln p = n ln(Σ e² − Σ z²/(d + λ)) + Σ ln(1 + d/λ)      d the eigenvalues of Φ Φᵀ, z Φ e in their directions
    """
    d, directions = np.linalg.eigh(rows @ rows.T)
    d, z = np.maximum(d, 0.0), directions.T @ (rows @ e)
    power, largest = float(e @ e), float(d.max(initial=0.0))
    if not power > 0 or not largest > 0:
        return np.zeros(len(rows)), 1.0

    def unlikely(logarithm: float) -> float:
        penalty = float(np.exp(logarithm))
        remaining = max(power - float(np.sum(z**2 / (d + penalty))), EPSILON * power)
        return len(e) * float(np.log(remaining)) + float(np.sum(np.log1p(d / penalty)))

    bounds = np.log(largest) + np.log(EPSILON) / 2, np.log(largest) - np.log(EPSILON) / 2
    penalty = float(np.exp(scipy.optimize.minimize_scalar(unlikely, bounds=bounds, method="bounded").x))
    return np.asarray(directions @ (z / (d + penalty))), penalty


def _coefficients(rows: Array, e: Array, penalty: float) -> Array:
    gram = rows @ rows.T
    return np.asarray(np.linalg.solve(gram + penalty * np.eye(len(gram)), rows @ e), float)
