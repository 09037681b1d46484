"""The reference of periodic tests against closed forms, SciPy's integrator, and itself with much finer steps."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.reference.periodic_reference import Law, bouc_wen, bouc_wen_along, dahl, dahl_along, driven

RATE = 200.0  # Hz


@pytest.mark.full
def test_a_sine_through_the_bare_mass_has_the_amplitude_and_phase_of_its_transfer_function():
    m, c, k, w = 2.0, 30.0, 900.0, 2 * np.pi * 2.0
    t = np.arange(2000) / RATE
    x = driven(Law(m=m, c=c, k=k), 50 * np.sin(w * t), RATE, "linear", 4, "displacement")
    held = np.sinc(w / RATE / 2 / np.pi) ** 2  # the command is straight between its samples
    wanted = 50 * held * np.imag(np.exp(1j * w * t) / (k - m * w**2 + 1j * c * w))
    assert np.std((x - wanted)[1000:]) < 1e-4 * np.std(wanted)


@pytest.mark.full
def test_a_position_loop_settles_like_its_poles():
    m, c, stiff = 1.0, 12.0, 400.0
    t = np.arange(400) / RATE
    x = driven(Law(m=m, c=c, Kt=2.0, Kp=stiff / 2.0), np.ones(400), RATE, "zoh", 8, "displacement")
    d, wd = c / 2 / m, np.sqrt(stiff / m - (c / 2 / m) ** 2)
    assert x == pytest.approx(1 - np.exp(-d * t) * (np.cos(wd * t) + d / wd * np.sin(wd * t)), abs=1e-6)


@pytest.mark.full
def test_dry_friction_starts_slides_and_stops_when_it_should():
    m, c, Kt, Fc = 1.0, 5.0, 2.0, 0.7
    command = np.concatenate([0.3 * np.ones(40), np.ones(160), np.zeros(200)])
    v = driven(Law(m=m, c=c, Kt=Kt, coulomb_friction_Fc=Fc), command, RATE, "zoh", 4, "velocity")
    t = np.arange(400) / RATE
    rising = (Kt - Fc) / c * (1 - np.exp(-c / m * (t - 0.2)))
    assert np.all(v[:41] == 0.0)  # 0.6 N do not move it
    assert v[40:200] == pytest.approx(rising[40:200], abs=1e-6)
    top = rising[200]
    stops = 1.0 + m / c * np.log1p(c * top / Fc)
    falling = np.where(t < stops, (top + Fc / c) * np.exp(-c / m * (t - 1.0)) - Fc / c, 0.0)
    assert v[200:] == pytest.approx(falling[200:], abs=1e-6)


def test_friction_that_yields_and_hysteresis_are_advanced_as_by_an_integrator():
    x = np.concatenate([np.linspace(0, 1, 60), np.linspace(1, -0.7, 90)[1:], np.linspace(-0.7, 0.2, 50)[1:]])
    for exponent in (1.0, 2.0, 3.4):
        z = 0.0
        for way in (1.0, -1.7, 0.9):
            side = np.sign(way)
            z = _integrated(z, way, lambda z, s=side, n=exponent: s * (1 - abs(z) ** n * (0.5 + 0.5 * np.sign(s * z))))
        assert bouc_wen_along(x, 0.3, exponent)[-1] == pytest.approx(z, abs=2e-5)
    z = 0.0
    for way in (1.0, -1.7, 0.9):
        side = np.sign(way)
        z = _integrated(z, way, lambda z, s=side: s - z)
    assert dahl_along(x, 0.3)[-1] == pytest.approx(z, abs=1e-6)
    assert dahl(0.2, 0.0, 1.0) == bouc_wen(0.2, 0.0, 1.0, 1.0) == 0.2
    assert bouc_wen(0.0, 0.6, 0.3, 2.0) == pytest.approx(np.tanh(2.0), abs=1e-6)


def _integrated(z: float, way: float, slope) -> float:
    found = solve_ivp(lambda _, z: slope(z), (0, abs(way) / 0.3), [z], "RK45", rtol=1e-8, atol=1e-10, max_step=0.01)
    return float(found.y[0, -1])


EFFECTS = {
    "coulomb_friction": {"Fc": 12.0}, "stribeck_friction": {"dF": 15.0, "vs": 0.02},
    "presliding_friction": {"Fd": 12.0, "xs": 2e-3}, "specimen_hysteresis": {"fy": 15.0, "xy": 5e-3, "n": 1.5},
    "position_friction": {"Fx": 3e3}, "quadratic_damping": {"c2": 60.0}, "cubic_stiffness": {"k3": 1e5},
    "end_stop": {"ks": 4e3, "way": 0.04}, "backlash": {"b": 5.0}, "dead_zone": {"h": 8.0, "a": 0.2},
    "underlap": {"h": 8.0}, "gain_asymmetry": {"a": 0.2}, "flow_saturation": {"a": 0.02},
    "command_delay": {"T": 0.013}, "command_limit": {"a": 0.03}, "valve_second_order": {"Tn": 0.02},
    "sensor_lag": {"T": 0.02}, "sensor_nonlinearity": {"s": 30.0},
}  # fmt: skip
OF_LOOP = {
    "loop_delay": {"T": 0.013},
    "lead": {"Td": 0.01},
    "integral_action": {"Ki": 0.5},
    "sensor_gain": {"g": 0.1},
    "acquisition_lag": {"T": 0.02},
    "backlash": {"b": 1.0},
    "dead_zone": {"h": 1.0},
}
SHOWN, EQUAL = 1e-3, 1e-4  # of the deviation: what an effect changes at least, what finer steps change at most


@pytest.mark.full
@pytest.mark.parametrize("name", EFFECTS)
def test_each_effect_acts_on_a_mass_and_finer_steps_change_nothing(name):
    _acts(Law(m=2.0, c=30.0, k=900.0), name, EFFECTS[name], 50.0)


@pytest.mark.full
@pytest.mark.parametrize("name", OF_LOOP)
def test_each_effect_of_a_loop_acts_and_finer_steps_change_nothing(name):
    _acts(Law(m=2.0, c=60.0, Kt=20.0, Kp=100.0), name, OF_LOOP[name], 0.05)


def _acts(base: Law, name: str, values: dict[str, float], size: float) -> None:
    command = size * np.sin(2 * np.pi * 2.03 * np.arange(300) / RATE)
    law = base._replace(**{f"{name}_{key}": value for key, value in values.items()})
    bare, coarse, fine = (
        driven(of, command, RATE, "linear", steps, "displacement") for of, steps in ((base, 64), (law, 4), (law, 64))
    )
    assert np.std(fine - bare) > SHOWN * np.std(bare)
    assert np.std(fine - coarse) < EQUAL * np.std(fine)
