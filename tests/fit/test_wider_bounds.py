"""Bounds follow the record: what ends at a bound that no user set is searched again beyond it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scipy.signal

from ident import from_arrays, identify
from ident.fit import wider_bounds
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.fit.start import Start
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE, LAG, LATE = 100.0, 0.05, 32  # Hz, s, samples: six times the lag, where three are searched


@cache
def fitted(longest: str = "") -> FitResult:
    """A first-order lag behind a delay under a held command, in closed form."""
    command = np.repeat(np.random.default_rng(8).standard_normal(60), 20)
    command[:40] = 0.0
    pole = np.exp(-1.0 / (RATE * LAG))
    follows = scipy.signal.lfilter([0.0, 1.0 - pole], [1.0, -pole], np.concatenate([np.zeros(LATE), command[:-LATE]]))
    noisy = follows + 0.002 * np.random.default_rng(9).standard_normal(len(follows))
    units = {"command": "V", "displacement": "mm"}
    matrix = from_arrays({"command": command, "displacement": noisy}, units=units, sample_rate="100 Hz", hold="zoh")
    bounds = {"command_delay.delay": ("0 s", longest)} if longest else {}
    return identify(matrix, model="first_order", effects=("command_delay",), bounds=bounds)


def test_a_delay_beyond_its_range_is_found_and_it_is_said():
    found = fitted()
    delay, lag = found.parameters["command_delay.delay"], found.parameters["tau"]
    assert delay.value == pytest.approx(LATE / RATE, rel=0.01)
    assert lag.value == pytest.approx(LAG, rel=0.01)
    assert not delay.at_bound
    assert delay.lower <= delay.value <= delay.upper
    assert found.starts.agree >= min(3, found.starts.tried)
    (told,) = [note for note in found.notes if "a bound that no user set" in note]
    assert told.startswith("command_delay.delay ended at ")


def test_a_bound_that_was_set_is_kept():
    found = fitted("0.1 s")
    assert found.parameters["command_delay.delay"].at_bound
    assert found.parameters["command_delay.delay"].upper == pytest.approx(0.1)
    assert not any("a bound that no user set" in note for note in found.notes)


def test_the_generations_of_the_search_stay_where_they_were():
    """Their populations are of the ranges that were searched, not of those beyond."""
    found = fitted()
    lies = found.searched.index("command_delay.delay")
    assert max(member[lies] for one in found.evolution for member in one.population) <= 0.15


def saturated(steep: float) -> Matrix:
    """A lag of 0.1 s behind all but a switch: y' = (K w / √(1 + (K w)²) − y) / 0.1 s with K `steep`, noise of 0.5 %."""
    rng, n = np.random.default_rng(96), 800
    u = np.interp(np.arange(n) / 40, np.arange(n // 40 + 2), rng.uniform(-1, 1, n // 40 + 2))
    y, at = np.zeros(n), 0.0
    for k in range(1, n):
        for part in range(20):
            w = u[k - 1] + (part + 0.5) / 20 * (u[k] - u[k - 1])
            at += (steep * w / np.sqrt(1 + (steep * w) ** 2) - at) / 0.1 / 2000.0
        y[k] = at
    y = y + 0.005 * y.std() * rng.standard_normal(n)
    run = Run("r", "", 100.0, {"command": u, "displacement": y}, {"command": "V", "displacement": "m"})
    return Matrix(Actuator("SWITCH"), (run,))


def test_a_fit_begins_where_a_diagnosis_ended_though_that_was_beyond_a_usual_bound():
    """A strength that a diagnosis searched beyond a range of nobody's is not cut off; a bound of the user holds."""
    begun = Start("diagnosis", {"gain": 50.0, "tau": 0.1, "flow_saturation.inverse_opening": 50.0}, error=0.01)
    settings = Settings(model="first_order", effects=("flow_saturation",), start=begun)
    found = identify(saturated(50.0), settings=settings)
    assert found.error["fit"] < 0.006
    assert found.parameters["flow_saturation.inverse_opening"].value == pytest.approx(50.0, rel=0.1)
    bounds = {"flow_saturation.inverse_opening": (0.0, 5.0)}
    bounded = identify(saturated(50.0), settings=replace(settings, bounds=bounds))
    assert bounded.parameters["flow_saturation.inverse_opening"].value <= 5.0


@pytest.mark.parametrize(("over", "beyond"), [(0.7e-12, False), (1.3e-12, True)])
def test_a_value_is_beyond_its_bounds_but_for_rounding(over, beyond):
    assert wider_bounds._is_beyond(over, -1.0, 0.0) is beyond
