"""The machine that is taken is said to be the most probable."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis import structure_selection
from ident.diagnosis.structure_selection import compared_structures
from ident.matrix import Actuator, Matrix
from ident.run import Run

RUN = Run(
    "r",
    "",
    100.0,
    {"command": np.ones(9), "velocity": np.ones(9)},
    {"command": "1", "velocity": "rad/s"},
    output="velocity",
)


def model(machine: str, error: float) -> Any:
    return SimpleNamespace(
        machine=machine, error=error, parameters=2, size=2, integrates=False, at_bound=False, fit=None,
        best=SimpleNamespace(residuals_held_out=machine),
        structure=lambda _over, _why, probability: SimpleNamespace(machine=machine, probability=probability),
    )  # fmt: skip


def test_the_machine_taken_is_the_most_probable_of_all_that_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """Their disturbance is common to all of them: beside a valve that explains little a motor is the more probable, and
    without it the lag is."""
    lag, motor, valve = model("first_order", 0.25), model("motor", 0.22), model("open_valve", 0.85)
    gains = {"open_valve": {"open_valve": 0.0, "first_order": 66.0, "motor": 108.0},
             "first_order": {"first_order": 0.0, "motor": -9.0}}  # fmt: skip
    for name, instead in {
        "_all_fitted": lambda *_: {one.machine: one for one in (lag, motor, valve)},
        "_judged": lambda _: (None, [lag, motor, valve]),
        "_with_an_effect_each": lambda *_: {"first_order": lag, "motor": motor},
        "finite_everywhere": lambda _: True,
        "common_disturbance": lambda residuals: gains[residuals[0]],
        "gain": lambda _first, of, by_reference: by_reference[of],
    }.items():
        monkeypatch.setattr(structure_selection, name, instead)
    first, *others = compared_structures(Matrix(Actuator("M"), (RUN,)))
    assert first.machine == "motor"
    assert first.probability == pytest.approx(1.0, abs=1e-3)
    assert {one.machine for one in others} == {"first_order", "open_valve"}
