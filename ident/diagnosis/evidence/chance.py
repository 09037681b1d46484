"""The gain of the best of many candidates by chance: the bar that a gain has to pass.

Surrogates of a residual have its energy in every spectral line or harmonic, and phases drawn at random: a candidate
explains a part of them by chance alone. The candidates are screened linearly, as in the first screening. The
sensitivities to the fitted parameters are taken off; then each response is fitted by itself, weighted by the
disturbance, and the one that explains most gains G. The bar is the 95 % point of G over 200 surrogates. However many
candidates there are, and however similar, they cost a product of matrices. This is the correction for the number of
models compared (Westfall and Young 1993).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.disturbance import Disturbance
from ident.rounding import TINY

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
_SURROGATES_AT_ONCE = 25
"""Surrogates that lie in memory together: of records of a hundred thousand samples they take 40 MB. No answer
depends on it, but that other phases are drawn, as random."""


def bar(
    residuals: Sequence[Array],
    sensitivities: Sequence[Array],
    candidates: Sequence[Array],
    disturbance: Disturbance,
    seed: int = 0,
) -> float:
    """The gain (nats) that the best of the candidates exceeds by chance in one case of twenty.

    Each run has the residual (n,) of the model that may be extended, its sensitivities (n, p) to the parameters, and
    the responses (n, k) of its output to each candidate. Without a candidate the gain is 0.
    """
    if not candidates or not candidates[0].shape[1]:
        return 0.0
    bands = disturbance.bands
    signals = [
        np.column_stack([r, J, D]) / record.size
        for r, J, D, record in zip(residuals, sensitivities, candidates, bands.records, strict=True)
    ]
    parts = [run.coefficients(of) for run, of in zip(bands.runs, signals, strict=True)]
    band = np.concatenate([run.band for run in bands.runs])
    weights = np.sqrt(_weights(disturbance)[band])
    weighted = np.concatenate(parts) * weights[:, None]
    p = sensitivities[0].shape[1]
    parameter_space = _orthonormal(_real(weighted[:, 1 : 1 + p]))
    columns = _real(weighted[:, 1 + p :])
    columns = _unit(columns - parameter_space @ (parameter_space.T @ columns), columns)
    if not columns.shape[1]:
        return 0.0
    random, sizes = np.random.default_rng(seed), np.abs(weighted[:, 0])
    places = np.tile(band, 2), np.arange(2 * len(band))
    in_bands = csr_array((np.tile(weights**-2.0, 2), places), shape=(bands.size, 2 * len(band)))
    gains: list[float] = []
    while (count := min(bands.criteria.surrogates - len(gains), _SURROGATES_AT_ONCE)) > 0:
        uniform = random.random((len(sizes), count))
        phases = (2.0 * np.pi * uniform).astype(np.float32)  # to 7 digits: a fifth of the cost
        drawn = np.concatenate([sizes[:, None] * np.cos(phases), sizes[:, None] * np.sin(phases)])
        drawn -= parameter_space @ (parameter_space.T @ drawn)
        shares = columns.T @ drawn
        best = np.argmax(np.abs(shares), axis=0)
        remaining = drawn - columns[:, best] * shares[best, np.arange(count)]
        for before, after in zip((in_bands @ drawn**2).T, (in_bands @ remaining**2).T, strict=True):
            own = Disturbance.of_energies(bands, np.array([before, after]), disturbance.floors)
            gains.append(own.gain(before, after))
    return float(np.quantile(gains, 1.0 - bands.criteria.chance))


def _weights(disturbance: Disturbance) -> Array:
    """The weights of the loss; 1 for a band without energy, which is divided by them."""
    return np.where(disturbance.energy > 0, disturbance.weights, 1.0)


def _real(parts: Complex) -> Array:
    """Complex coefficients (m, …) as real ones (2 m, …)."""
    return np.concatenate([parts.real, parts.imag])


def _orthonormal(columns: Array) -> Array:
    if not columns.shape[1]:
        return columns
    U, size, _ = np.linalg.svd(columns / np.maximum(np.linalg.norm(columns, axis=0), TINY), full_matrices=False)
    return np.asarray(U[:, size > EVIDENCE_CRITERIA.dependent * size[0]])


def _unit(columns: Array, before: Array) -> Array:
    """Columns of length 1, without the columns that the sensitivities explain wholly."""
    size, whole = np.linalg.norm(columns, axis=0), np.linalg.norm(before, axis=0)
    independent = (whole > 0) & (size > np.sqrt(EVIDENCE_CRITERIA.dependent) * whole)
    return np.asarray(columns[:, independent] / size[independent])
