"""States that an output does not depend on: a pressure knows no position where no spring holds the mass."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.presets import PRESETS
from tests.acceptance.test_rounding import OPEN, simulated


@pytest.mark.parametrize(
    ("zeros", "output", "states"),
    [
        ({"k", "cL", "mL"}, "load_pressure", ("q1", "P", "v")),
        ({"cL"}, "load_pressure", ("q1", "P", "v", "x")),
        ({"k"}, "displacement", ("q1", "P", "v", "x")),
    ],
)
def test_an_output_depends_on_the_states_that_it_reads_through_others(zeros, output, states):
    chain = PRESETS["qian2014" if output == "displacement" else "open_valve"].chain
    found = {chain.states[i] for i in chain.observed(output, frozenset(zeros))}
    assert found == set(states)


def test_what_integrates_beside_the_output_makes_no_model_unstable():
    """Near the truth, with and without a mass on the rod, none is: the sign of a rounded zero decided before."""
    matrix = simulated("open_valve", OPEN, "load_pressure")
    near = {name: (0.8 * value, 1.25 * value) for name, value in OPEN.items()}
    objective = Identification(matrix, Settings(model="open_valve", bounds=near)).objective
    errors = objective.errors(np.random.default_rng(3).random((200, len(near))))
    assert objective.unstable == 0
    assert errors.max() < 1
