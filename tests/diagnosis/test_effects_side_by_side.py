"""Effects are looked at side by side, few at a time: what one promises hangs on no other."""

from __future__ import annotations

import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.screening import predict
from ident.fit.settings import Settings
from tests.diagnosis.test_diagnose import measured
from tests.fit.test_windows import cylinder


def test_what_an_effect_promises_hangs_on_none_beside_it(monkeypatch):
    models = CandidateModels.of(measured(dead_zone=2.5e-4), Settings())
    base = models.refit((), {p.in_equations: p.value for p in models.preset.parameters})
    names = list(models.effects)[::3]
    together = predict(models, base, names)
    monkeypatch.setattr("ident.diagnosis.candidate_models._EFFECTS_A_CHAIN", 1)
    for one, alone in zip(together, predict(models, base, names), strict=True):
        assert one.effect == alone.effect
        assert one.after.score == pytest.approx(alone.after.score, rel=1e-3)


def test_every_effect_is_in_one_group_and_no_group_closes_a_circle():
    """In a drive without a valve some effects read each other; those with shapes to search stand alone."""
    matrix = cylinder(2, wander=1e-3)
    for model in ("motor", "open_valve"):
        models = CandidateModels.of(matrix, Settings(model=model))
        names = list(models.effects)
        groups = models.groups((), names)
        assert sorted(name for group in groups for name in group) == sorted(names)
        assert all(len(group) <= 8 for group in groups)
        for group in groups:
            assert models.model(group).chain.signals
            assert len(group) == 1 or not any(models.effects[name].has_searched_shapes for name in group)
