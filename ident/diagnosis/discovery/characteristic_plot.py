"""The signal against which a proposed term is drawn: it shows the largest share that no parameter explains."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.term import Signals, Term
from ident.presets import Preset
from ident.residuals.views import view_called
from ident.rounding import EPSILON

Array = NDArray[np.float64]


def characteristic_view(term: Term, preset: Preset, typical: Signals) -> str:
    """The name of a view, see :func:`ident.residuals.views.view_called`; "" where no curve shows the term.

    `typical` are samples of the signals. Parameters explain a straight line against a signal, or a constant share of
    it.
    """
    if term.worked_out is not None:
        return ""
    values, at = term.samples(typical, 1.0), typical[term.at]
    large = np.abs(at) > CRITERIA.discovery.small * np.std(at)
    found = [("", CRITERIA.discovery.shown)]
    for name in dict.fromkeys(term.of):
        whole, share = f"{term.at}({name})", f"{term.at}({name})/{term.at}"
        if name in typical and view_called(whole, preset):
            found.append((whole, _explained_share(values, typical[name], straight=True)))
            if name != term.at and term.at in term.of:
                found.append((share, _explained_share(values[large] / at[large], typical[name][large], straight=False)))
    return max(found, key=lambda one: one[1])[0]


def _explained_share(values: Array, by: Array, straight: bool) -> float:
    """The share that a curve against a signal explains of the deviation of values from a line, or from a constant."""
    line = np.polynomial.Polynomial.fit(by, values, 1 if straight else 0)(by)
    left = values - line
    edges = np.quantile(by, np.linspace(0, 1, CRITERIA.discovery.bins + 1)[1:-1])
    of = np.searchsorted(edges, by)
    counts, sums = np.bincount(of, minlength=CRITERIA.discovery.bins), np.bincount(of, left, CRITERIA.discovery.bins)
    power = float(left @ left)
    return float(np.sum(sums**2 / np.maximum(counts, 1))) / power if power > EPSILON * float(values @ values) else 0.0
