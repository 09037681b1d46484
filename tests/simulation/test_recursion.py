"""The linear recursion, where nothing drives it any more."""

from __future__ import annotations

import numpy as np

from ident.linear import LinearModel
from ident.simulation.recursion import discretise, respond


def test_what_has_died_away_is_no_number_that_costs_time():
    """One too small to be normal, as itself or squared, takes a hundred times as long, to the end of a record."""
    model = LinearModel.of(np.array([[[-3.0]]]), np.array([[1.0]]), np.array([[1.0]]), np.array([0.0]))
    system = discretise(model, 100.0, "linear")
    system.start[:] = 2.0
    (y,) = respond(system, np.zeros((30_000, 2)))
    t = np.arange(30_000) / 100.0
    seen = t < 80.0
    np.testing.assert_allclose(y[seen], 2.0 * np.exp(-3.0 * t[seen]), rtol=1e-9)
    assert np.max(np.abs(y[~seen])) < 1e-100
    assert np.min(np.abs(y[y != 0.0])) ** 2 > np.finfo(float).tiny
