"""The reference for machines that lack several effects, against what is known of each exactly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.blind.several import EFFECTS, MACHINES, NAMES, Several

PLAIN = Several(0, "lag", (), "steps", 20.0, 1.0, 100.0, 0.01, "V")


def stepped(of: Several, size: float = 1.0) -> np.ndarray:
    """The answer from a step of the command on."""
    return of.answer(np.where(np.arange(1800) < 10, 0.0, size))[10:]


@pytest.mark.parametrize(("kind", "constant"), [("lag", 20.0), ("speed", 20.0)])
def test_a_step_is_answered_by_an_exponential(kind, constant):
    answer = stepped(replace(PLAIN, kind=kind))
    assert answer == pytest.approx(1.0 - np.exp(-np.arange(1790) / constant), abs=2e-3)


def test_a_delay_shifts_and_friction_and_dead_zone_take_their_part():
    of = replace(PLAIN, kind="speed")
    late = stepped(replace(of, hidden=("delay",)))
    assert late[5:] == pytest.approx(stepped(of)[:-5], abs=1e-9)
    assert stepped(replace(of, hidden=("dry friction",)))[-1] == pytest.approx(0.7)
    assert stepped(replace(of, hidden=("dead zone",)))[-1] == pytest.approx(0.65)
    assert stepped(replace(of, hidden=("limit",)))[-1] == pytest.approx(0.75)
    assert stepped(replace(of, hidden=("dry friction",)), 0.29)[-1] == 0.0


def test_every_kind_has_its_machines_and_every_effect_its_names():
    assert EFFECTS.keys() == MACHINES.keys()
    assert {name for names in EFFECTS.values() for name in names} | {"spring"} == NAMES.keys()
    for seed in range(12):
        of = Several.drawn(seed)
        assert np.all(np.isfinite(of.answer(of._commanded(np.random.default_rng(seed)))))
