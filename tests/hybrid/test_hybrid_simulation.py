"""The hybrid simulation, judged by a loop that is written out plainly, and by what the papers' case should give."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.effects import EFFECTS
from ident.errors import Cancelled, Unusable
from ident.hybrid.case import qian
from ident.hybrid.compensation import Compensation
from ident.hybrid.controller import SampledController
from ident.hybrid.controller_lookup import controller_called
from ident.hybrid.ground_motion import GroundMotion
from ident.hybrid.hybrid_simulation import simulate_hybrid, simulate_machine
from ident.hybrid.ideal_actuator import ideal_actuator
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.loop_shaping import design
from ident.hybrid.machine import machine
from ident.hybrid.share_map import share_map
from ident.hybrid.stability import critical_delay
from ident.presets import preset
from ident.run import Run, Specimen
from ident.simulation.simulate import responses
from tests.hybrid.cases import el_centro, fitted, noise, of_fifth_order, of_qian
from tests.reference import hybrid_reference as reference
from tests.short_form import short_form

FIT = fitted()


def sprung(ratio: float, share: float = 0.2):
    """The paper's structure with this damping ratio and this share of its spring alone in the laboratory."""
    damping = np.array([[2 * ratio * np.sqrt(87.5 * 87.5e3)]])
    return of_qian(damping=damping, physical=Specimen(0.0, share * 87.5e3))


@pytest.mark.parametrize(("gain", "delay"), [(2.0, 1), (7.0, 3)])
def test_the_loop_is_that_of_the_flat_reference(gain, delay):
    """Wanted and measured displacement and force within 0.01 % of theirs, of a loop stepped by matrix exponentials."""
    case = of_qian(2.0, gain=gain, delay=delay)
    found = simulate_hybrid(FIT, case)
    d, x, f = reference.simulate(found.ground, case.sample_rate, gain, delay)
    for shown, truth in ((found.numerical, d), (found.measured, x), (found.force, f)):
        assert np.std(shown - truth) < 1e-4 * np.std(truth)


def test_a_sampled_controller_acts_in_the_loop_as_in_the_reference():
    """A law with a state: u = d + 0.5 (d − y), smoothed by half of what is new."""
    smooth = SampledController(
        np.array([[0.5]]), np.array([[0.75, -0.25]]), np.array([[0.5]]), np.array([[0.75, -0.25]]), 4096.0, "smoothed"
    )
    state = [0.0]

    def law(d: float, y: float) -> float:
        # the controller's output is half of its state and half of 1.5 d − 0.5 y, and so is its next state
        state[0] = 0.5 * state[0] + 0.5 * (1.5 * d - 0.5 * y)
        return state[0]

    case = of_qian(1.5, gain=5.0)
    found = simulate_hybrid(FIT, case, smooth)
    d, x, _ = reference.simulate(found.ground, case.sample_rate, 5.0, law=law)
    assert np.std(found.measured - x) < 1e-4 * np.std(x)
    assert np.std(found.numerical - d) < 1e-4 * np.std(d)


def test_the_reference_is_the_whole_structure():
    """The reference solution is that of scipy for the whole structure."""
    case = of_qian(2.0)
    found = simulate_hybrid(FIT, case)
    truth = reference.whole(reference.Structure(), found.ground, case.sample_rate)
    assert np.allclose(found.reference, truth, atol=1e-9 * np.max(np.abs(truth)))


def test_a_machine_stepped_on_the_way_is_the_machine_simulated_at_once():
    """With effects of every place on, the loop's own commands, held, give the same displacement in one simulation."""
    case = of_qian(1.0, gain=5.0)
    on = {"command_delay": 7e-4, "dead_zone": 1e-4, "coulomb_friction": 20.0, "sensor_lag": 3e-4, "backlash": 2e-5}
    found = simulate_hybrid(FIT, case, None, on)
    of = machine(FIT, case, on)
    command = np.concatenate([np.zeros(case.delay), found.command])[: len(found.ground)]
    run = Run("", "", case.sample_rate, {"command": command, "displacement": command}, hold="zoh")
    values = {name: np.array([[value]]) for name, value in of.at(case).items()}
    whole = responses(of.chain, [run], values, of.steps(case))[:, 0, 0]
    assert np.std(found.measured - whole) < 1e-9 * np.std(whole)


def test_without_a_controller_the_measured_motion_is_far_off_and_the_numerical_one_is_not():
    """Qian's case, Kp = 2, El Centro: at least 50 % off the reference, the numerical displacement near 10 %."""
    found = simulate_hybrid(FIT, el_centro(qian(), 12.0)).scores
    assert found.reference_rms >= 0.5
    assert 0.05 < found.numerical_rms < 0.2


