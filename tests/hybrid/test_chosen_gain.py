"""A gain chosen for one quantity, against the loop of servo_reference.py written out as polynomials with a delay."""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.hybrid.changed_machine import Change, changed_machine
from ident.hybrid.chosen_gain import GainTarget, choose_gain
from ident.hybrid.loop_figures import phase_margins
from ident.workflows import identify
from tests.acceptance.matrices import NOISE, as_matrix
from tests.reference import qian_reference
from tests.short_form import short_form
from tests.stability import servo_reference as reference
from tests.stability.test_judgement import UNITS, fit_of

GAIN = 5.0

OMEGA = np.geomspace(0.05, 5e3, 20_000)
TARGETS = {"phase_margin": (50.0, 2.0), "bandwidth": (8.0, 0.24), "peak": (2.0, 0.2)}
"""What is wanted, and how far off it the true machine may be."""


def measured(of, gain) -> dict[str, float]:
    """Of L, and of G = L/(1 + L) with the delay in the feedback left out of the way forward."""
    L = -reference.turned(of, gain, OMEGA)
    G = np.abs(L / (1 + L))
    crossover = np.argmax(np.abs(L) < 1)
    margin = 180 + np.degrees(np.unwrap(np.angle(L)))[crossover]
    band = OMEGA[np.argmax(G < 10 ** (-3 / 20))] / (2 * np.pi)
    return {"phase_margin": margin, "bandwidth": band, "peak": 20 * np.log10(G.max())}


@pytest.mark.full
@pytest.mark.parametrize("quantity", short_form(TARGETS, "peak"))
def test_the_true_machine_has_what_is_wanted(quantity, full):
    """Fits off by 0.5 % of each parameter: 100 machines each, one in the short form."""
    rng, (wanted, tolerance) = np.random.default_rng([59, len(quantity)]), TARGETS[quantity]
    for _ in range(100 if full else 1):
        of, _gain = reference.drawn(rng)
        found = {name: value * (1 + 0.005 * rng.standard_normal()) for name, value in of.items()}
        fit = fit_of(found)
        chosen = choose_gain(fit, changed_machine(fit, Change()), GainTarget(quantity, wanted))
        assert chosen.reached
        assert measured(of, chosen.gain)[quantity] == pytest.approx(wanted, abs=tolerance)
        spread = chosen.quantities[quantity]
        assert spread.lower < spread.value < spread.upper


def fitted_to(of, seed) -> FitResult:
    """The fit to records of a machine, 1 s of each specimen and amplitude at Kp = 5, with 0.5 % noise."""
    plant = qian_reference.Plant(**{name: of[name] for name in UNITS})
    trials = [trial for trial in qian_reference.trials() if trial.cell.gain == GAIN]
    records = qian_reference.measure_all(plant, trials, seconds=1.0, noise=NOISE, seed=seed, hold="linear")
    return identify(as_matrix(records, "linear"), Settings(seed=1))


@pytest.mark.parametrize("number", short_form(range(3), 0))
def test_a_gain_from_a_fit_gives_the_true_machine_what_is_wanted(number, full):
    """Seeds 560 to 562: machines within 30 % of Table 4, each target from one fit; 34 of them in the long form."""
    for draw in range(34 if full else 1):
        rng = np.random.default_rng([560 + number, draw])
        of = {name: value * rng.uniform(0.7, 1.3) for name, value in reference.TABLE_4.items()} | {"T": 0.0}
        fit = fitted_to(of, draw)
        for quantity, (wanted, tolerance) in TARGETS.items():
            chosen = choose_gain(fit, changed_machine(fit, Change()), GainTarget(quantity, wanted))
            assert chosen.reached
            assert measured(of, chosen.gain)[quantity] == pytest.approx(wanted, abs=tolerance), (draw, quantity)


@pytest.mark.full
def test_a_gain_margin_is_met_and_what_follows_is_said():
    of = reference.TABLE_4
    fit = fit_of(of)
    chosen = choose_gain(fit, changed_machine(fit, Change()), GainTarget("gain_margin", 6.0))
    assert reference.margin(of, chosen.gain) == pytest.approx(6.0, abs=0.05)
    assert chosen.stable == 1.0
    assert all(one.value is not None for one in chosen.quantities.values())


def test_what_is_out_of_reach_is_said_with_the_nearest():
    """No loop that integrates has 120 degrees; a quantity that there is not is refused."""
    fit = fit_of(reference.TABLE_4)
    chosen = choose_gain(fit, changed_machine(fit, Change()), GainTarget("phase_margin", 120.0))
    assert not chosen.reached
    assert chosen.quantities["phase_margin"].value == pytest.approx(90.0, abs=1.0)
    assert "nearest" in chosen.text
    with pytest.raises(Unusable, match="phase_margin"):
        GainTarget("phase_marign", 50.0)


def test_a_loop_that_rounding_takes_to_nothing_has_its_margin():
    """L falls to 0 at the highest frequency: the phase margin is that of its crossing, without a warning."""
    assert phase_margins(np.array([[-2j, -0.5j, 0j]])) == pytest.approx([90.0])
