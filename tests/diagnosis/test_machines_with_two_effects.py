"""Machines that lack two effects: each takes a part of the error, and a larger machine makes up for one of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis import structure_selection
from ident.diagnosis.structure_selection import compared_structures
from ident.matrix import Actuator, Matrix
from ident.progress import silent
from ident.run import Run

RATE, SAMPLES, PARTS = 200.0, 1800, 30


@pytest.mark.parametrize(("error", "effects"), [(1.9, 2), (2.1, 1)])
def test_a_machine_with_two_effects_is_compared_with_a_larger_one_at_equal_size(error, effects):
    """A motor behind a spring with friction: a valve and oil make up for either, and have three parameters more."""

    def model(machine: str, size: int, error: float, more: float) -> SimpleNamespace:
        of = SimpleNamespace(machine=machine, size=size, error=error, above_noise=error > 0.1, with_effect="an effect")
        of.helped = lambda _report: model(machine, size + 1, more, more)
        return of

    valve, motor = model("open_valve", 6, 1.0, 1.0), model("motor", 3, error, 0.05)
    found = structure_selection._as_large(motor, [valve, motor], silent)  # type: ignore[arg-type]
    assert found.size == 2 + effects
    assert structure_selection._as_large(valve, [valve, motor], silent) is valve  # type: ignore[arg-type]


def link(number: int, use: str) -> Run:
    """A motor with dry friction that turns a link behind a spring, whose angle is recorded; 30 steps a sample.

    T ω' = u − ω − k (θ − θ₁) − friction, θ₁'' = ω₁² (θ − θ₁) − 2 ζ ω₁ (θ₁' − ω), in samples.
    """
    rng = np.random.default_rng([91, number])
    t = np.arange(SAMPLES)
    u = 1.3 * np.sin(2 * np.pi * (0.001 * t + 0.0125 * t**2 / SAMPLES) + number)
    u[: SAMPLES // 25] = 0.0
    constant, swing, dry, step = 20.0, 0.13, 0.25, 1.0 / PARTS
    spring = 0.4 * constant * swing**2
    speed = angle = turning = shown = 0.0
    out = np.zeros(SAMPLES)
    for k in range(SAMPLES):
        out[k] = shown
        for _ in range(PARTS):
            free = speed + step / constant * (u[k] - speed - spring * (angle - shown))
            stop = step / constant * dry
            speed = free - stop if free > stop else free + stop if free < -stop else 0.0
            angle += step * speed
            turning += step * (swing**2 * (angle - shown) - 0.12 * swing * (turning - speed))
            shown += step * turning
    out += 0.007 * out.std() * rng.standard_normal(SAMPLES)
    units = {"command": "1", "displacement": "rad"}
    return Run(f"r{number}", "", RATE, {"command": u, "displacement": out}, units, hold="zoh", use=use)


@pytest.mark.full
def test_a_motor_with_friction_behind_a_spring_is_no_valve_with_oil():
    """With one effect each the valve leaves 2.8 % of the windows, and the motor 4.1 %."""
    runs = tuple(link(number, use) for number, use in enumerate(("fit", "fit", "verify")))
    first, *others = compared_structures(Matrix(Actuator("LINK"), runs))
    assert first.machine == "motor"
    assert "elastic coupling" in first.why
    assert "open_valve" in {one.machine for one in others}


@pytest.mark.full
def test_all_effects_of_a_lag_are_tried_on_short_records():
    """A lag whose command is late, of which less is predicted than of two poles in its place, which leave twice the
    noise: a mass behind a spring leaves less than those.
    """
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        rng = np.random.default_rng([92, number])
        u = np.repeat(rng.choice([-1.0, 1.0], 60), 30)
        u[:72] = 0.0
        late = np.concatenate([np.zeros(5), u[:-5]])
        y = np.zeros(len(u))
        for k in range(1, len(u)):
            y[k] = y[k - 1] + (late[k - 1] - y[k - 1]) * -np.expm1(-1.0 / 25.0)
        y += 0.008 * y.std() * rng.standard_normal(len(u))
        units = {"command": "1", "displacement": "1"}
        runs.append(Run(f"r{number}", "", RATE, {"command": 3.0 * u, "displacement": y}, units, hold="zoh", use=use))
    first, *_ = compared_structures(Matrix(Actuator("LAG"), tuple(runs)))
    assert first.machine == "first_order"
    assert "command delay" in first.why
