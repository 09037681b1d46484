"""The feedforward from the inverse of the nonlinear model, on the flat reference and on machines drawn around a model.

Draws are of numpy's generator at seed 0; another one may be given.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ident.errors import Unusable
from ident.figures.feedforward import feedforward_figure
from ident.figures.theme import look
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.hybrid.feedforward import (
    FeedforwardController,
    Plant,
    command,
    followed,
    gain_limit,
    plant_of,
    tracked,
)
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.hybrid.inverse import Inverse
from ident.hybrid.parameter_samples import drawn_parameters
from ident.matrix import Actuator
from ident.run import Specimen
from ident.workflows import identify
from tests.fit import rig
from tests.reference import strano_reference as reference

RATE, SKIP, LOAD = 1000.0, 1.5, 1e5
MACHINE = reference.Machine()
ISOLATOR = 50e3 / 0.05  # N/m
DRAWN, APART = 100, 0.05  # machines, and the standard deviation of each parameter


def sine(seconds: float = 4.0, amplitude: float = 0.05) -> np.ndarray:
    """1 Hz, begun smoothly within half a second."""
    t = np.arange(round(seconds * RATE)) / RATE - 0.1
    share = np.clip(t / 0.5, 0.0, 1.0)
    return amplitude * np.sin(2 * np.pi * t) * share**3 * (10 - 15 * share + 6 * share**2)


def plant(gain: float) -> Plant:
    return Plant(MACHINE._asdict(), reference.AREA, reference.SUPPLY, gain, LOAD)


@cache
def limit() -> float:
    """Of the feedback's gain, worked out where a test asks."""
    return gain_limit(plant(1.0))


@pytest.fixture(params=[20.0, 50.0, 100.0, 200.0, "half the limit"])
def gain(request: pytest.FixtureRequest) -> float:
    """A gain of the feedback, V/m."""
    return 0.5 * limit() if request.param == "half the limit" else float(request.param)


def left(commanded: np.ndarray, wanted: np.ndarray, gain: float, spring: float = 0.0) -> float:
    """RMS error of the reference under a command."""
    shown = reference.respond(MACHINE, commanded, gain=gain, vertical=LOAD, spring=spring, fine=20).displacement
    return float(np.sqrt(np.mean((wanted - shown)[round(SKIP * RATE) :] ** 2)))


def test_the_error_is_a_twentieth_of_that_of_the_feedback_alone(gain):
    """With the machine's own values, to 6 dB below the stability limit: also with an isolator a tenth at most."""
    r = sine()
    given = command(plant(gain), r, RATE)
    assert left(given, r, gain) <= left(r, r, gain) / 20
    assert left(given, r, gain, ISOLATOR) <= left(r, r, gain, ISOLATOR) / 10


def test_of_drawn_machines_the_median_is_a_tenth():
    """100 machines, each parameter with a standard deviation of 5 %, under the feedforward of the one in the middle.

    From 25 V/m on: at 20 V/m the command hardly leaves the dead zone, and the median is a ninth to a tenth.
    """
    rng = np.random.default_rng(0)
    draws = {name: value * (1 + APART * rng.standard_normal(DRAWN)) for name, value in MACHINE._asdict().items()}
    for gain in (25.0, 0.5 * limit()):
        rms = tracked(plant(gain), plant(gain), sine(), RATE, draws).rms(SKIP)
        assert np.median(rms["drawn_feedback"] / rms["drawn_both"]) >= 10, gain


def test_above_the_limit_a_loop_with_its_valve_just_open_swings_and_below_it_does_not():
    """A steady drift of 1 mm/s holds the valve just open; there is no dry friction that would hold the table."""
    machine = MACHINE._replace(Fc=0.0, mu=0.0)
    t = np.arange(round(3.0 * RATE)) / RATE
    drift = 1e-3 * np.maximum(t - 0.05, 0.0)
    shown = [reference.respond(machine, drift, gain=share * limit(), fine=20).velocity for share in (0.7, 1.3)]
    below, above = (float(np.std(velocity[-500:])) for velocity in shown)
    assert below < 1e-5
    assert above > 1e-3


