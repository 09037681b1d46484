"""What a position in steps tells: the readings at its changes, and how far each may be off."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from ident.bench.readings import in_steps, readings
from ident.bench.records import Record, step_of
from ident.bench.speed_table import SPLINE
from ident.equations.interpolation import interpolated
from ident.resolution import resolution

STEP = 2.5e-5  # m


@pytest.mark.parametrize("moved", [0.01, 0.13, 0.5, 0.93, 1.0, 1.3, 2.5, 7.8])
def test_a_reading_at_a_change_is_off_by_its_deviation(moved: float) -> None:
    """A link at constant speed, begun anywhere within a step, 4000 times: RMS of what the readings are off by."""
    begin = np.random.default_rng(1).uniform(0, 1, 4000)
    way = STEP * (begin[:, None] + moved * np.arange(int(3 + 2 / moved)))
    seen = STEP * np.round(way / STEP)
    changed = np.diff(seen) != 0
    off = (0.5 * (seen[:, 1:] + seen[:, :-1]) - 0.5 * (way[:, 1:] + way[:, :-1]))[changed]
    assert np.sqrt(np.mean(off**2)) / STEP == pytest.approx(in_steps(moved), rel=0.03)


def test_a_link_at_rest_tells_nothing_and_a_moving_one_at_its_changes() -> None:
    """Half a second of rest, then 5 mm/s: a reading for each step that is passed."""
    way = np.concatenate([np.full(500, 0.3), 0.3 + 5e-6 * np.arange(501)])
    found = readings(STEP * np.round(way / STEP), STEP, np.diff(way, prepend=way[0]), 0.0)
    assert found.picked.min() > 500
    assert len(found.picked) == pytest.approx(100, abs=1)
    assert np.abs(found.of(way) - found.values).max() <= 0.5 * 5e-6 * (1 + 1e-9)


def test_a_reading_that_is_not_in_steps_tells_in_every_sample() -> None:
    way = np.linspace(0, 1e-3, 50)
    found = readings(way, 0.0, np.diff(way, prepend=0.0), 1e-6)
    assert found.of(way) == pytest.approx(way[1:])
    assert found.deviations == pytest.approx(np.full(49, 1e-6))


def test_the_spline_is_scipy_s() -> None:
    x, y = np.array([0.0, 0.05, 0.1, 0.25, 0.5, 0.75, 1.0]), np.array([0.0, 0.03, 0.09, 0.2, 0.6, 0.8, 0.9])
    fine = np.linspace(0, 1, 301)
    pairs = [number for pair in zip(x, y, strict=True) for number in pair]
    assert interpolated(SPLINE, fine, *pairs) == pytest.approx(CubicSpline(x, y)(fine), abs=1e-12)


@pytest.mark.parametrize("bits", [10, 16, 20])
@pytest.mark.parametrize("digits", [7, 9, 17])
def test_the_step_of_a_converter_is_found_in_a_text_that_rounds_its_readings(bits: int, digits: int) -> None:
    """Over the whole stroke of 100 mm: the smallest change of 16 bits in 9 digits is off by 7e-5 of a step."""
    step, rng = 0.1 / 2**bits, np.random.default_rng(bits)
    if step < 20 * 0.1 * 10.0**-digits:
        pytest.skip("the text is no finer than the converter")
    way = np.repeat(np.cumsum(rng.uniform(0, 4 * step, 500)), 3)
    places = [0.01 + way, 0.08 + way]
    seen = [np.array([float(f"{x:.{digits}g}") for x in step * np.round(of / step)]) for of in places]
    records = [Record("a", "static", 1e3, "zoh", 0 * of, of, None, resolution(of)) for of in seen]
    assert step_of(records) == pytest.approx(step, rel=1e-6)
    assert step_of([Record("a", "static", 1e3, "zoh", 0 * way, 0.01 + way, None, step)]) == 0.0
