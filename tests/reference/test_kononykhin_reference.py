"""The judge of the bench's procedures stands on its own feet."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

from tests.reference import kononykhin_reference as reference


def test_it_imports_nothing_of_the_program():
    tree = ast.parse(Path(reference.__file__).read_text(encoding="utf-8"))
    imported = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    imported |= {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    assert imported <= {"__future__", "dataclasses", "typing", "numpy", "numba", "numpy.typing"}


@pytest.mark.full
def test_finer_steps_change_nothing(monkeypatch):
    """Four times as many: within 0.02 % of each sine's deviation."""
    truth = reference.scattered(0)
    coarse = reference.full_set(truth, 0)
    monkeypatch.setattr(reference, "SUBSTEPS", 4 * reference.SUBSTEPS)
    for before, after in zip(coarse, reference.full_set(truth, 0), strict=True):
        if before.kind == "frequency":
            difference = np.std(before.true_position - after.true_position)
            assert difference < 2e-4 * np.std(after.true_position), before.id


def test_at_a_fixed_level_the_speed_is_that_of_the_formula():
    """25 % from a zero shift of 1 %: f at 23.8 %, less what friction takes of 100 MPa, limited to 21."""
    truth = reference.Truth(I0=1.0)
    found = reference.record(
        truth, "r", "speed-levels", 2, [0.0, 25.0, 3.0, 0.3, 2000.0], 2.0, 10.0, np.random.default_rng(0)
    )
    speed = (found.true_position[1900] - found.true_position[900]) / 1.0
    expected = truth.speed(np.array([25.0 - 0.2 - 1.0]))[0] * np.sqrt(1 - 0.5 / 21.0)
    assert speed == pytest.approx(expected, rel=1e-6)


def test_pressures_and_position_are_what_transducers_make_of_them():
    """12 bits over the stroke, 0.2 MPa RMS of each cavity, the middle of both at half the supply."""
    truth = reference.Truth()
    found = reference.full_set(truth, 1)[0]
    steps = found.position / (reference.STROKE / 4096)
    assert steps == pytest.approx(np.round(steps), abs=1e-6)
    assert np.std(np.diff(found.pressure_a)) / np.sqrt(2) == pytest.approx(0.2, rel=0.02)
    assert np.mean(found.pressure_a + found.pressure_b) == pytest.approx(truth.Ps, rel=1e-3)
