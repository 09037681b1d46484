"""A gain chosen for one quantity, against the loop of servo_reference.py written out as polynomials with a delay."""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.hybrid.changed_machine import Change, changed_machine
from ident.hybrid.chosen_gain import GainTarget, choose_gain
from tests.stability import servo_reference as reference
from tests.stability.test_judgement import fit_of

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


@pytest.mark.parametrize("quantity", TARGETS)
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