def test_the_model_simulated_is_the_reference():
    r = sine(2.0)
    shown = reference.respond(MACHINE, r, gain=50.0, vertical=LOAD).displacement
    assert followed(plant(50.0), r, RATE)[0] == pytest.approx(shown, abs=2e-6)


def test_a_controller_of_a_rig_gives_the_same_commands():
    r = sine(1.0)
    of = FeedforwardController(plant(50.0), r, RATE)
    assert [of.step(d, 0.0) for d in r] == pytest.approx(command(plant(50.0), r, RATE))


def test_a_motion_that_the_supply_cannot_give_is_refused():
    values = {name: float(value) for name, value in plant(50.0).known.items()}
    with pytest.raises(Unusable, match="load pressure"):
        Inverse(values).drive(sine(amplitude=0.05) * 400, RATE)


@pytest.fixture(scope="module")
def fit() -> FitResult:
    """A fit of three of the parameters, the others known: a search of a few, of a short record."""
    few = {"population": 16.0, "generations": 3.0, "elite": 3.0}
    truth = rig.machine(0)._asdict()
    known = {name: value for name, value in truth.items() if name not in ("kep", "wn", "C")}
    matrix = rig.matrix(rig.machine(0), 0, ("displacement", "load_pressure"), seconds=3.0)
    return identify(matrix, Settings(model="strano", seed=1, options=few, fixed=known))


def test_a_fit_gives_the_feedforward_and_its_band(fit):
    """From the fitted values and their covariance to commands, errors, and what 90 % of the draws leave."""
    actuator = Actuator("RIG", piston_area=reference.AREA, supply_pressure=reference.SUPPLY)
    model = plant_of(fit, actuator, 50.0)
    draws = drawn_parameters(fit, 40)
    assert all(len(values) == 40 for values in draws.values())
    for name in ("kep", "wn", "C"):
        assert np.std(draws[name]) == pytest.approx(fit.parameters[name].std_error, rel=0.4)
    found = tracked(model, model, sine(2.0), RATE, draws)
    low, high = found.band()
    assert np.all(low <= high)
    assert np.mean((found.both >= low) & (found.both <= high)) > 0.5
    assert found.margin > 6
    drawing = feedforward_figure(FeedforwardTracking.of(found, 40), look("light")).to_dict()
    assert "band" in str(drawing).lower()
    with pytest.raises(Unusable, match="supply_pressure"):
        plant_of(fit, replace(actuator, supply_pressure=None), 50.0)
    with pytest.raises(Unusable, match="is of qian2014"):
        plant_of(replace(fit, model="qian2014"), actuator, 50.0)


def test_a_specimen_lowers_nothing_that_is_not_its_own():
    """A stiff specimen changes the limit; with none the plant is as it was."""
    stiff = replace(plant(50.0), specimen=Specimen(stiffness=1e8))
    assert gain_limit(stiff) != pytest.approx(limit(), rel=0.05)
    assert gain_limit(plant(7.0)) == pytest.approx(limit()), "the limit hangs on no gain"


def test_a_loop_that_is_stable_at_any_gain_has_no_limit_in_words_and_in_json():
    """No infinity stands where a reader, or a JSON parser, expects a number."""
    curve = (0.0, 1.0)
    found = FeedforwardTracking(
        gain=20.0,
        limit=None,
        draws=0,
        feedback_rms=1e-3,
        both_rms=1e-4,
        drawn_feedback_rms=None,
        drawn_both_rms=None,
        drawn_ratio=None,
        t=curve,
        reference=curve,
        feedback=curve,
        both=curve,
        low=curve,
        high=curve,
    )
    assert found.said[0] == "gain 20 V/m, stable at any gain"
    assert found.to_json()["limit"] is None
    assert FeedforwardTracking.from_json(found.to_json()) == found