def shaped(structure):
    """The controller of eq. (19) for the paper's case."""
    case = qian()
    plant = linear_plant(FIT, case.physical, case.gain, case.piston_area)
    return design(plant.model, case.sample_rate, structure=structure).controller


@pytest.mark.parametrize(("structure", "record", "blwn"), [("feedback", 0.03, 0.1), ("two-degree", 0.005, 0.01)])
def test_loop_shaping_brings_the_measured_motion_to_the_reference(structure, record, blwn):
    """Eq. (19): at most 3 % under El Centro and 10 % under noise to 30 Hz; with two degrees 0.5 % and 1 %."""
    controller = shaped(structure)
    found = simulate_hybrid(FIT, of_qian(8.0), controller)
    assert found.stable
    assert found.scores.reference_rms <= blwn
    found = simulate_hybrid(FIT, el_centro(qian(), 12.0), controller)
    assert found.stable
    assert found.scores.reference_rms <= record


@pytest.mark.parametrize("gain", short_form([5.0, 10.0], 10.0))
def test_live_estimates_compensate_the_delay(gain, full):
    """Qian's case under El Centro: tracking_rms is cut at least six times."""
    case = replace(el_centro(qian(), None if full else 8.0), gain=gain)
    left = [simulate_hybrid(FIT, case, acting).scores.tracking_rms for acting in (None, Compensation(4096.0))]
    assert left[1] <= left[0] / 6


@pytest.mark.full
@pytest.mark.parametrize("gain", short_form([5.0, 10.0], 10.0))
def test_live_estimates_compensate_the_delay_before_an_isolator(gain, full):
    """Half of the physical spring is one that yields, after Bouc and Wen: still at least five times."""
    case = replace(el_centro(qian(), None if full else 8.0), gain=gain, physical=Specimen(8.75, 8.75e3))
    isolator = {"specimen_hysteresis.force": 8.75e3 * 5e-4, "specimen_hysteresis.yield_displacement": 5e-4}
    left = [simulate_hybrid(FIT, case, acting, isolator).scores.tracking_rms for acting in (None, Compensation(4096.0))]
    assert left[1] <= left[0] / 5


@pytest.mark.full
def test_a_lightly_damped_structure_behind_a_slow_actuator_needs_compensation():
    """1 % damping, 20 % of the stiffness physical, a lag of 20 ms: unstable without, stable with live estimates."""
    case = replace(sprung(0.01), ground=noise(15.0))
    slow = fitted("first_order", gain=1.0, tau=0.02)
    alone, helped = simulate_hybrid(slow, case), simulate_hybrid(slow, case, Compensation(4096.0))
    assert not alone.stable
    assert helped.stable
    assert helped.scores.reference_rms < 0.5


@pytest.mark.parametrize(("ratio", "expected"), short_form([(0.02, 6.37e-3), (0.05, 16.54e-3)], (0.05, 16.54e-3)))
def test_the_critical_delay_by_analysis_and_by_simulation(ratio, expected, tmp_path):
    """87.5 kg, 87.5 kN/m, a fifth of the spring physical: within 1 %, either side of which a motion dies or grows."""
    case = sprung(ratio)
    assert critical_delay(case) == pytest.approx(expected, rel=0.01)
    push = tmp_path / "push.txt"
    push.write_text("0.1\n" + "0\n" * 2000)
    pushed = replace(case, ground=GroundMotion()).with_ground(push)
    for delay, grows in ((0.99 * expected, False), (1.01 * expected, True)):
        d = np.abs(simulate_machine(ideal_actuator(pushed, delay), pushed).numerical)
        assert (np.max(d[-16384:]) > np.max(d[16384:32768])) == grows


def test_no_delay_is_critical_where_the_damping_outweighs_the_specimen():
    """Qian's own structure bears any delay, one whose mass is mostly physical none."""
    assert critical_delay(qian()) is None
    assert critical_delay(qian().with_shares(0.6, 0.2)) == 0.0


@pytest.mark.full
def test_poles_and_record_agree_on_stability():
    """A map over shares, sixteen systems side by side, says of each what its own simulation does."""
    case = of_qian(4.0, gain=5.0, damping=np.array([[300.0]]))
    shares = [0.0, 0.3, 0.6, 0.9]
    found = share_map(FIT, case, masses=shares, stiffnesses=shares)
    assert 0 < found.stable.sum() < found.stable.size
    for i, j in ((0, 0), (1, 1), (0, 2), (3, 3)):
        alone = simulate_hybrid(FIT, case.with_shares(shares[i], shares[j]))
        assert alone.stable == found.stable[i, j]
        if alone.scores is not None:
            assert found.reference_rms[i, j] == pytest.approx(alone.scores.reference_rms, rel=1e-9)
    assert found.critical_delay[3, 0] == 0.0


