"""Several actuators over a spread, with an isolator, and the cause of an instability, against the flat reference."""

from __future__ import annotations

import numpy as np
import pytest

from ident.design.spread import Spread
from ident.errors import Unusable
from ident.hybrid.controller import no_controller
from ident.hybrid.coupled_loop import EarlierParts
from ident.hybrid.coupled_simulation import simulate_coupled
from ident.hybrid.drawn_simulations import drawn_coupled
from ident.hybrid.parameter_samples import drawn_parameters
from ident.run import Specimen
from tests.hybrid.cases import fitted
from tests.hybrid.coupled_cases import FAST, beam
from tests.hybrid.test_coupled import assert_alike
from tests.hybrid.test_spread import apart, same_share
from tests.reference import coupled_reference as reference
from tests.reference.hybrid_reference import Actuator

TWO = fitted(), fitted(**FAST)
TWENTY = Spread(0.2)
RATE = 1024.0
HELD = no_controller(RATE)
NONE = no_controller(4096.0)


def drawn_actuators(count, seed):
    """Pairs of machines, each value of each evenly within 20 % of its own: draws of the reference by itself."""
    rng = np.random.default_rng(seed)
    names = [name for name in Actuator._fields if name != "A"]

    def one(of):
        return of._replace(**{name: getattr(of, name) * rng.uniform(0.8, 1.2) for name in names})

    return [(one(Actuator()), one(Actuator(**FAST))) for _ in range(count)]


def slow(seconds, **given):
    """The joined beam at 1024 Hz, where a step of the reference costs less."""
    case, loop = beam(seconds, delays=(1, 1), **given)
    return case.changed(sample_rate=RATE), loop


@pytest.mark.full
def test_two_joined_actuators_over_a_spread_are_those_of_a_brute_force(full):
    """200 draws of ± 20 % of both machines (12 in the short form) where a part is unstable: share, scores of each."""
    draws = 200 if full else 12
    case, loop = slow(1.0, gains=(28.0, 18.0))
    found = drawn_coupled(TWO, case, (HELD, HELD), spreads=(TWENTY, TWENTY), draws=draws)
    ground, stable, scores = case.ground.samples(RATE), [], []
    for pair in drawn_actuators(draws, seed=575):
        drawn = loop._replace(actuators=pair)
        d, x, _ = reference.simulate(drawn, ground, RATE)
        stable.append(reference.radius(drawn, RATE) < 1.0)
        scores.append(np.std(x - d, axis=0) / np.std(d, axis=0))
    assert 0.05 < np.mean(stable) < 0.95
    assert same_share(found.stable, np.mean(stable), draws)
    kept = np.array(scores)[np.max(scores, axis=1) < 1.0]  # of those that do not grow within the record
    median = [one["tracking_rms"].value for one in found.parts.values()]
    assert np.median(kept, axis=0) == pytest.approx(median, rel=0.1 if full else 0.25)
    assert found.quantities["tracking_rms"].value == max(median)
    assert found.quantities["gain_margin"].lower < 0 < found.quantities["gain_margin"].upper
    if full:
        assert apart(found.parts["left"]["tracking_rms"], np.array(scores)[:, 0]) < 0.5
    said = list(found.sentences())
    assert f"of {draws} draws of the machines are stable" in said[0]
    assert said[2].startswith("Actuator right: tracking rms")


@pytest.mark.parametrize("joined", [False, True], ids=["apart", "joined"])
def test_a_draw_is_the_simulation_of_its_machines(joined):
    """Each machine of a draw has its own mass: as bit by bit as it is simulated alone, fitted and drawn."""
    case, _ = slow(0.5, joined=joined)
    masses = Spread(0.0, {"m0": 0.2})
    found = drawn_coupled(TWO, case, (HELD, HELD), spreads=(masses, masses), draws=1, seed=3)
    values = [{n: v[0] for n, v in drawn_parameters(fit, 1, (3, p), masses).items()} for p, fit in enumerate(TWO)]
    assert values[0]["m0"] != pytest.approx(values[1]["m0"], rel=0.01)
    alone = simulate_coupled([fitted(**of) for of in values], case, (HELD, HELD))
    as_fitted = simulate_coupled(TWO, case, (HELD, HELD))
    for name, quantities in found.parts.items():
        for score, one in quantities.items():
            assert one.lower == one.upper == pytest.approx(getattr(alone.parts[name].scores, score), rel=1e-9)
            assert one.value == pytest.approx(getattr(as_fitted.parts[name].scores, score), rel=1e-9)


