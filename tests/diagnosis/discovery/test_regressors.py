"""The columns of a regression over terms: each is the same whatever stands next to it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.discovery.regressors import Regressors
from ident.diagnosis.discovery.term import Term
from ident.fit.anchoring import Anchoring
from ident.linear import LinearModel
from ident.residuals.decimation import Response

N, RATE = 700, 50.0


@pytest.mark.parametrize("window", [0, 70])
def test_a_column_is_to_the_bit_what_it_is_alone(window):
    """Of more terms than are answered at once; one that is no number is zero, and told apart."""
    rng = np.random.default_rng(6)
    record = SimpleNamespace(
        run=SimpleNamespace(measured=rng.standard_normal(N)), rate=RATE, anchoring=Anchoring(window),
        residual=rng.standard_normal(N), sensitivities=rng.standard_normal((N, 2)), free=rng.standard_normal((N, 1)),
        signals={"v": rng.standard_normal(N)},
    )  # fmt: skip
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
