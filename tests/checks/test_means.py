"""Means of a force that differ from run to run."""

from __future__ import annotations

import numpy as np
import pytest

from ident.checks.check import check
from ident.checks.means import APART
from ident.matrix import Actuator, Matrix
from ident.run import Run


def cylinder(apart: float, **stated: bool) -> Matrix:
    """The friction of a moved cylinder under two pressures, whose means are so many deviations apart."""
    speed = np.cos(np.arange(2000) / 50.0)
    runs = (
        Run(
            name,
            "",
            100.0,
            {"velocity": speed, "force": np.sign(speed) + 0.3 * speed + level},
            {"force": "N"},
            output="force",
            zeroed=stated,
        )
        for name, level in (("low", 0.0), ("high", apart * 2.0 * float(np.std(np.sign(speed) + 0.3 * speed))))
    )
    return Matrix(Actuator("A"), tuple(runs))


@pytest.mark.parametrize(("apart", "is_said"), [(0.9 * APART, False), (1.1 * APART, True)])
def test_means_are_said_from_twice_the_deviation_on(apart, is_said):
    """The standard deviation of two means is half of what lies between them."""
    found = [one for one in check(cylinder(apart)) if one.code == "means"]
    assert bool(found) is is_said
    assert all(one.severity == "note" and "zeroed: false" in one.text for one in found)


@pytest.mark.parametrize("zeroed", [True, False])
def test_nothing_is_said_where_the_zero_is_stated(zeroed):
    assert "means" not in {one.code for one in check(cylinder(5.0, force=zeroed))}
