"""Friction where the motion turns between two samples, and where a record begins while it builds up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.fit.simulated_runs import every_run
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.run import Run
from ident.simulation.steps import steps_at_reversals
from ident.workflows import identify
from tests.diagnosis.damper import Damper
from tests.reference.periodic_reference import Law, driven
from tests.short_form import short_form

WAY, FORCE = "presliding_friction.displacement", "presliding_friction.force"
LOW_RATE = Damper(
    damping=500.0, stiffness=0.0, friction=60.0, amplitude=0.02, frequency=1.5, rate=50.0, noise=0.005, cycles=20.0
)


def fitted(damper: Damper):
    """The fit with the width of its friction free."""
    bounds = {WAY: (1e-6, 1e-2)}
    return identify(damper.matrix(), model="specimen", effects=["presliding_friction"], bounds=bounds)


def test_the_steps_follow_the_motion_at_its_reversals():
    """As many as keep a T²/n² within a tenth of the way over which a friction builds up, and eight at most."""
    found = steps_at_reversals(1e-4, np.array([1e-2, 1e-3, 2.5e-4, 1e-4, 1e-5, 0.0]))
    assert found.tolist() == [1, 1, 2, 4, 8, 8]


@pytest.mark.parametrize("displacement", short_form([1e-4, 3e-4], 3e-4))
def test_a_width_shorter_than_the_way_about_a_reversal_is_found(displacement):
    """In one step a sample, of which one covers five times the width, friction and width end a third off."""
    damper = replace(LOW_RATE, displacement=displacement)
    found = fitted(damper)
    assert found.values[WAY] == pytest.approx(displacement, rel=0.03)
    assert found.values[FORCE] == pytest.approx(damper.friction, rel=0.01)


def test_a_record_cut_out_of_the_motion_begins_with_the_friction_that_acts_there():
    """From a friction at rest the first half period of the run to verify would be off by up to the whole force."""
    assert fitted(LOW_RATE).error["verify"] < 1.1 * LOW_RATE.noise


FRICTION = Law(c=6.0, k=160.0, coulomb_friction_Fc=0.5, stribeck_friction_vs=0.06)
EXCESS = FRICTION._replace(coulomb_friction_Fc=0.0, stribeck_friction_dF=0.4)


@pytest.mark.parametrize(("effect", "law"), [("coulomb_friction", FRICTION), ("stribeck_friction", EXCESS)])
def test_a_few_samples_a_period_follow_dry_friction_to_a_thousandth(effect, law):
    """Of a mass under a sine of 30 samples; two steps a sample would put it off by several thousandths."""
    rate, force = 30.0, np.sin(2 * np.pi / 30.0 * np.arange(150))
    truth = driven(law, force, rate, "linear", 64, "displacement")
    run = Run("r", "", rate, {"command": force, "displacement": truth})
    runs = every_run(preset("drive", (effect,)), Matrix(Actuator("A"), (run,)))
    own = [getattr(law, name) for name in Law._fields if name.startswith(effect)]
    added = (p.in_equations for p in runs.preset.effects[0].added)
    values = {"m0": law.m, "c0": law.c, "k0": law.k} | dict(zip(added, own, strict=True))
    assert np.std(runs.outputs_at(values)["r"] - truth) < 1e-3 * np.std(truth)
