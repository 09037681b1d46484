"""Bounds: one's own hold, and what ended at one is not said to be determined there."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.settings import Settings
from ident.fit.space import Axis, Space
from ident.workflows import identify
from tests.diagnosis.test_held_commands import RATE, late

QUICK = {"population": 24, "generations": 6, "elite": 3}
OWN = {
    "name": "slow",
    "place": "spool",
    "equation": "w = lag(w, T)",
    "strength": {"symbol": "T", "unit": "s", "lower": 0, "upper": 0.3},
}


def test_the_bound_of_an_own_effect_holds_on_a_machine_of_any_size():
    """0.3 s in the file: not three times the inverse of a frequency, less or more."""
    settings = Settings(model="motor", effects=("slow",), custom=(OWN,), options=QUICK)
    found = identify(late(3), settings).parameters["slow.T"]
    assert (found.lower, found.upper) == (0.0, 0.3)
    wide = {**OWN, "strength": {**OWN["strength"], "upper": 40.0}}
    found = identify(late(3), Settings(model="motor", effects=("slow",), custom=(wide,), options=QUICK))
    assert found.parameters["slow.T"].upper == 40.0


def test_a_bound_of_the_settings_holds():
    bounds = {"command_delay.delay": (0.0, 0.3)}
    settings = Settings(model="motor", effects=("command_delay",), bounds=bounds, options=QUICK)
    found = identify(late(27), settings).parameters["command_delay.delay"]
    assert (found.lower, found.upper) == (0.0, 0.3)
    assert found.value == pytest.approx(27 / RATE, abs=0.2 / RATE)


def test_what_ended_at_its_bound_is_not_determined():
    """The truth is outside: the nearest value that is allowed, with a small standard error of its slope, is none."""
    fit = identify(late(1), Settings(model="first_order", bounds={"tau": (0.1, 1.0)}, options=QUICK))
    found = fit.parameters["tau"]
    assert found.at_bound
    assert found.std_error is None
    assert "tau" not in {entry.expression for entry in fit.determined}
    assert {entry.name: entry.reason for entry in fit.undetermined}["tau"].startswith("the estimate is at its bound")
    assert fit.parameters["gain"].std_error is not None


def test_a_strength_that_the_data_moved_to_its_bound_is_not_said_to_be_any():
    """A delay of 27 samples, allowed 1: every sample more is a better fit, whatever its standard error."""
    bounds = {"command_delay.delay": (0.0, 1 / RATE)}
    fit = identify(late(27), Settings(model="motor", effects=("command_delay",), bounds=bounds, options=QUICK))
    assert fit.parameters["command_delay.delay"].at_bound
    assert fit.parameters["command_delay.delay"].std_error is None
    (reason,) = [entry.reason for entry in fit.undetermined if entry.name == "command_delay.delay"]
    assert reason == "the estimate is at its bound: the best value is outside it"


def test_no_point_of_a_search_space_lies_outside_its_bounds_by_rounding():
    """Of two thousand drawn axes, straight and logarithmic: what is written of an end is accepted when it is read."""
    rng = np.random.default_rng(3)
    for number in range(2000):
        lower, upper = np.sort(10.0 ** rng.uniform(-12, 6, 2)).tolist()
        space = Space((Axis("a", lower, upper, logarithmic=bool(number % 2)),), ("a",), {}, {})
        values = space.values(np.array([[0.0], [1.0], [1 - 1e-16], [rng.random()]]))["a"]
        assert np.all((lower <= values) & (values <= upper))
        assert values[0] == lower
        assert values[1] == pytest.approx(upper, rel=1e-12)
