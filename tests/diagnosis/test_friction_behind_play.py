"""A damper with dry friction behind a play, and one without the play, by what a diagnosis names."""

from __future__ import annotations

import pytest

from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.diagnosis.damper import Damper, PlayedDamper

FEW = ("coulomb_friction", "presliding_friction", "specimen_hysteresis", "specimen_free_play", "friction_behind_play")


@pytest.fixture(autouse=True)
def _few_effects(monkeypatch, full):
    """In the short form what comes nearest to it is ranked."""
    if not full:
        rank_only(monkeypatch, FEW)


@pytest.mark.full
@pytest.mark.parametrize(("half_width", "contact"), [(4e-3, 3e-3), (4e-3, 1e-4), (1e-2, 1e-4)])
def test_a_play_before_the_friction_is_named_with_its_width_and_its_contact(half_width, contact):
    """Where the contact is hard a sample tells but about on which side of the play it lies: to a few per cent."""
    damper = PlayedDamper(half_width=half_width, contact=contact, seed=3)
    matrix = damper.matrix()
    found = diagnose(matrix, identify(matrix, model="specimen"), propose=False)
    assert found.verdict.effects == ("friction_behind_play",)
    values = found.ladder[-1].parameters
    assert values["friction_behind_play.half_width"].value == pytest.approx(half_width, rel=0.05)
    assert values["friction_behind_play.contact"].value == pytest.approx(contact, rel=0.15)
    assert values["friction_behind_play.force"].value == pytest.approx(damper.friction, rel=0.05)
    assert found.ladder[-1].error["fit"] < 1.05 * damper.noise


@pytest.mark.full
def test_friction_without_a_play_is_named_as_that():
    matrix = Damper(seed=3).matrix()
    found = diagnose(matrix, identify(matrix, model="specimen"), propose=False)
    assert found.verdict.effects == ("presliding_friction",)
