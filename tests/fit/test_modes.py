"""A fit is one that a simulation can follow: no mode ends far within a sample, unless the user looks there."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.identification import Identification
from ident.fit.modes import FOLLOWED, extreme, fastest
from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.any_machine import Lab


def test_what_a_search_finds_is_followed_by_the_diagnosis():
    """A loop with a dead zone, nothing stated: the oil's compliance went to nothing, 500 radians a sample."""
    matrix = Lab.drawn(317, hidden=True).measured()
    fit = identify(matrix, Settings(model="qian2014"))
    found = diagnose(matrix, fit, most=0)
    assert found.ladder[0].error["fit"] == pytest.approx(fit.error["fit"], rel=1e-4)


def test_a_mode_that_nothing_follows_is_looked_for_only_where_the_user_says_so():
    matrix = Lab.drawn(317, hidden=True).measured()
    free = Identification(matrix, Settings(model="qian2014")).objective
    points = np.random.default_rng(1).uniform(size=(200, len(free.space.axes)))
    values = free.space.values(points)
    modes = fastest(free.preset.chain, extreme(free.runs), matrix.actuator, values)
    lost = modes > FOLLOWED
    assert lost.any()
    assert not lost.all()
    assert np.all(free.errors(points)[lost] >= 1e3)
    assert not np.isfinite(free.exact(points[lost][0]).error)
    assert not np.isfinite(free.approximate(points[lost][0]).error)
    held = Identification(matrix, Settings(model="qian2014", fixed={"tau": 1e-9})).objective
    assert not held.space.followed
