"""Of each set of effects the best refit is kept, and what speaks for it."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.diagnosis import refitted_sets
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence.comparison import Residuals
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.diagnosis.evidence.probability import NOTHING
from ident.diagnosis.refitted_sets import RefittedSets

NOISE = 0.01 * np.random.default_rng(21).standard_normal(600)
FITNESS = SimpleNamespace(horizon=None)
BANDS = EnergyBands((Record(1.0, floor=1e-4),), (600,))


def refit(*effects: str, left: float, finite: bool = True, free: Sequence[str] = ()) -> Any:
    """A refit with these effects, and free shapes, that leaves noise and so much of a sine; seed 21."""
    residuals = Residuals((NOISE + left * np.sin(np.arange(600) / 7.0),), BANDS)
    held_out = SimpleNamespace(score=residuals.power**0.5)
    space = SimpleNamespace(names=free)
    return SimpleNamespace(
        effects=effects, finite=finite, held_out=held_out, residuals_held_out=residuals, space=space, fitness=FITNESS
    )


def test_the_best_refit_of_each_set_is_kept_and_its_gain_is_over_the_fitted_model():
    sets = RefittedSets(refit("given", left=0.1))
    sets.met([refit("given", "a", left=0.05), refit("given", "a", left=0.0), refit("given", "a", left=0.03)])
    sets.met([refit("given", left=0.0), refit("given", "b", left=0.0, finite=False)])
    sets.met([refit("given", "c", left=np.nan)])  # goes astray without a fold: it would spoil what all have in common
    assert sets.best.keys() == {frozenset("a")}
    found = sets.gains()
    assert found.gains[NOTHING] == 0.0
    assert found.gains[frozenset("a")] > 50
    assert found.most == pytest.approx(found.gains[frozenset("a")], rel=0.05)


def test_the_most_probable_set_has_the_largest_gain_of_those_with_one_effect_exchanged():
    """Not a set of more effects, nor one with two others, nor the fitted set itself, nor one of the same group."""
    sets = RefittedSets(refit(left=0.1))
    named, other, pair = refit("a", left=0.02), refit("b", left=0.01), refit("a", "c", left=0.02)
    sets.met([named, other, pair])
    assert sets.most_probable(named, {}) is other
    assert sets.most_probable(named, {"a": ["b", "a"]}) is None
    assert sets.most_probable(other, {}) is None
    assert sets.most_probable(pair, {}) is None
    sets.met([refit("b", "d", left=0.0)])
    assert sets.most_probable(pair, {}) is None
    sets.met([nearer := refit("a", "d", left=0.0)])
    assert sets.most_probable(pair, {}) is nearer


def test_an_effect_has_to_be_more_probable_than_each_of_the_group_of_the_named_one():
    sets, named = RefittedSets(refit(left=0.1)), refit("a", left=0.02)
    sets.met([named, refit("b", left=0.01), refit("c", left=0.009)])
    assert sets.most_probable(named, {"a": ["a", "c"]}) is None
    sets.met([other := refit("b", left=0.005)])
    assert sets.most_probable(named, {"a": ["a", "c"]}) is other


def test_an_effect_that_is_hardly_probable_takes_the_place_of_none():
    """Two others together leave nothing: neither of the single effects is probable beside them."""
    sets, named = RefittedSets(refit(left=0.1)), refit("a", left=0.09)
    sets.met([named, refit("b", left=0.08)])
    assert sets.most_probable(named, {}) is not None
    sets.met([refit("c", "d", left=0.0)])
    assert sets.most_probable(named, {}) is None


def test_a_set_that_runs_away_is_not_the_most_probable(monkeypatch):
    sets, named = RefittedSets(refit(left=0.1)), refit("a", left=0.02)
    sets.met([named, refit("b", left=0.01)])
    monkeypatch.setattr(refitted_sets, "runs_freely", lambda before, after: before is after or after.effects != ("b",))
    assert sets.most_probable(named, {}) is None


def test_a_width_that_was_freed_is_charged_as_a_parameter():
    """Friction that builds up over no way explains what Coulomb's does: the one with a number more is less probable."""
    width = "presliding_friction__displacement"
    sets = RefittedSets(refit(left=0.1))
    sets.met([refit("coulomb_friction", left=0.0), refit("presliding_friction", left=0.0, free=[width])])
    found = sets.gains().gains
    lost = found[frozenset({"coulomb_friction"})] - found[frozenset({"presliding_friction"})]
    assert lost == pytest.approx(CRITERIA.evidence.least_gain)
