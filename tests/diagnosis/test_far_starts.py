"""A fitted model that went astray for want of an effect: the diagnosis begins elsewhere too, and ends where it should.

Labs of tests/blind/any_machine.py, by recursions of their own.
"""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.ranking import _strong_starts
from ident.fit.levenberg_marquardt import Way
from ident.fit.settings import Settings
from ident.workflows import diagnose, identify
from tests.blind.any_machine import Lab


@pytest.mark.parametrize(("seed", "name"), [(316, "backlash"), (319, "dead_zone"), (1604, "backlash")])
def test_the_hidden_effect_is_found_where_no_start_near_the_fit_leads_to_it(seed, name, full):
    """Small steps tell little of a loop with play: another effect looks better from where its fit went.

    And an effect whose strength is nothing is no finding: with seed 316 a delay of none was the way to the optimum.
    The play of seed 1604 has optima on both sides of the one at the noise.
    """
    if not full:
        pytest.skip("half a minute each: run with --full")
    lab = Lab.drawn(seed, hidden=True)
    assert lab.hidden == name
    matrix = lab.measured()
    fit = identify(matrix, Settings(model="qian2014"))
    found = diagnose(matrix, fit)
    assert found.verdict.effects == (name,)
    assert found.verdict.standing == "found"
    assert found.ladder[-1].error["verify"] < 1.2 * lab.noise


def test_a_drag_is_measured_by_the_speed_that_was_recorded():
    """A motor's speed in steps at 515 Hz: its largest drag was reckoned from the angle and the edge of the band."""
    lab = Lab.drawn(302, hidden=True)
    assert lab.hidden == "quadratic_damping"
    fit = identify(lab.measured(), Settings(model="motor", effects=("quadratic_damping",)))
    assert fit.error["verify"] < 1.1 * lab.noise
    assert fit.values["c0"] == pytest.approx(lab.rate / 12.0, rel=0.02)


def test_strong_starts_lie_within_the_bounds_of_the_model_that_they_begin_from():
    """The bounds of a strength hang on other values: by those of a refit two strengths of three began as one."""
    lab = Lab.drawn(316, hidden=True)
    models, still = CandidateModels.of(lab.measured(), Settings(model="qian2014")), Way(most=0)
    base = models.refit((), {p.in_equations: p.value for p in models.preset.parameters}, way=still)
    refit = models.refit(("coulomb_friction",), base.values | {"c0": 9.0 * base.values["c0"]}, way=still)
    starts, symbol = _strong_starts(models, base, refit), models.strength("coulomb_friction")
    points = np.array([refit.space.point({**start, **refit.space.fixed}) for start in starts])
    begun = refit.space.values(points)[symbol]
    assert begun == pytest.approx([start[symbol] for start in starts])
    assert np.all(np.diff(begun) < 0)
