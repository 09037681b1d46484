"""What is fitted to the residual for one view, with its signals as the curve itself makes them.

With T the linear response from the view's place to the output, s the signal, r the residual, J the sensitivities to
the parameters, h hat functions: the columns [T*h(s), J, r] of every run. The response is that of first order: s is
improved by what the curve and the parameters make of it, and the fit repeated. That takes long; what a band of
frequencies tells is then had from the columns' spectra at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from ident.parallel import each
from ident.residuals.decimation import Response
from ident.residuals.normal_equations import STRETCHES, Normal, gauge
from ident.residuals.traces import Band, Trace, Traces
from ident.residuals.views import View

Array = NDArray[np.float64]
Spectrum = NDArray[np.complex64]
LEVELS = (0.001, 0.006, 0.02, *(0.055 + 0.89 * i / 15 for i in range(16)), 0.98, 0.994, 0.999)
"""Shares of the samples below each knot: the ends are seldom visited, and worth a look."""
_ROUNDS = 3


@dataclass(frozen=True)
class CurveFit:
    """A view with its knots, the products of its columns, and their spectra in each run, (bins, q), at `rates` Hz."""

    view: View
    knots: Array
    normal: Normal
    spectra: tuple[Spectrum, ...]
    rates: tuple[float, ...]
    lengths: tuple[int, ...]

    def within(self, band: Band | None) -> Normal:
        """The products of what the columns have between two frequencies in Hz."""
        if band is None:
            return self.normal
        runs = zip(self.spectra, self.rates, self.lengths, strict=True)
        return Normal.of(each(lambda run: _within(*run, *band), list(runs)), len(self.knots))


def settle(found: Traces, view: View) -> CurveFit | None:
    """The columns of a view; None where its signal does not move."""
    now = [dict(trace.signals) for trace in found.runs]
    knots = _knots(np.concatenate([_abscissa(view, signals) for signals in now]))
    if knots is None:
        return None
    paths = found.paths(view)
    normal, spectra = _fitted(found, view, knots, paths, now)
    for _ in range(_ROUNDS - 1):
        _, solution = gauge(normal, knots)
        both = zip(found.runs, paths, now, strict=True)
        now = [_improved(trace, view, knots, solution, path, signals) for trace, path, signals in both]
        normal, spectra = _fitted(found, view, knots, paths, now)
    rates, lengths = zip(*((trace.rate, len(trace.residual)) for trace in found.runs), strict=True)
    return CurveFit(view, knots, normal, spectra, rates, lengths)


def _fitted(
    found: Traces, view: View, knots: Array, paths: Sequence[Response], now: Sequence[Mapping[str, Array]]
) -> tuple[Normal, tuple[Spectrum, ...]]:
    """The products of the columns with some signals, and their spectra."""

    def of_run(i: int) -> tuple[Array, Spectrum]:
        return _products(_columns(found.runs[i], now[i], view, knots, paths[i]))

    products, spectra = zip(*each(of_run, range(len(now))), strict=True)
    return Normal.of(products, len(knots)), spectra


def _within(spectrum: Spectrum, rate: float, length: int, low: float | None, high: float | None) -> Array:
    """The products of each stretch of a run from a band alone: the band is moved to zero, where few samples hold it."""
    frequency = np.fft.rfftfreq(length, 1 / rate)
    inside = (frequency >= (low or 0.0)) & (frequency <= (np.inf if high is None else high)) & (frequency > 0)
    rows = (
        scipy.fft.ifft(spectrum[inside].astype(np.complex128), axis=0)
        if inside.any()
        else np.zeros((1, spectrum.shape[1]))
    )
    rows /= max(float(np.sqrt(np.mean(np.abs(rows[:, -1]) ** 2))), 1e-300)
    return np.array([(part.conj().T @ part).real for part in np.array_split(rows, STRETCHES)])


def _products(rows: Array) -> tuple[Array, Spectrum]:
    """The products of each stretch of a run's columns, and their spectrum."""
    products = np.array([part.T @ part for part in np.array_split(rows, STRETCHES)])
    return products, scipy.fft.rfft(rows, axis=0).astype(np.complex64)


def _columns(trace: Trace, signals: Mapping[str, Array], view: View, knots: Array, path: Response) -> Array:
    """[T*h, J, r] without their means, each over the residual's size, (n, knots+p+1)."""
    answers = path.only(1).to(_basis(view, signals, knots))[:, :, 0]
    columns = np.column_stack([answers, trace.sensitivities, trace.residual])
    columns -= columns.mean(axis=0)
    return np.asarray(columns / max(float(np.std(columns[:, -1])), 1e-300))


def _abscissa(view: View, signals: Mapping[str, Array]) -> Array:
    s = signals[view.by]
    return s * np.sign(signals[view.directed]) if view.directed else s


def _knots(samples: Array) -> Array | None:
    """Knots at quantiles of the samples; None where these coincide."""
    moving = samples[samples != 0]  # without a specimen its force is zero all the time
    knots = np.unique(np.quantile(moving, LEVELS)) if len(moving) else moving
    return knots if len(knots) == len(LEVELS) and np.ptp(knots) > 0 else None


def _hats(s: Array, knots: Array) -> Array:
    """Every hat function of the samples, (n, knots)."""
    place = np.clip(np.searchsorted(knots, s) - 1, 0, len(knots) - 2)
    share = np.clip((s - knots[place]) / (knots[place + 1] - knots[place]), 0.0, 1.0)
    hats = np.zeros((len(s), len(knots)))
    rows = np.arange(len(s))
    hats[rows, place], hats[rows, place + 1] = 1.0 - share, share
    return hats


def _basis(view: View, signals: Mapping[str, Array], knots: Array) -> Array:
    hats = _hats(_abscissa(view, signals), knots)
    return hats * signals[view.relative][:, None] if view.relative else hats


def _improved(
    trace: Trace, view: View, knots: Array, solution: Array, path: Response, now: Mapping[str, Array]
) -> dict[str, Array]:
    """The signals as the curve and the changed parameters make them; at its own place a signal is meant before it."""
    added = _basis(view, now, knots) @ solution[: len(knots)]
    answers = path.to(added[:, None])[:, 0, 1:]
    delta = solution[len(knots) :]
    out = {}
    for i, name in enumerate(view.signals):
        out[name] = trace.signals[name] + answers[:, i] + trace.moved[name] @ delta
        if name == view.at:
            out[name] -= added
    return dict(now) | out
