"""The line of a Bode plot is the model's own frequency response, and its readouts are those of the control library."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from ident.comparison.compare import compare
from ident.comparison.response_error import response_error
from ident.comparison.step_response import duration, step_response
from ident.fit.result import Estimate, FitResult
from ident.hybrid.poles_and_zeros import poles_and_zeros
from ident.hybrid.readouts import readouts
from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen
from tests.reference import nonlinear_reference as nonlinear
from tests.reference.qian_reference import SAMPLE_RATE, Cell, Plant

PLANT, MASS, STIFFNESS, GAIN = Plant(), 4.25, 17.5e3, 6.0
ACTUATOR = Actuator("SW-1", piston_area=PLANT.A)
LAG, HALF_WIDTH = 4e-3, 4e-4
BAND = (1.0, 80.0)


def multisine(seconds: float, periods: int, seed: int) -> np.ndarray:
    """A periodic command with random phases up to 80 Hz and 1.27 mm RMS; a period takes `seconds`."""
    n = round(seconds * SAMPLE_RATE)
    lines = np.zeros(n // 2 + 1, complex)
    used = np.arange(1, round(80 * seconds) + 1)
    lines[used] = np.exp(2j * np.pi * np.random.default_rng(seed).random(len(used)))
    one = np.fft.irfft(lines, n)
    return np.tile(1.27e-3 / one.std() * one, periods)


def run_of(command: np.ndarray, measured: np.ndarray) -> Run:
    channels = {"command": command, "displacement": measured}
    return Run(
        "k17",
        "-",
        SAMPLE_RATE,
        channels,
        {"command": "m", "displacement": "m"},
        specimen=Specimen(MASS, STIFFNESS),
        gain=GAIN,
        amplitude=1.27e-3,
    )


def fit_of(effects: dict[str, float]) -> FitResult:
    """A fit that has found the truth, with standard errors of 1 % that are not correlated."""
    values = {
        "Z0": ("m^4/s", PLANT.Z0),
        "tau": ("s", PLANT.tau),
        "Cl": ("m^3/(s*Pa)", PLANT.Cl),
        "c0": ("N*s/m", PLANT.c0),
        "m0": ("kg", PLANT.m0),
        "Ka": ("m^3/Pa", PLANT.Ka),
    }
    parameters = {n: Estimate(v, unit, 0.01 * v, v / 2, 2 * v, False) for n, (unit, v) in values.items()}
    parameters |= {n: Estimate(v, "1", None, 0.0, 1.0, False) for n, v in effects.items()}
    names = tuple(dict.fromkeys(name.partition(".")[0] for name in effects))
    return FitResult(
        model="qian2014",
        effects=names,
        parameters=parameters,
        correlation={n: {m: float(n == m) for m in values} for n in values},
        determined=(),
        undetermined=(),
        error={},
        offset={},
        noise_floor={},
        runs=(),
        method="ga",
        seed=0,
        evaluations=1,
        seconds=1.0,
        version="0",
        data_hash="",
        searched=tuple(values),
    )


@pytest.fixture(scope="module")
def control() -> ModuleType:
    """The control library: here, for each worker collects this file and one needs it, which brings Matplotlib."""
    import control as library

    return library


@pytest.fixture(scope="module")
def loops(control) -> tuple[Any, Any]:
    """The open loop and the closed one, from the equations of the paper."""
    s = control.tf("s")
    pressure, load = PLANT.Ka * s + PLANT.Cl, (PLANT.m0 + MASS) * s**2 + PLANT.c0 * s + STIFFNESS
    flow = GAIN * PLANT.Z0 / PLANT.A / (PLANT.tau * s + 1)
    opened = control.minreal(flow * PLANT.A / (pressure * load + PLANT.A**2 * s), verbose=False)
    return opened, control.feedback(opened, 1)


@pytest.fixture(scope="module")
def command() -> np.ndarray:
    """Three periods of 2 s."""
    return multisine(2.0, 3, seed=4)


@pytest.fixture(scope="module")
def linear(command):
    """The linear model beside a run."""
    (found,) = compare(Matrix(ACTUATOR, (run_of(command, command.copy()),)), fit_of({})).runs
    return found


def test_the_readouts_of_a_linear_model_are_those_of_the_control_library(linear, loops, control):
    opened, closed = loops
    found = readouts(linear, fit_of({}), ACTUATOR, BAND)
    gain, phase, _, _ = control.margin(opened)
    omega = 2 * np.pi * np.geomspace(1, 80, 20_000)
    _, turned, _ = control.frequency_response(closed, omega)
    assert found.bandwidth == pytest.approx(control.bandwidth(closed) / (2 * np.pi), rel=2e-3)
    assert found.lag_90 == pytest.approx(omega[np.argmax(np.unwrap(turned) < -np.pi / 2)] / (2 * np.pi), rel=2e-3)
    assert found.gain_margin == pytest.approx(20 * np.log10(gain), rel=5e-3)
    assert found.phase_margin == pytest.approx(phase, rel=5e-3)


def test_poles_and_zeros_are_those_of_the_control_library(linear, loops):
    found = poles_and_zeros(fit_of({}), linear.run, ACTUATOR)
    poles = np.array([complex(r.real, r.imaginary) for r in found.roots if r.kind == "pole"]) * 2 * np.pi
    assert np.sort_complex(poles) == pytest.approx(np.sort_complex(loops[1].poles()), rel=1e-6)
    assert [root for root in found.roots if root.kind == "zero"] == []
    integral = fit_of({"integral_action.gain": 20.0})  # Kp (1 + Ki/s), whose zero is at −Ki
    (zero,) = (root for root in poles_and_zeros(integral, linear.run, ACTUATOR).roots if root.kind == "zero")
    assert (2 * np.pi * zero.real, zero.imaginary) == pytest.approx((-20.0, 0.0), rel=1e-6)


def test_a_step_has_the_rise_overshoot_and_settling_of_the_control_library(linear, loops, control):
    seconds = duration(fit_of({}), linear.run, ACTUATOR)
    found = step_response(fit_of({}), linear.run, ACTUATOR, 1.27e-3, seconds)
    known = control.step_info(loops[1], T=found.time[found.time >= 0])
    assert found.final / found.size == pytest.approx(known["SteadyStateValue"], rel=2e-3)
    assert found.rise == pytest.approx(known["RiseTime"], rel=0.01)
    assert found.settling == pytest.approx(known["SettlingTime"], rel=0.01)
    assert 100 * found.overshoot == pytest.approx(known["Overshoot"], abs=0.05)


def test_the_band_of_a_line_holds_what_other_parameters_would_give(linear):
    """Standard errors of 1 % each, against 400 draws of the parameters, through the closed form."""
    frequency = np.array([2.0, 10.0, 30.0, 60.0])
    found = response_error(fit_of({}), linear.run, ACTUATOR, frequency)
    rng, s = np.random.default_rng(1), 2j * np.pi * frequency[:, None]
    p = {name: getattr(PLANT, name) * (1 + 0.01 * rng.standard_normal(400)) for name in PLANT._fields if name != "A"}
    q = GAIN * p["Z0"] / PLANT.A / (p["tau"] * s + 1)
    load = (p["m0"] + MASS) * s**2 + p["c0"] * s + STIFFNESS
    opened = q * PLANT.A / ((p["Ka"] * s + p["Cl"]) * load + PLANT.A**2 * s)
    drawn = np.log(opened / (1 + opened))
    assert found is not None
    assert found[0] == pytest.approx(drawn.real.std(axis=1), rel=0.15)
    assert found[1] == pytest.approx(drawn.imag.std(axis=1), rel=0.15)


def test_a_lag_of_the_acquisition_shows_in_the_line_as_it_is(command, loops):
    """An effect that is linear has an exact frequency response, which the describing gain has to meet."""
    found = compare(
        Matrix(ACTUATOR, (run_of(command, command.copy()),)), fit_of({"acquisition_lag.time_constant": LAG})
    ).runs[0]
    frequency = np.geomspace(1.5, 75, 60)
    s = 2j * np.pi * frequency
    exact = loops[1](s) / (LAG * s + 1)
    assert np.abs(found.response(frequency) / exact - 1).max() < 0.01


def test_the_describing_gain_of_a_dead_zone_is_that_of_an_independent_simulation(command):
    """Of the last of three periods, where the response is periodic, over an eighth of a frequency."""
    cell, zone = Cell(MASS, STIFFNESS, 0.0, GAIN), nonlinear.effects(dead_zone_h=HALF_WIDTH)
    measured = nonlinear.respond(PLANT, zone, cell, command).displacement
    n = len(command) // 3
    u, x = np.fft.rfft(command[-n:]), np.fft.rfft(measured[-n:])
    fit = fit_of({"dead_zone.half_width": HALF_WIDTH, "dead_zone.skew": 0.0})
    (found,) = compare(Matrix(ACTUATOR, (run_of(command, measured),)), fit).runs
    assert found.error < 0.01  # the two simulations are of one machine
    for centre in (5.0, 12.0, 25.0, 45.0):
        lines = np.arange(round(centre * 0.94 * 2), round(centre * 1.06 * 2) + 1)
        response = found.response(lines / 2)
        expected = (u[lines] * response).conj() @ x[lines] / np.sum(np.abs(u[lines] * response) ** 2)
        assert abs(expected - 1) < 0.02
    without = compare(Matrix(ACTUATOR, (run_of(command, measured),)), fit_of({})).runs[0]
    assert abs(without.response(np.array([12.0])) / found.response(np.array([12.0])) - 1)[0] > 0.05


def test_the_bars_of_measured_points_hold_the_scatter_of_an_estimate():
    """Noise in the output, 40 records: the relative standard error of the H1 estimate is what is stated."""
    found, stated = [], []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        u = rng.standard_normal(8 * 1024)
        run = replace(run_of(u, u + rng.standard_normal(len(u))), sample_rate=1024.0)
        (one,) = compare(Matrix(ACTUATOR, (run,)), fit_of({})).runs
        found.append(one.measured[20:400])
        stated.append(one.random_error[20:400])
    scatter = np.sqrt(0.5 * np.mean(np.abs(np.array(found) - 1) ** 2))
    assert scatter == pytest.approx(np.sqrt(np.mean(np.square(stated))), rel=0.1)
