"""How far a hybrid simulation is from what should have come out; every score says which displacements it compares."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_LATEST = 0.1  # s: the longest delay that is looked for


@dataclass(frozen=True)
class Scores:
    """Of the displacements m(easured), n(umerical: what the substructure asked for) and r(eference), all (n,).

    `delay` (s) is by how much m lags n where both agree best; `tracking_rms` std(m − n)/std(n), `tracking_peak`
    max|m − n|/max|n|; `reference_rms` and `reference_peak` the same of m against r, `numerical_rms` of n against r.
    """

    delay: float
    tracking_rms: float
    tracking_peak: float
    reference_rms: float
    reference_peak: float
    numerical_rms: float


def scores(measured: Array, numerical: Array, reference: Array, sample_rate: float) -> Scores:
    """The scores of displacements (n,) at `sample_rate` (Hz)."""
    return Scores(
        delay=delay(numerical, measured, sample_rate),
        tracking_rms=rms(measured, numerical),
        tracking_peak=peak(measured, numerical),
        reference_rms=rms(measured, reference),
        reference_peak=peak(measured, reference),
        numerical_rms=rms(numerical, reference),
    )


def rms(found: Array, wanted: Array) -> float:
    """std(found − wanted) / std(wanted)."""
    return float(np.std(found - wanted) / max(float(np.std(wanted)), 1e-300))


def peak(found: Array, wanted: Array) -> float:
    """max|found − wanted| / max|wanted|."""
    return float(np.max(np.abs(found - wanted)) / max(float(np.max(np.abs(wanted))), 1e-300))


def delay(wanted: Array, found: Array, sample_rate: float) -> float:
    """By how much `found` lags `wanted` where they correlate best, s; between samples by a parabola through three.

    Looked for up to 0.1 s either way. Each correlation is that of the stretch which both share: without this a record
    that does not end at rest would seem less late than it is.
    """
    w, f = wanted - wanted.mean(), found - found.mean()
    n, furthest = len(w), min(round(_LATEST * sample_rate), len(w) - 2)
    size = 1 << (2 * n - 1).bit_length()
    lags = np.arange(-furthest, furthest + 1)
    products = np.fft.irfft(np.fft.rfft(f, size) * np.conj(np.fft.rfft(w, size)), size)[lags]
    before, behind = np.maximum(lags, 0), np.maximum(-lags, 0)  # samples of f, and of w, that the other has not
    energy = [np.concatenate([[0.0], np.cumsum(signal**2)]) for signal in (w, f)]
    shared = (energy[0][n - before] - energy[0][behind]) * (energy[1][n - behind] - energy[1][before])
    correlation = products / np.sqrt(np.maximum(shared, 1e-300))
    best = int(np.argmax(correlation))
    shift = 0.0
    if 0 < best < len(lags) - 1:
        left, top, right = correlation[best - 1 : best + 2]
        bend = left - 2 * top + right
        shift = 0.5 * float(left - right) / float(bend) if bend else 0.0
    return float((lags[best] + shift) / sample_rate)
