"""A larger machine makes up for an effect that a smaller one lacks: the smaller ones are compared with theirs."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis import structure_selection
from ident.diagnosis.structure_selection import compared_structures
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.progress import silent
from ident.run import Run

RATE, SAMPLES, PARTS = 200.0, 1800, 30


@pytest.mark.parametrize(("error", "after", "effects"), [(9.5, 0.05, 2), (10.5, 0.05, 1), (9.5, 0.5, 2), (9.5, 1.5, 1)])
def test_a_smaller_machine_with_two_effects_is_compared_where_it_explains_more_than_a_larger_one(error, after, effects):
    """A motor behind a spring with friction: a valve and oil make up for either, and have three parameters more.

    Whether the motor then explains all, or only more than the valve with its effect, which leaves 1.0.
    """

    def model(machine: str, size: int, error: float, more: float) -> SimpleNamespace:
        of = SimpleNamespace(machine=machine, size=size, error=error, above_noise=error > 0.1, with_effect="an effect")
        of.helped = lambda _report: model(machine, size + 1, more, more)
        return of

    valve, motor = model("open_valve", 6, 1.0, 0.05), model("motor", 3, error, after)
    found = structure_selection._explaining(motor, [valve, motor], silent)  # type: ignore[arg-type]
    assert found.size == 2 + effects
    assert structure_selection._explaining(valve, [valve, motor], silent) is valve  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("size", "noise", "machines"),
    [(2, True, {"open_valve", "motor"}), (2, False, {"open_valve"}), (4, True, {"open_valve"})],
)
def test_a_smaller_machine_that_explains_the_records_with_an_effect_is_compared(size, noise, machines):
    """A late motor: the lags of a valve and of oil explain it as well, by two parameters more."""

    def model(machine: str, size: int, above_noise: bool) -> SimpleNamespace:
        of = SimpleNamespace(machine=machine, parameters=size, error=1.0, above_noise=above_noise)
        of.helped = lambda _report: SimpleNamespace(machine=machine, error=1.0, above_noise=not noise)
        return of

    valve, motor = model("open_valve", 5, above_noise=False), model("motor", size, above_noise=True)
    found = structure_selection._with_an_effect_each(valve, [valve, motor], silent)  # type: ignore[arg-type, list-item]
    assert found.keys() == machines


@pytest.mark.parametrize(
    ("probability", "noise", "more"), [(0.9, False, {"motor", "lag"}), (0.1, False, set()), (0.9, True, set())]
)
def test_where_the_likeliest_machine_is_not_the_one_with_the_least_error_both_get_one_more_effect(
    probability, noise, more
):
    """Each lacks another part: a car that has a late engine was a lag with a loop, and a motor with a drag."""

    def model(machine: str, error: float) -> SimpleNamespace:
        of = SimpleNamespace(machine=machine, error=error, above_noise=not noise, with_effect="an effect")
        of.helped = lambda _report: of
        return of

    models: Any = {"motor": model("motor", 0.08), "lag": model("lag", 0.11), "valve": model("valve", 0.2)}
    probable = {"lag": probability, "motor": 1.0 - probability, "valve": 0.0}
    assert structure_selection._more_effects(models, probable, silent).keys() == more


@pytest.mark.parametrize(("model", "all_of_them"), [("first_order", True), ("motor", False)])
def test_all_effects_of_a_lag_are_tried(monkeypatch, model, all_of_them):
    """It has few. Of a late command half as much was predicted as of two poles, which leave twice the noise."""
    asked = []
    monkeypatch.setattr(structure_selection, "rank", lambda *_args, thorough: asked.append(thorough) or [])
    models = SimpleNamespace(effects={"command_delay": None}, horizon=None, preset=preset(model))
    fitted = SimpleNamespace(finite=True, effects=())
    structure_selection._JudgedStructure(models, 2, {}, fitted).helped(silent)  # type: ignore[arg-type]
    assert asked == [all_of_them]


def turned(number: int, use: str) -> Run:
    """The angle of a motor with dry friction whose command is late by five samples; 30 steps a sample.

    T ω' = u − ω − friction, T of 20 samples.
    """
    rng = np.random.default_rng([91, number])
    t = np.arange(SAMPLES)
    u = sum(np.sin(2 * np.pi * f * t + rng.uniform(0.0, 6.28)) for f in np.linspace(0.001, 0.025, 12)) / np.sqrt(6.0)
    u[: SAMPLES // 25] = 0.0
    late = np.concatenate([np.zeros(5), u[:-5]])
    constant, dry, step, speed, angle, out = 20.0, 0.25, 1.0 / PARTS, 0.0, 0.0, np.zeros(SAMPLES)
    for k in range(SAMPLES):
        out[k] = angle
        for _ in range(PARTS):
            free, stop = speed + step / constant * (late[k] - speed), step / constant * dry
            speed = free - stop if free > stop else free + stop if free < -stop else 0.0
            angle += step * speed
    out += 0.003 * out.std() * rng.standard_normal(SAMPLES)
    units = {"command": "1", "displacement": "rad"}
    return Run(f"r{number}", "", RATE, {"command": u, "displacement": out}, units, hold="zoh", use=use)


@pytest.mark.full
def test_a_late_motor_with_friction_is_no_valve_with_oil():
    """With one effect each the valve leaves a quarter of what the motor leaves, and both far more than the noise."""
    runs = tuple(turned(number, use) for number, use in enumerate(("fit", "fit", "verify")))
    first, *others = compared_structures(Matrix(Actuator("MOTOR"), runs))
    assert first.machine == "motor"
    assert "command delay and" in first.why
    assert "open_valve" in {one.machine for one in others}
