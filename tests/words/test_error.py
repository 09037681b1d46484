"""An error in words: with the mean where it counts, unstable where the model is, never a per cent of four digits."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ident.unstable import UNSTABLE, bounded
from ident.words.error import MEAN_COUNTS, ErrorOf, error_in_print, error_said, errors_line, first_line
from ident.words.percent import change, percent, percent_in_print

LARGE = re.compile(r"(?<![\d.])\d{4,}(\.\d*)?\s*%|e\+?\d+\s*%")


@given(st.one_of(st.none(), st.floats(allow_nan=True, allow_infinity=True)))
def test_no_per_cent_of_four_digits_is_ever_printed(fraction):
    for said in (
        percent(fraction),
        percent_in_print(fraction),
        percent_in_print(fraction, 2),
        error_said(fraction),
        error_in_print(fraction),
        ErrorOf(fraction, with_mean=fraction and 2 * abs(fraction)).headline(),
    ):
        assert not LARGE.search(said), said
    if fraction is not None and abs(fraction) < 1e300:
        assert not LARGE.search(change(fraction))


@pytest.mark.parametrize(
    ("fraction", "said"),
    [(9.99, "999 %"), (10.0, "10.0 times"), (12.34, "12.3 times"), (-23.0, "−23.0 times"), (450.0, "450 times")],
)
def test_what_is_ten_times_and_more_is_said_so(fraction, said):
    assert percent_in_print(fraction) == said
    assert percent(fraction) == said.replace("−", "-")


def test_a_change_to_24_times_is_no_per_cent():
    assert (change(23.179, "+"), change(9.0, "+")) == ("24.2 times", "+900.0 %")


@pytest.mark.parametrize(
    ("runs", "said"),
    [
        ((), "unstable"),
        (("k24",), "unstable on run k24"),
        (("a", "b"), "unstable on runs a, b"),
        (tuple("abcde"), "unstable on 5 runs (a, b, c, …)"),
    ],
)
def test_an_unstable_model_is_called_so_by_its_runs(runs, said):
    for error in (UNSTABLE, 4.52e104, float("inf"), float("nan")):
        assert ErrorOf(error, unstable=runs).said() == ErrorOf(error, unstable=runs).in_print() == said
    if runs:
        assert ErrorOf(None, unstable=runs).said() == said  # a diagnosis keeps no number of it
        assert ErrorOf(111.0, unstable=runs).said() == said  # the mean over runs of which one is unstable


def test_the_mean_stands_beside_an_error_from_one_and_a_half_times_on():
    """The ratio stands in one place; at it nothing is added, beyond it both stand, and the size in a first line."""
    assert MEAN_COUNTS == 1.5
    assert ErrorOf(0.02, with_mean=0.03).said() == "2.00 %"
    beyond = ErrorOf(0.0282, with_mean=45.0, rmse="830.0 m")
    assert beyond.said() == "2.82 % (with the mean 45.0 times)"
    assert (beyond.counted(), beyond.alone()) == ("45.0 times", "2.82 %")
    assert ErrorOf(0.02).counted() == "–"
    assert beyond.headline() == "2.82 % (with the mean 45.0 times, RMSE 830.0 m)"
    assert ErrorOf(0.02, with_mean=None).said() == "2.00 %"


def test_a_line_names_the_uses_of_which_there_are_runs():
    errors = {"fit": ErrorOf(0.0282, 45.0), "verify": ErrorOf(None, unstable=("k24",)), "held_out": ErrorOf(None)}
    assert errors_line(errors) == (
        "on estimation data 2.82 % (with the mean 45.0 times), on validation data unstable on run k24"
    )
    assert errors_line({}) == "unknown"


@given(st.one_of(st.floats(min_value=0), st.just(float("nan"))))
def test_what_is_kept_of_an_error_is_a_number_that_json_can_hold(error):
    assert 0 <= bounded(error) <= UNSTABLE


def test_a_result_without_a_model_says_so_first():
    assert first_line("", {}) == "No model was fitted."
    assert first_line("motor", {}) == "motor: error unknown"
