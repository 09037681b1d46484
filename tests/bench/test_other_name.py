"""A model is what its preset says, whatever it is called: Kononykhin's under another name does all that it does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ident.diagnosis.competing_models import competing_models
from ident.diagnosis.result import Diagnosis, Verdict
from ident.errors import Unusable
from ident.figures import figures_of
from ident.fit.settings import Settings
from ident.presets import PRESETS
from ident.workflows import compare, diagnose, identify
from tests.bench.sets import as_matrix
from tests.mutations import runner
from tests.reference import kononykhin_reference as reference

OTHER = "aviation"


@pytest.fixture
def renamed(monkeypatch) -> str:
    """Kononykhin's preset, also under another name."""
    monkeypatch.setitem(PRESETS, OTHER, replace(PRESETS["kononykhin"], name=OTHER))
    return OTHER


def test_under_another_name_the_model_is_fitted_compared_drawn_and_diagnosed_alike(renamed, full):
    if not full:
        pytest.skip("ten seconds: run with --full")
    truth = reference.scattered(12)
    matrix = as_matrix(truth, reference.full_set(truth, 12))
    fits = [identify(matrix, Settings(model=name, method="gradient")) for name in ("kononykhin", renamed)]
    assert fits[1].model == renamed
    assert fits[0].parameters == fits[1].parameters
    assert compare(matrix, fits[0]).error == compare(matrix, fits[1]).error
    assert figures_of(fits[0]) == figures_of(fits[1])
    found = [diagnose(matrix, fit, most=0).candidates for fit in fits]
    assert found[0] == found[1]
    with pytest.raises(Unusable, match="bench"):
        competing_models(Diagnosis(model=renamed, candidates=(), verdict=Verdict()))


def test_under_another_name_the_preset_passes_its_tests(tmp_path, full):
    """In a copy in which the preset and its tests say another name, and nothing else was changed."""
    if not full:
        pytest.skip("the tests of the bench once more, a minute long: run with --full")
    copy = runner.copied(tmp_path)
    here = Path(__file__).name
    for file in (copy / "ident/presets/kononykhin.py", *(copy / "tests/bench").glob("*.py")):
        if file.name == here:
            file.unlink()
            continue
        text = file.read_text(encoding="utf-8")
        file.write_text(text.replace('"kononykhin"', f'"{OTHER}"'), encoding="utf-8")
    assert runner.tested(copy, ("tests/bench",)) == (0, "")
