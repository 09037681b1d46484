"""Machines of a lab that nobody described, from recursions of their own: the structure, and what is hidden."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blind.any_machine import Lab
from tests.blind.any_trial import rates, trial


@pytest.mark.parametrize("seed", [3, 301])
def test_a_machine_nobody_described_is_taken_for_what_it_is(seed, full):
    if not full:
        pytest.skip("half a minute each: run with --full")
    outcome = trial(seed, hidden=True)
    assert outcome.structure_right, str(outcome)
    assert outcome.named, str(outcome)
    assert outcome.error < 1.1 * outcome.lab.noise, str(outcome)


@pytest.mark.full
@pytest.mark.parametrize("seed", [2, 3])
def test_where_nothing_is_hidden_nothing_is_found(seed):
    outcome = trial(seed, hidden=False)
    assert outcome.structure_right, str(outcome)
    assert outcome.effects == (), str(outcome)


def test_rates_over_a_hundred_labs_of_each_kind(full):
    """Structure right in 90 %, the hidden effect named in 90 %, nothing found where nothing is in 97 %."""
    if not full:
        pytest.skip("hours long: run with --full")
    outcomes = [trial(seed, hidden, 120.0) for seed in range(100, 200) for hidden in (True, False)]
    hidden, others = [o for o in outcomes if o.counts], [o for o in outcomes if not o.lab.hidden]
    assert np.mean([o.structure_right for o in outcomes]) >= 0.9, rates(outcomes)
    assert np.mean([o.named for o in hidden]) >= 0.9, rates(outcomes)
    assert np.mean([o.standing != "found" for o in others]) >= 0.97, rates(outcomes)


def test_labs_are_drawn_of_every_structure_and_kind():
    labs = [Lab.drawn(seed, True) for seed in range(60)]
    assert len({lab.structure for lab in labs}) == 4
    assert len({lab.kind for lab in labs}) == 5
    assert len({lab.hidden for lab in labs}) >= 8