@pytest.fixture(scope="module")
def runaway():
    """A lightly damped structure around a lag of 50 ms."""
    return simulate_hybrid(fitted("first_order", gain=1.0, tau=0.05), replace(sprung(0.01), ground=noise(20.0)))


def test_what_runs_away_has_no_scores_and_says_when(runaway):
    """An unstable loop ends early, and its JSON has no number where there is none."""
    found = runaway
    assert not found.stable
    assert found.scores is None
    assert 0 < found.ended < 20
    data = found.to_json()
    assert data["scores"]["tracking_rms"] is None
    assert data["command_rms"] is None
    assert data["state"] == data["stability"]["state"] == "unstable"


def test_an_unstable_loop_grows_as_its_mode_says_and_its_first_remedy_holds(runaway):
    """The record before the end: zero crossings, growth from one half to the other; then the loop with the remedy."""
    found, case = runaway, runaway.case
    mode, first = found.stability.mode, found.stability.remedies[0]
    y = found.measured[: int(found.ended * found.sample_rate)][-int(6 * found.sample_rate / mode.frequency) :]
    crossings = np.flatnonzero(np.diff(np.sign(y)) > 0)
    assert found.sample_rate / np.diff(crossings).mean() == pytest.approx(mode.frequency, rel=0.02)
    early, late = np.array_split(y, 2)
    per_second = np.log(np.std(late) / np.std(early)) / (len(late) / found.sample_rate)
    assert per_second == pytest.approx(mode.growth, rel=0.05)
    assert first.name == "share"
    physical = replace(case.physical, stiffness=first.factor * case.physical.stiffness)
    assert simulate_hybrid(fitted("first_order", gain=1.0, tau=0.05), replace(case, physical=physical)).stable


def test_every_effect_at_a_tenth_runs_and_costs():
    """All effects of the catalogue, at a tenth of their bounds: it runs, further off than before."""
    model = preset("qian2014")
    on = {effect.name: effect.strength.upper / 10 for effect in EFFECTS if model.takes(effect)}
    assert len(on) == len(EFFECTS)
    case = of_qian(3.0)
    found, before = simulate_hybrid(FIT, case, None, on), simulate_hybrid(FIT, case)
    assert found.stable
    assert found.scores.tracking_rms > before.scores.tracking_rms
    assert any("poles judge no loop" in note for note in found.notes)


def test_sensor_noise_and_converters_are_in_what_is_measured():
    """Noise of its size, the same for the same seed, and readings on the steps of the converter."""
    case = of_qian(1.0)
    clean = simulate_hybrid(FIT, case)
    loud = replace(case, noise=replace(case.noise, displacement=2e-6, seed=3))
    found = simulate_hybrid(FIT, loud)
    assert np.std(found.measured - clean.measured) == pytest.approx(2e-6, rel=0.05)
    assert np.array_equal(found.measured, simulate_hybrid(FIT, loud).measured)
    coarse = replace(case, noise=replace(case.noise, displacement_step=1e-5, force_step=0.5))
    stepped = simulate_hybrid(FIT, coarse)
    for record, step in ((stepped.measured, 1e-5), (stepped.force, 0.5)):
        assert np.allclose(record / step, np.round(record / step), atol=1e-6)
        assert np.ptp(record) > 5 * step


def test_it_is_cancelled_between_blocks():
    """What its report raises ends the simulation."""

    def stop(_progress):
        raise Cancelled

    with pytest.raises(Cancelled):
        simulate_hybrid(FIT, of_qian(1.0), report=stop)


def test_what_does_not_go_together_is_refused():
    """A mass behind a model without forces, and a fit that moves nothing."""
    with pytest.raises(Unusable, match="physical mass"):
        simulate_hybrid(fitted("first_order"), of_qian(1.0))
    with pytest.raises(Unusable, match="no command that moves"):
        simulate_hybrid(fitted("specimen"), of_qian(1.0))


def test_the_fifth_order_actuator_follows_with_its_feedforward():
    """`strano` in the rig: the feedforward for the reference solution leaves a twentieth; no poles judge it."""
    case = of_fifth_order(4.0)
    fit = fitted("strano")
    alone, helped = (simulate_hybrid(fit, case, controller_called(name, fit, case)) for name in ("none", "feedforward"))
    assert helped.stable
    assert helped.scores.tracking_rms <= alone.scores.tracking_rms / 20
    assert helped.radius is None
    with pytest.raises(Unusable, match="supply pressure"):
        simulate_hybrid(fit, replace(case, supply_pressure=None))
