"""Blind trials of what no list holds: the equations are those of the reference, and a trial judges what was found."""

from __future__ import annotations

import numpy as np
import pytest

from ident.comparison.compare import modelled
from ident.custom.definition import preset_with
from ident.preprocessing import prepare
from tests.blind.unlisted import key, outcome, table
from tests.blind.unlisted_effects import KIND, MODEL, Secret, written
from tests.reference import qian_reference as linear
from tests.reference.unlisted_reference import NAMES, Hidden, drawn

PLANT = linear.Plant()


@pytest.mark.full
@pytest.mark.parametrize("name", NAMES)
def test_an_equation_as_a_user_writes_it_is_that_of_the_reference(name):
    hidden = drawn(name, np.random.default_rng([5, NAMES.index(name)]))
    machine = Secret(PLANT, hidden._replace(s=0.1 * hidden.s), 0.005, 1)
    clean, own = machine.measured(machine.trials[4:6], noise=0.0), written(machine.hidden)
    model, driven = prepare(preset_with(MODEL, (own["name"],), (own,)), clean)
    values = {p.in_equations: getattr(PLANT, p.name, p.value) for p in model.parameters}
    linear_outputs = modelled(model, values, driven)
    outputs = modelled(model, {**values, model.parameter(f"{own['name']}.s").in_equations: machine.hidden.s}, driven)
    for run in clean.runs:
        size = run.measured.std()
        assert np.std(run.measured - outputs[run.id]) < 1e-3 * size
        assert np.std(run.measured - linear_outputs[run.id]) > 2e-3 * size


@pytest.mark.full
def test_a_trial_says_what_was_found_and_whether_it_is_the_truth():
    hidden = Hidden(NAMES.index("square_leakage"), 0.2)
    row = {
        "kind": KIND[hidden.name],
        "effect": hidden.name,
        "seed": 1,
        "level": 3.0,
        "matrix": "small",
        "catalogue": False,
        "reachable": True,
    } | outcome(Secret(PLANT, hidden, 0.005, 1), catalogue=False)
    assert row["found"] == ["Q = Q + s * (P * abs(P))"]
    assert row["accepted"]
    assert row["right"]
    assert row["verify"] == pytest.approx(1.0, abs=0.03)
    assert row["off_new"] < 0.1
    assert key(row) == ("square_leakage", 1, 3.0, "small", False)
    assert "| one signal | 1 | 1 | 1 | 1 | 0 |" in "\n".join(table([row]))
