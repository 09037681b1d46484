"""Drift in a line the size of a word, and in words."""

from __future__ import annotations

import pytest

from app.pages.sparkline import ERROR, HEIGHT, WIDTH, drift
from schemas.parameters import ParameterSetView, ValueView


def approved(*values: float, error: float | None = 0.01) -> list[ParameterSetView]:
    return [
        ParameterSetView(
            id=str(i),
            serial="S",
            batch="",
            model="qian2014",
            created_at="",
            approved_at="",
            current=False,
            error_fit=0.02,
            error_verify=error,
            parameters={"tau": ValueView(value=value, unit="s", std_error=None)},
        )
        for i, value in enumerate(values)
    ]


def test_a_rising_parameter_rises_and_says_by_how_much():
    found = drift(approved(0.003, 0.0031, 0.0033), "tau", "τ")
    heights = [float(point.split(",")[1]) for point in found.points.split()]
    assert heights == sorted(heights, reverse=True)
    assert found.says == "τ over 3 approved sets, from 3.000 ms to 3.300 ms, +10.0 %"


def test_no_point_leaves_the_box():
    points = [point.split(",") for point in drift(approved(-1.0, 5.0, -9.0), "tau", "τ").points.split()]
    assert all(0 <= float(x) <= WIDTH and 0 <= float(y) <= HEIGHT for x, y in points)


def test_a_change_below_a_thousandth_looks_flat():
    heights = [float(point.split(",")[1]) for point in drift(approved(1.0, 1.00001), "tau", "τ").points.split()]
    assert max(heights) - min(heights) < 1


@pytest.mark.parametrize(("error", "said"), [(0.01, "1.00 %"), (None, "2.00 %")])
def test_the_error_is_that_on_verify_runs_where_there_are_some(error, said):
    assert said in drift(approved(1.0, 2.0, error=error), ERROR, "error").says


def test_one_set_or_an_unknown_name_has_no_drift():
    assert drift(approved(1.0), "tau", "τ") is None
    assert drift(approved(1.0, 2.0), "Z0", "Z0") is None


def test_the_drift_of_an_error_names_the_run_on_which_a_model_was_unstable():
    """From there to a sound model is no change that a number could tell."""
    lost, sound = approved(1.0, 2.0)
    lost = lost.model_copy(update={"error_verify": 12.0, "unstable_verify": ["k24"]})
    found = drift([lost, sound], ERROR, "error")
    assert found.says == "error over 2 approved sets, from unstable on run k24 to 1.00 %, –"