def test_the_margin_of_a_draw_is_that_of_the_whole_loop():
    """The gain of the first servo loop alone makes the beam unstable: it does so there in the reference, not before."""
    case, loop = slow(0.1, gains=(22.0, 16.0))
    margin = drawn_coupled(TWO, case, (HELD, HELD), spreads=(Spread(0.0),) * 2, draws=1).quantities["gain_margin"]
    assert margin.lower == margin.value
    radii = [
        reference.radius(loop._replace(Kp=(22.0 * 10 ** ((margin.value + step) / 20), 16.0)), RATE)
        for step in (-0.1, 0.1)
    ]
    assert radii[0] < 1.0 < radii[1]


@pytest.mark.parametrize("name", ["right", None])
def test_an_isolator_stands_in_the_laboratory_and_in_the_reference(name):
    """On the specimen of one part, or on that of each, where a specimen joins them, too."""
    isolator = Specimen(mass=2.0, stiffness=8e3, damping=60.0)
    on = np.diag([float(name is None), 1.0])
    case, loop = beam(0.5, delays=(1, 1))
    found = simulate_coupled(TWO, case.with_isolator(isolator, name), (NONE, NONE))
    whole = {
        of: getattr(loop, of) + loop.R.T @ on @ loop.R * value for of, value in (("M", 2.0), ("K", 8e3), ("C", 60.0))
    }
    own = {f"{of}s": getattr(loop, f"{of}s") + on * value for of, value in (("M", 2.0), ("K", 8e3), ("C", 60.0))}
    moved = loop._replace(**whole, **own)
    assert_alike(found, moved)
    free = moved._replace(Ms=0 * moved.Ms, Cs=0 * moved.Cs, Ks=0 * moved.Ks)
    d, _, _ = reference.simulate(free, found.first.ground, 4096.0)
    for p, one in enumerate(found.parts.values()):
        assert np.std(one.reference - d[:, p]) < 1e-7 * np.std(d[:, p])
    with pytest.raises(Unusable, match="did you mean"):
        case.with_isolator(isolator, "rigth")


def test_the_cause_of_an_instability_is_the_gain_that_rose():
    """A gain from 20 to 60 and a lag from 2 to 1.8 ms: by the reference the gain put back is stable, the lag is not."""
    case, loop = beam(0.1, gains=(60.0, 16.0), delays=(1, 1))
    then, _ = beam(0.1, gains=(20.0, 16.0), delays=(1, 1))
    now = TWO[0], fitted(**FAST | {"tau": 1.8e-3})
    moved = loop._replace(actuators=(Actuator(), Actuator(**FAST | {"tau": 1.8e-3})))
    found = simulate_coupled(now, case, (NONE, NONE), before=EarlierParts(TWO, then)).first.stability
    assert [one.name for one in found.causes] == ["left.Kp"]
    assert (found.causes[0].before, found.causes[0].after) == (20.0, 60.0)
    assert reference.radius(moved._replace(Kp=(20.0, 16.0)), 4096.0) < 1.0 < reference.radius(loop, 4096.0)
    assert "left.Kp" in found.text[1]


@pytest.mark.full
def test_the_cause_of_an_instability_is_the_machine_that_changed():
    """The damping of the left machine a hundredth of what it was, at the same gains: named, with both values."""
    case, loop = beam(0.1, gains=(20.0, 16.0), delays=(1, 1))
    weak = fitted(Cl=0.0, c0=30.0)
    now = simulate_coupled((weak, TWO[1]), case, (NONE, NONE), before=EarlierParts(TWO, case)).first.stability
    bad = loop._replace(actuators=(Actuator(Cl=0.0, c0=30.0), Actuator(**FAST)))
    assert reference.radius(loop, 4096.0) < 1.0 < reference.radius(bad, 4096.0)
    assert now.causes[0].name in ("left.c0", "left.Cl")


def test_a_case_before_has_the_parts_of_the_case():
    """Parts go by their names, and what the case before leaves out is as it is now."""
    case, _ = beam(0.1)
    stated = EarlierParts.stated(TWO, case, None, None, fitted).with_gain(3.0)
    assert stated.fits == TWO
    assert [one.gain for one in stated.case.cases] == [3.0, 3.0]
    other = fitted(tau=5e-3)
    assert EarlierParts.stated(TWO, case, None, other, fitted).fits == (other, other)
    with pytest.raises(Unusable, match="left, right"):
        EarlierParts.stated(TWO, case, case.cases[0], None, fitted)
