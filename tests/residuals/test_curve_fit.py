"""What a band of frequencies tells is had from spectra, without looking at the records again."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.reduction import within
from ident.residuals.curve_fit import _products, _within, settle
from ident.residuals.curves import curves, traced
from ident.residuals.views import views
from tests.residuals.conftest import HIDDEN, compared

RATE = 640.0


@pytest.mark.parametrize("band", [(5.0, 20.0), (None, 30.0), (15.0, None), (8.0, 9.0)])
@pytest.mark.parametrize("length", [1280, 1111])
def test_the_products_of_a_band_are_those_of_filtered_records(band, length):
    """Over the power of the filtered residual, which is the last column."""
    rows = np.random.default_rng(3).standard_normal((length, 4)).cumsum(axis=0)
    rows -= rows.mean(axis=0)
    _, spectrum = _products(rows)
    found = _within(spectrum, RATE, length, *band).sum(axis=0)
    filtered = within(rows, RATE, *band)
    filtered -= filtered.mean(axis=0)
    expected = filtered.T @ filtered
    assert found / found[-1, -1] == pytest.approx(expected / expected[-1, -1], rel=2e-3, abs=1e-4)


def test_a_band_between_two_lines_of_the_spectrum_holds_nothing():
    """And does not fail."""
    _, spectrum = _products(np.random.default_rng(3).standard_normal((64, 4)))
    assert not np.any(_within(spectrum, RATE, 64, 11.0, 12.0))


def test_all_frequencies_are_the_whole():
    """The products over the residual's power, from time and from spectra."""
    found = traced(compared("dead_zone"))
    one = settle(found, next(view for view in views(found.preset) if view.name == "spool"))
    assert one is not None
    whole, sampled = one.normal.total, one.within((0.0, None)).total
    assert sampled / sampled[-1, -1] == pytest.approx(whole / whole[-1, -1], rel=0.05, abs=1e-3)


def test_a_dead_zone_has_its_half_width_in_a_band_too():
    """From the residual between 5 and 40 Hz alone."""
    (curve,) = curves(compared("dead_zone"), view="spool", band=(5.0, 40.0))
    x, y = np.array(curve.x), np.array(curve.y)
    inner = (np.abs(x) > 2.5 * HIDDEN["dead_zone"]) & (np.abs(x) < 0.02)
    assert y[inner] == pytest.approx(-np.sign(x[inner]) * HIDDEN["dead_zone"], rel=0.2)
