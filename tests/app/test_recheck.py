"""What counts as moved when an approved fit is rechecked, and how it is reported."""

from __future__ import annotations

import math
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest

from app.regress.junit import junit
from app.regress.recheck import Change, Recheck, errors, recheck
from app.regress.words import as_view, told
from app.regress.work import read, written
from ident.progress import silent
from ident.unstable import UNSTABLE
from ident.words.error import ErrorOf


@pytest.mark.parametrize(
    ("before", "after", "relative"),
    [(2.0, 2.0, 0.0), (2.0, 2.1, 0.05), (-2.0, -2.1, 0.05), (0.0, 1e-9, math.inf), (1.0, math.nan, math.inf)],
)
def test_a_change_is_relative_to_what_was_approved(before, after, relative):
    """A number that is no longer one has moved infinitely far."""
    assert Change("Z0", before, after).relative == pytest.approx(relative)


def test_only_changes_beyond_the_tolerance_have_moved():
    """One in a thousand passes a tolerance of one in a hundred, and not one of one in ten thousand."""
    changes = (Change("error fit", 0.01, 0.01001), Change("Z0", 2e-6, 2e-6))
    assert Recheck("SW-1", "f", changes, 1e-2, 1.0).passed
    moved = Recheck("SW-1", "f", changes, 1e-4, 1.0)
    assert not moved.passed
    assert [change.quantity for change in moved.moved] == ["error fit"]


def test_the_junit_file_counts_failures_and_errors_apart():
    """Moved is a failure, unreadable an error; any text of a serial number is well-formed XML."""
    same = Recheck("SW-1", "a", (Change("Z0", 1.0, 1.0),), 1e-3, 1.0)
    moved = Recheck("SW-2 <&\x00", "b", (Change("Z0", 1.0, 2.0),), 1e-3, 1.0)
    broken = Recheck("SW-3", "c", (), 1e-3, 0.0, "its matrix cannot be read")
    suite = ElementTree.fromstring(junit([same, moved, broken]))
    assert {name: suite.get(name) for name in ("tests", "failures", "errors")} == {
        "tests": "3",
        "failures": "1",
        "errors": "1",
    }
    assert [case.get("name") for case in suite] == ["SW-1", "SW-2 <&", "SW-3"]
    assert "Z0 1 → 2" in suite.find(".//failure").get("message")


def test_a_fit_that_ran_out_of_its_time_is_not_rechecked():
    """Made again it may be another: that is no move of the program."""
    found = recheck("SW-1", "f", SimpleNamespace(ended_early=True), None, 1e-3, silent)
    assert not found.passed
    assert "ran out of its time; fit again without a budget" in found.failure


def test_where_the_mean_counts_its_error_is_rechecked_too_and_an_unstable_model_has_no_number():
    """A zero that moved by 830 m is seen by no eq. (17): the error with the mean counted stands with it."""
    stored = SimpleNamespace(error={"fit": 0.02, "verify": None}, error_of=lambda _use: ErrorOf(0.02, 45.0))
    changes = {one.quantity: one for one in errors("error", stored, {"fit": 0.02}, {"fit": 90.0})}
    assert changes["error fit"].relative == 0
    assert changes["error with mean fit"].relative == 1
    alike = SimpleNamespace(error={"fit": 0.02}, error_of=lambda _use: ErrorOf(0.02, 0.021))
    assert [one.quantity for one in errors("error", alike, {"fit": 0.02}, {"fit": 0.021})] == ["error fit"]
    (moved,) = errors("error", alike, {"fit": UNSTABLE}, {"fit": UNSTABLE})
    assert told(as_view(Recheck("SW-1", "f", (moved,), 1e-3, 1.0))) == "error fit 0.02 → unstable"


def test_a_parameter_is_a_number_however_it_is_called_and_however_large():
    """What is an error is said by what made it, not by its name; earlier versions kept only the name."""
    large = Recheck("SW-1", "f", (Change("error of the sensor", 2e3, 4e3, 1.0),), 1e-3, 1.0)
    assert told(as_view(large)) == "error of the sensor 2000 → 4000"
    kept = written(Change("error fit", 0.02, UNSTABLE, kind="error"))
    for entry in (kept, {name: value for name, value in kept.items() if name != "kind"}):
        earlier = Recheck("SW-1", "f", (read(entry),), 1e-3, 1.0)
        assert told(as_view(earlier)) == "error fit 0.02 → unstable"
    entry = {"quantity": "error of the sensor", "before": 2e3, "after": 4e3, "std_error": 1.0}
    assert read(entry).kind == "parameter"
