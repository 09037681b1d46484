"""Controller, hybrid simulation and servo loop over a stated spread, against every drawn machine by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.design.scatter import Scatter
from ident.design.spread import Spread
from ident.errors import Unusable
from ident.hybrid.case import qian
from ident.hybrid.changed_machine import Change
from ident.hybrid.controller_design import design_controller
from ident.hybrid.drawn_simulations import drawn_simulations
from ident.hybrid.feedforward_tracking import followed_in
from ident.hybrid.parameter_samples import drawn_parameters
from ident.hybrid.what_if import what_if
from ident.run import Specimen
from tests.hybrid.cases import fitted, noise
from tests.hybrid.designs import RATE, matrices
from tests.reference import controlled_loop_reference as loops
from tests.reference import hybrid_reference as reference
from tests.stability import servo_reference
from tests.stability.test_judgement import fit_of

TWENTY = Spread(0.2)
EDGES = (5.0, 95.0)
FIT = fitted()


def machines(count, seed=0):
    """Table 4 with each value drawn evenly within 20 %, as the reference takes it: its own draws."""
    rng = np.random.default_rng(seed)
    fields = [name for name in reference.Actuator._fields if name != "A"]
    table = reference.Actuator()._asdict()
    return [reference.Actuator(**{n: table[n] * rng.uniform(0.8, 1.2) for n in fields}) for _ in range(count)]


def same_share(found, expected, draws):
    """Two shares of as many draws each, within four standard deviations of their difference."""
    mean = (found + expected) / 2
    return abs(found - expected) <= 4 * np.sqrt(max(2 * mean * (1 - mean) / draws, 1 / draws**2))


def apart(found, values):
    """How far the ends of an interval are from those of other draws, of their width."""
    lower, upper = np.percentile(values, EDGES)
    return max(abs(found.lower - lower), abs(found.upper - upper)) / (upper - lower)


def test_hybrid_simulations_over_a_spread_are_those_of_a_brute_force(full):
    """200 draws of ± 20 % (40 in the short form) at a gain where a part is unstable: share, score and margin."""
    draws = 200 if full else 40
    case = replace(qian(), ground=noise(1.0), sample_rate=1024.0, gain=26.0, damping=np.array([[500.0]]))
    found = drawn_simulations(FIT, case, spread=TWENTY, draws=draws)
    ground = case.ground.samples(case.sample_rate)
    structure, specimen = reference.Structure(C=500.0), reference.Specimen()
    stable, scores = [], []
    for actuator in machines(draws, seed=571):
        poles = reference.poles(case.sample_rate, case.gain, 1, actuator, structure, specimen)
        d, x, _ = reference.simulate(ground, case.sample_rate, case.gain, 1, actuator, structure, specimen)
        stable.append(poles.real.max() < 0)
        scores.append(np.std(x - d) / np.std(d))
    assert 0.05 < np.mean(stable) < 0.95
    assert same_share(found.stable, np.mean(stable), draws)
    assert apart(found.quantities["tracking_rms"], scores) < (0.15 if full else 0.35)
    margin = found.quantities["gain_margin"]
    assert margin.lower < 0 < margin.upper  # in dB, below 0 where it is unstable
    assert found.draws == draws
    assert str(TWENTY) in next(found.sentences())


def test_a_margin_of_a_drawn_simulation_is_where_stability_ends():
    """The gain of the servo loop or of the measured force, whichever is lost first: the first by the reference."""
    case = replace(qian(), ground=noise(0.2), sample_rate=1024.0, gain=10.0, damping=np.array([[500.0]]))
    found = drawn_simulations(FIT, case, spread=Spread(0.0), draws=2).quantities["gain_margin"]
    assert found.lower == found.upper == found.value
    at = [10 ** ((found.value + step) / 20) for step in (-0.1, 0.1)]
    given = reference.Actuator(), reference.Structure(C=500.0), reference.Specimen()
    before, after = (reference.poles(1024.0, 10.0 * factor, 1, *given).real.max() for factor in at)
    assert before < 0 < after


def test_a_controller_over_a_spread_is_that_of_a_brute_force(full):
    """200 draws of ± 20 % (20): stable share, and margins from sampled loops that the reference steps by themselves."""
    draws, impulse = 200 if full else 20, np.zeros(2048)
    impulse[0] = 1.0
    given = {"sample_rate": RATE, "gain": 2.0, "piston_area": reference.Actuator().A, "draws": draws}
    made = design_controller(FIT, Specimen(8.75, 17.5e3), delay=3, spread=TWENTY, **given)
    stable, peaks = 0, []
    for actuator in machines(draws, seed=572):
        values = {name: value for name, value in actuator._asdict().items() if name != "A"}
        plant = loops.servo_loop(8.75, 17.5e3, 2.0, values=values)
        moved, _ = loops.run(plant, matrices(made.design.controller), 3, np.zeros(2048), impulse, RATE)
        if np.abs(moved[-200:]).max() < np.abs(moved[:400]).max():
            stable += 1
            peaks.append(np.abs(np.fft.rfft(moved + impulse)).max())
    assert made.robustness.spread == "± 20 % of each parameter"
    assert same_share(made.robustness.stable / draws, stable / draws, draws)
    assert apart(made.robustness.margins["sensitivity_peak"], peaks) < (0.2 if full else 0.5)
    assert made.robustness.margins["gain"].value == pytest.approx(made.margins.gain, abs=0.1)
    assert made.robustness.margins["phase"].value == pytest.approx(made.margins.phase, abs=0.5)
    assert not made.robustness.held


@pytest.mark.full
def test_a_servo_loop_over_a_spread_is_that_of_a_brute_force():
    """100 draws of ± 20 % against as many of servo_reference: share stable and gain margin, near the edge."""
    rng, of = np.random.default_rng(573), servo_reference.TABLE_4
    gain = 10 ** ((servo_reference.margin(of, 1.0) - 1.5) / 20)
    found = what_if(fit_of(of), Change(), (gain, gain), spread=TWENTY).spread[0]
    drawn = [{name: value * rng.uniform(0.8, 1.2) for name, value in of.items()} for _ in range(100)]
    margins = np.array([servo_reference.margin(one, gain) for one in drawn])
    assert 0.1 < np.mean(margins > 0) < 0.95
    assert same_share(found.stable, np.mean(margins > 0), 100)
    assert apart(found.quantities["gain_margin"], margins[margins > 0]) < 0.25


def test_a_feedforward_over_a_spread_is_worth_less():
    """± 20 % of each parameter leaves more of the error than ± 1 %, and the result says over what."""
    fit = fitted("strano")
    case = replace(
        qian(),
        ground=replace(noise(0.5), kind="sine", frequency=2.0),
        piston_area=9.05e-3,
        supply_pressure=210e5,
        gain=100.0,
        physical=Specimen(0.0, 0.0),
        sample_rate=500.0,
    )
    narrow, wide = (followed_in(fit, case, spread=Spread(share)) for share in (0.01, 0.2))
    assert wide.drawn_both_rms > 3 * narrow.drawn_both_rms
    assert "drawn from ± 20 % of each parameter" in wide.said[-1]


def test_a_history_is_drawn_as_it_scatters():
    """Twelve sets with 5 % in Z0 and c0 that goes with it: 20,000 draws have that spread, and that correlation."""
    rng = np.random.default_rng(574)
    z = 0.05 * rng.standard_normal(12)
    sets = [{"Z0": 2e-6 * (1 + one), "c0": 3000 * (1 - 2 * one), "tau": 4e-3} for one in z]
    scatter = Scatter.of_sets(sets, "batch 7")
    drawn = drawn_parameters(FIT, 20_000, 1, scatter)
    assert drawn.keys() == {"Z0", "c0", "tau"}
    # the t distribution of 11 degrees of freedom has 11/9 of the variance of a normal one
    expected = np.std(z, ddof=1) / (1 + z.mean()) * np.sqrt((1 + 1 / 12) * 11 / 9)
    assert drawn["Z0"].std() / FIT.values["Z0"] == pytest.approx(expected, rel=0.05)
    assert np.corrcoef(drawn["Z0"], drawn["c0"])[0, 1] < -0.99
    assert np.ptp(drawn["tau"]) == pytest.approx(0.0, abs=1e-12)
    assert str(scatter) == "the scatter of 12 parameter sets of batch 7"
    with pytest.raises(Unusable, match="at least 3"):
        Scatter.of_sets(sets[:2], "batch 7")
