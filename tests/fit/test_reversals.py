"""Friction that builds up, where the motion turns between two samples and where a record begins in the midst of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.simulation.steps import steps_at_reversals
from ident.workflows import identify
from tests.diagnosis.damper import Damper

WAY, FORCE = "presliding_friction.displacement", "presliding_friction.force"
LOW_RATE = Damper(damping=500.0, stiffness=0.0, friction=60.0, amplitude=0.02, frequency=1.5, rate=50.0, noise=0.005,
                  cycles=20.0)  # fmt: skip


def fitted(damper: Damper):
    """The fit with the width of its friction free."""
    bounds = {WAY: (1e-6, 1e-2)}
    return identify(damper.matrix(), model="specimen", effects=["presliding_friction"], bounds=bounds)


def test_the_steps_follow_the_motion_at_its_reversals():
    """As many as keep a T²/n² within a tenth of the way over which a friction builds up, and eight at most."""
    found = steps_at_reversals(1e-4, np.array([1e-2, 1e-3, 2.5e-4, 1e-4, 1e-5, 0.0]))
    assert found.tolist() == [1, 1, 2, 4, 8, 8]


@pytest.mark.parametrize("displacement", [1e-4, 3e-4])
def test_a_width_shorter_than_the_way_about_a_reversal_is_found(displacement):
    """In one step a sample, of which one covers five times the width, friction and width end a third off."""
    damper = replace(LOW_RATE, displacement=displacement)
    found = fitted(damper)
    assert found.values[WAY] == pytest.approx(displacement, rel=0.03)
    assert found.values[FORCE] == pytest.approx(damper.friction, rel=0.01)


def test_a_record_cut_out_of_the_motion_begins_with_the_friction_that_acts_there():
    """From a friction at rest the first half period of the run to verify would be off by up to the whole force."""
    assert fitted(LOW_RATE).error["verify"] < 1.1 * LOW_RATE.noise
