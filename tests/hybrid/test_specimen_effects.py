"""The reference of a hybrid simulation holds what of its specimen is not linear: by SciPy and by a perfect rig."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.integrate

from ident.hybrid.case import benchmark2020
from ident.hybrid.feedforward_tracking import followed_in
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.loop_shaping import design
from ident.hybrid.machine import machine
from ident.hybrid.scores import rms
from ident.hybrid.share_map import share_map
from ident.hybrid.specimen_effects import reference_of
from ident.hybrid.substructure import reference
from ident.run import Specimen
from tests.hybrid.cases import fitted, noise, of_fifth_order, of_qian

FIT = fitted()
YIELD, WAY = 8.75, 5e-4
ON = {"specimen_hysteresis.force": YIELD, "specimen_hysteresis.yield_displacement": WAY}
RATE = 4096.0


def bouc_wen(z: float, v: float) -> float:
    """z' of Bouc and Wen with an exponent of 1 and beta = gamma = 1/2."""
    return v / WAY * (1 - abs(z) * (0.5 + 0.5 * np.sign(v * z)))


def test_the_reference_with_hysteresis_is_that_of_scipy():
    """The whole of Qian's structure with an element after Bouc and Wen, by an adaptive integrator."""
    case = of_qian(1.5)
    ground, times = case.ground.samples(RATE), np.arange(round(1.5 * RATE) + 1) / RATE

    def rates(t, state):
        x, v, z = state
        a = -np.interp(t, times, ground) - (3.5e3 * v + 87.5e3 * x + YIELD * z) / 87.5
        return [v, a, bouc_wen(z, v)]

    truth = scipy.integrate.odeint(rates, [0, 0, 0], times, tfirst=True, rtol=1e-8, atol=1e-12, hmax=2 / RATE)[:, 0]
    found = reference_of(machine(FIT, case, ON), case, ground)
    assert rms(found, truth) < 1e-4
    assert rms(reference(case, ground), truth) > 20 * rms(found, truth)


def test_a_perfect_rig_gives_the_reference():
    """Substructure and specimen apart, each given the force of the other at once: at most 0.1 % off the reference."""
    case = of_qian(3.0)
    ground = case.ground.samples(RATE)
    C, K = 3.5e3, 70e3
    # the specimen of 8.75 kg goes with the storey; the computer has the rest, steps of an eighth of a sample
    x, v, z, fine = 0.0, 0.0, 0.0, 8
    shown, h = np.zeros(len(ground)), 1 / RATE / fine
    for j in range(len(ground) - 1):
        shown[j] = x
        for i in range(fine):
            a = ground[j] + (ground[j + 1] - ground[j]) * (i + 0.5) / fine
            middle = x + 0.5 * h * v
            z += h * bouc_wen(z, v)
            force = 17.5e3 * middle + YIELD * z  # of spring and element, as a load cell has them
            v += h * (-87.5 * a - C * v - K * middle - force) / (78.75 + 8.75)
            x += h * v
    shown[-1] = x
    found = reference_of(machine(FIT, case, ON), case, ground)
    assert rms(shown, found) < 1e-3


def test_the_scores_of_a_hysteretic_specimen_are_against_its_own_reference():
    """With two degrees of freedom it comes within a per cent of it, and of the linear one it does not."""
    case = of_qian(4.0)
    plant = linear_plant(FIT, case.physical, case.gain, case.piston_area)
    controller = design(plant.model, RATE, structure="two-degree").controller
    found = simulate_hybrid(FIT, case, controller, ON)
    assert found.scores.reference_rms <= 1e-2
    assert rms(found.measured, reference(case, found.ground)) > 5 * found.scores.reference_rms
    assert any("the reference holds, of the specimen, specimen_hysteresis" in note for note in found.notes)
    mapped = share_map(FIT, case, controller, ON, masses=[0.1], stiffnesses=[0.2])
    assert mapped.reference_rms[0, 0] == pytest.approx(found.scores.reference_rms, rel=1e-6)


def test_an_effect_that_does_almost_nothing_leaves_the_exact_reference():
    """Of three storeys, by Runge-Kutta steps of the equations against matrix exponentials."""
    case = replace(benchmark2020(), ground=noise(0.5), piston_area=4.97e-4)
    ground = case.ground.samples(RATE)
    found = reference_of(machine(FIT, case, {"cubic_stiffness": 1e-12}), case, ground)
    assert rms(found, reference(case, ground)) < 1e-6


def test_an_isolator_that_no_controller_knows_is_paid_for():
    """1 MN/m on a rig of fifth order: the feedforward leaves more of it, and the whole structure has the isolator."""
    case = of_fifth_order(2.0)
    isolator, fit = Specimen(0.0, 1e6, 0.0), fitted("strano")
    known, unknown = followed_in(fit, case), followed_in(fit, case, isolator=isolator)
    assert unknown.both_rms > 3 * known.both_rms
    assert unknown.both_rms < unknown.feedback_rms / 5
    both = case.with_isolator(isolator)
    assert both.stiffness[0, 0] == pytest.approx(1.8e6)
    assert both.physical.stiffness == pytest.approx(1.08e6)
    assert np.allclose(both.numerical_stiffness, case.numerical_stiffness)
