"""Of machines that answer quickly and then slowly, from equations of their own: the second capacity is named."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.short_form import short_form

NOISE, COUNT = 0.005, 900
FEW = (
    "second_capacity",
    "command_delay",
    "sensor_lag",
    "valve_second_order",
    "speed_asymmetry",
    "backlash",
    "dead_zone",
)


def heated(seed: int, step: float) -> Run:
    """A plate of 40 s that stands on another of 250 s: two nodes of a thermal network, heated by held powers."""
    sink, exchange, plate, stand = 1.0, 0.6, 40.0, 150.0
    matrix = [[-(sink + exchange) / plate, exchange / plate], [exchange / stand, -exchange / stand]]
    return recorded(seed, step, (matrix, [[1.0 / plate], [0.0]], [[20.0, 0.0]], [[0.0]]), hold=90)


def regulated(seed: int, step: float) -> Run:
    """A wheel with a lag of 20 ms under a PI controller of its speed: what it integrates comes late."""
    proportional, integral, lag = 1.8, 21.0, 0.02
    closed = ([proportional, integral], [lag, 1.0 + proportional, integral])
    return recorded(seed, step, scipy.signal.tf2ss(*closed), hold=100)


def recorded(seed: int, step: float, system: tuple[object, ...], hold: int) -> Run:
    rng, t = np.random.default_rng([11, seed]), step * np.arange(COUNT)
    command = np.repeat(rng.uniform(0.0, 5.0, COUNT // hold + 1), hold)[:COUNT]
    command[:20] = 0.0
    exact = scipy.signal.cont2discrete(tuple(map(np.asarray, system)), step)
    _, answer, _ = scipy.signal.dlsim(exact, command, t)
    clean = answer[:, 0]
    noisy = clean + NOISE * np.std(clean) * rng.standard_normal(COUNT)
    channels = {"command": command, "displacement": noisy}
    units, use = {"command": "V", "displacement": "1"}, "verify" if seed else "fit"
    return Run(f"run-{seed}", "", 1.0 / step, channels, units, use=use, hold="zoh")


@pytest.mark.parametrize(("machine", "step"), short_form([(heated, 2.0), (regulated, 0.004)], (regulated, 0.004)))
def test_an_answer_that_is_quick_and_then_slow_has_a_second_capacity(monkeypatch, machine, step):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("PLATE"), (machine(0, step), machine(1, step)))
    found = diagnose(records, identify(records, model="first_order"), propose=False)
    assert found.verdict.effects == ("second_capacity",)
    assert found.ladder[-1].error["verify"] < 1.2 * NOISE


def test_its_exchange_and_its_time_are_those_of_the_machine(monkeypatch):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("PLATE"), (heated(0, 2.0), heated(1, 2.0)))
    fit = identify(records, model="first_order", effects=("second_capacity",))
    values = {name: fit.parameters[name].value for name in ("second_capacity.exchange", "second_capacity.time", "tau")}
    assert values["second_capacity.exchange"] == pytest.approx(0.6, rel=0.1)
    assert values["second_capacity.time"] == pytest.approx(250.0, rel=0.1)
    assert values["tau"] == pytest.approx(40.0, rel=0.1)


def test_one_lag_has_none(monkeypatch):
    rank_only(monkeypatch, FEW)
    runs = tuple(recorded(seed, 2.0, scipy.signal.tf2ss([20.0], [40.0, 1.0]), hold=90) for seed in (0, 1))
    records = Matrix(Actuator("PLATE"), runs)
    found = diagnose(records, identify(records, model="first_order"), propose=False)
    assert found.verdict.effects == ()
