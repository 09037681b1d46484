"""The columns of a regression over terms: each is the same whatever stands next to it."""

from __future__ import annotations

import threading
import tracemalloc
from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.discovery import regressors
from ident.diagnosis.discovery.regression import _rows
from ident.diagnosis.discovery.regressors import Regressors
from ident.diagnosis.discovery.term import Term
from ident.fit.multiple_shooting import ShootingWindows
from ident.linear import LinearModel
from ident.residuals.decimation import Response

N, RATE = 700, 50.0


@pytest.mark.parametrize("window", [0, 70])
def test_a_column_is_to_the_bit_what_it_is_alone(window):
    """Of more terms than are answered at once; one that is no number is zero, and told apart."""
    rng = np.random.default_rng(6)
    record = SimpleNamespace(
        run=SimpleNamespace(measured=rng.standard_normal(N)),
        rate=RATE,
        anchoring=ShootingWindows(window),
        residual=rng.standard_normal(N),
        sensitivities=rng.standard_normal((N, 2)),
        free=rng.standard_normal((N, 1)),
        signals={"v": rng.standard_normal(N)},
    )
    columns = Regressors.of(record, band=2 * np.pi * 4.0)
    shown = [rng.standard_normal(N) for _ in range(75)]
    shown[50] = np.full(N, np.inf)
    terms = [Term("load", "F", "v", "drawn", ("v",), {}, worked_out=lambda *_, of=of: of) for of in shown]
    A, B = np.array([[-3.0, 1.0], [0.0, -9.0]]), np.array([0.0, 2.0])
    path = Response.of([LinearModel.of(A[None], B[None], np.array([[1.0, 0.0]]), np.zeros(1))], RATE)
    with np.errstate(invalid="ignore"):
        together, sound = columns.to(terms, path)
        alone = [columns._answers([term], path)[0][:, 0] for term in terms]
    assert together.shape[1] == len(terms)
    assert [number for number, finite in enumerate(sound) if not finite] == [50]
    assert not together[:, 50].any()
    found = np.column_stack(alone)
    expected = (found - columns.basis @ (columns.basis.T @ found)) / columns.size
    assert np.array_equal(together, expected)


def test_the_rows_of_a_regression_are_held_once(monkeypatch):
    """Of a long record they are hundreds of megabytes; a copy of them, or of all answers, would be as many again."""
    monkeypatch.setattr("ident.parallel._idle", lambda: threading.Semaphore(0))
    monkeypatch.setattr(regressors, "_BATCH", 4)
    terms = [SimpleNamespace(path=path) for path in ("w", "Q") for _ in range(20)]
    answer = np.random.default_rng(0).standard_normal((10_000, 4))
    record = SimpleNamespace(
        known=np.ones((10_000, 3)), to=lambda of, path: (path * answer[:, : len(of)], [True] * len(of))
    )
    sound = np.zeros(len(terms), dtype=bool)
    tracemalloc.start()
    rows = _rows(terms, [record, record], {"w": [1.0, 2.0], "Q": [3.0, 4.0]}, range(2), sound)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1.2 * rows.nbytes
    assert sound.all()
    expected = np.vstack(
        [np.hstack([np.tile(w * answer, 5), np.tile(q * answer, 5), record.known]) for w, q in ((1.0, 3.0), (2.0, 4.0))]
    )
    assert np.array_equal(rows, expected)
