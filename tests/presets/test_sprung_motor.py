"""A motor against a spring, such as a moving coil, a throttle or a pendulum, as SciPy integrates it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy

from ident.diagnosis.structure_selection import choose_structure
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets.suitable_models import in_question
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import of_few_effects

RATE, COUNT = 50.0, 500
OMEGA, DAMPED, PUSH = 6.0, 1.5, 25.0  # rad/s, 1/s, rad/s² for each volt
TURNING = {"command": "V", "displacement": "rad"}


def machine(seed: int, weight: float = 0.0, units: dict[str, str] = TURNING, omega: float = OMEGA) -> Matrix:
    """θ'' + DAMPED θ' + omega² θ = PUSH u under held volts, or `weight` sin θ for the spring; noise of 1 %."""
    runs, t = [], np.arange(COUNT) / RATE
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([71, seed, number])
        u = np.repeat(rng.uniform(-1.2, 1.2, COUNT // 50), 50)

        def rates(now: float, at: np.ndarray, u: np.ndarray = u) -> list[float]:
            back = weight * np.sin(at[0]) if weight else omega**2 * at[0]
            return [at[1], PUSH * u[min(int(now * RATE + 1e-9), COUNT - 1)] - DAMPED * at[1] - back]

        y = scipy.integrate.odeint(rates, [0.0, 0.0], t, tfirst=True, rtol=1e-8, atol=1e-9, hmax=1 / RATE)[:, 0]
        y = y + 0.01 * y.std() * rng.standard_normal(COUNT)
        runs.append(Run(f"r{number}", "", RATE, {"command": u, "displacement": y}, units, hold="zoh", use=use))
    return Matrix(Actuator("COIL"), tuple(runs))


def named(matrix: Matrix) -> set[str]:
    return {known.name for known in in_question(matrix.runs)}


def test_a_mass_that_swings_about_the_place_that_a_voltage_holds_is_on_a_spring():
    matrix = machine(1)
    fit = identify(matrix, Settings(model=choose_structure(matrix).structures[0].machine))
    assert fit.model == "sprung_motor"
    assert fit.error["verify"] < 0.012
    for name, value in {"k0": OMEGA**2, "c0": DAMPED, "Kt": PUSH}.items():
        assert fit.values[name] / fit.values["m0"] == pytest.approx(value, rel=0.02)


@pytest.mark.parametrize(
    ("changed", "is_named"),
    [
        ({}, True),
        ({"units": {"command": "A", "displacement": "m"}}, True),
        ({"units": {"command": "N*m", "displacement": "rad"}}, False),
        ({"omega": 0.0}, False),
        ({"units": {"command": "V", "velocity": "rad/s"}}, True),
    ],
    ids=["volts", "amperes", "a-torque-drives-a-mass", "a-motor-that-integrates", "its-speed"],
)
def test_it_is_in_question_where_a_voltage_or_a_current_makes_a_mass_ring(changed, is_named):
    matrix = machine(2, **changed)
    if "velocity" in matrix.runs[0].units:
        spun = ({"command": run.command, "velocity": run.measured} for run in matrix.runs)
        runs = (replace(run, channels=of, output="velocity") for run, of in zip(matrix.runs, spun, strict=True))
        matrix = replace(matrix, runs=tuple(runs))
    assert ("sprung_motor" in named(matrix)) is is_named


def throttle(seed: int) -> Matrix:
    """θ'' + 2·20 θ' + 15² (θ − 3 u) = −15² F sgn θ′ with F = 0.5 rad of dry friction: no command makes it ring."""
    runs, fine = [], 20
    for number, use in enumerate(("fit", "verify")):
        rng = np.random.default_rng([73, seed, number])
        t = np.arange(3 * COUNT) / RATE
        u = np.sum([np.sin(2 * np.pi * f * t + rng.uniform(0, 6)) for f in (0.15, 0.4, 0.9)], axis=0) / 3
        x, v, y, h = 0.0, 0.0, np.zeros(len(t)), 1.0 / RATE / fine
        for k, volts in enumerate(np.repeat(u, fine)):
            y[k // fine] = x if k % fine == 0 else y[k // fine]
            push, rub = 225.0 * (3 * volts - x) - 40.0 * v, 225.0 * 0.5
            after = v + h * (push - rub * np.sign(v or push))
            v = 0.0 if (v == 0.0 and abs(push) <= rub) or v * after < 0.0 else after
            x += h * v
        y += 0.005 * y.std() * rng.standard_normal(len(y))
        runs.append(Run(f"r{number}", "", RATE, {"command": u, "displacement": y}, TURNING, hold="zoh", use=use))
    return Matrix(Actuator("THROTTLE"), tuple(runs))


@pytest.mark.full
def test_a_throttle_that_friction_keeps_from_ringing_is_a_motor_against_a_spring(full):
    matrix = throttle(1)
    assert "sprung_motor" not in named(matrix)
    with of_few_effects(full, "coulomb_friction", "backlash", "dead_zone"):
        choice = choose_structure(matrix)
        assert choice.structures[0].machine == "sprung_motor"
        found = diagnose(choice.matrix, settings=Settings(model="sprung_motor"), most=1, propose=False)
    assert found.verdict.effects == ("coulomb_friction",)


@pytest.mark.full
def test_a_pendulum_is_a_motor_against_a_spring_that_its_weight_takes_the_place_of(full):
    """A motor that integrates, with the same weight, has no fewer parameters: the weight is the spring."""
    matrix = machine(3, weight=60.0)
    with of_few_effects(full, "arm_gravity", "coulomb_friction", "dead_zone"):
        choice = choose_structure(matrix)
        assert choice.structures[0].machine == "sprung_motor"
        found = diagnose(choice.matrix, settings=Settings(model="sprung_motor"), most=1, propose=False)
    assert found.verdict.effects == ("arm_gravity",)
    assert found.ladder[-1].error["verify"] < 0.015
