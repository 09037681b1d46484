"""The fit that a diagnosis recommends is the model that it ended with, and never ends above the error it promised."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ident.custom.definition import read_effect
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.recommended import End, recommended, settings_after
from ident.diagnosis.result import Diagnosis
from ident.diagnosis.verification import Contradiction
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.run import over_runs
from ident.workflows import identify
from tests.diagnosis.drawn import BENCH, KINDS, diagnosed, matrix

HERE = Path(__file__).parent
STORED = sorted((HERE / "recommended").glob("*.json"))
"""Of each kind two diagnoses as tests/diagnosis/drawn.py keeps them, the data drawn anew here."""
DRAWN = 200
SAME = 1e-5
"""Relative rise of eq. (17) that is none: what rounding, first states, and the steps of the version that a diagnosis is
of, make of one model on the same runs."""


@cache
def stored(file: Path) -> tuple[Matrix, Diagnosis]:
    """The data of a diagnosis that is kept, and what it found."""
    kind, _, seed = file.stem.partition("-")
    return matrix(kind, int(seed)), Diagnosis.from_json(json.loads(file.read_text()))


def error_of(fit: FitResult) -> float:
    """Eq. (17) on the runs that were fitted, over the windows where the fit has some."""
    found = (fit.window.error if fit.window else fit.error)["fit"]
    assert found is not None
    return found


def judge(data: Matrix, found: Diagnosis, end: End, fit: FitResult) -> None:
    """The model, the runs and the windows are those of the diagnosis; the error is no greater than it says."""
    promised = end.error["fit"]
    assert promised is not None
    assert error_of(fit) <= (1 + SAME) * promised, (end.added, error_of(fit) / promised - 1)
    assert set(fit.effects) == {*found.effects, *end.added}
    assert (fit.window.horizon if fit.window else None) == found.horizon
    assert fit.left_out == found.left_out
    runs = [run for run in data.of_use("fit") if run.id not in found.left_out]
    errors = {run.id: run.error for run in fit.runs}
    assert fit.error["fit"] == pytest.approx(over_runs([errors[run.id] for run in runs], runs), rel=1e-9)
    assert {*errors} == {run.id for run in data.runs}


@pytest.mark.parametrize("file", STORED, ids=lambda file: file.stem)
def test_a_recommended_fit_ends_at_or_below_the_error_of_its_diagnosis(file):
    data, found = stored(file)
    judge(data, found, recommended(found), identify(data, start=found))


@pytest.mark.parametrize("number", range(DRAWN))
def test_so_does_that_of_any_diagnosis(number, full):
    """With the whole catalogue; machines and what is hidden in them are drawn."""
    if not full:
        pytest.skip("half an hour and more: run with --full")
    kind, seed = (KINDS[number % len(KINDS)], number // len(KINDS)) if number % 20 else (BENCH, number // 20)
    data = matrix(kind, seed)
    found = Diagnosis.from_json(json.loads(json.dumps(diagnosed(data, kind).to_json())))
    judge(data, found, recommended(found), identify(data, start=found))


def test_ten_are_kept_two_of_each_kind_with_terms_windows_and_doubted_labels():
    kinds = [file.stem.partition("-")[0] for file in STORED]
    assert kinds == sorted([*KINDS, *KINDS])
    found = [stored(file)[1] for file in STORED]
    assert any(one.horizon for one in found)
    assert sum(bool(one.left_out) for one in found) == 2
    assert sum(bool(one.proposals) for one in found) == 2
    assert sum(bool(recommended(one).added) for one in found) == 9


def test_a_term_that_validation_data_contradict_is_not_recommended():
    """Nor one behind it; nor any where validation data prefer the effects that they stand in place of."""
    found = next(stored(file)[1] for file in STORED if stored(file)[1].proposals)
    (first, *_), bad = found.proposals, Contradiction("t", 0.1, 0.2, 3.0)
    first = replace(first, error={"fit": 0.05, "verify": 0.1})
    second = replace(first, effect={**first.effect, "name": "second"}, contradicted=bad, error={"verify": 0.2})
    third = replace(first, effect={**first.effect, "name": "third"}, error={"verify": 0.15})

    def terms(*proposals: Proposal) -> list[str]:
        return [str(one["name"]) for one in recommended(replace(found, proposals=proposals)).custom]

    assert terms(first, second, third) == [first.effect["name"]]
    mended = replace(third, error={"verify": 0.09})
    assert terms(first, second, mended) == [first.effect["name"], "second", "third"]
    worse = replace(first, contradicted=replace(bad, instead_of=("dead_zone",)))
    assert terms(worse) == []
    assert [str(one["name"]) for one in recommended(replace(found, proposals=(first, second)), 2).custom][1] == "second"


def ends() -> Iterator[tuple[Diagnosis, Matrix, dict]]:
    """Other models of the kept diagnoses: without terms, and with the first effect of the ladder alone."""
    for file in STORED:
        data, found = stored(file)
        if found.proposals:
            yield found, data, {"terms": 0}
        elif len(found.ladder) > 2:
            yield found, data, {"effects": (found.ladder[1].added,)}


def test_other_models_that_it_refitted_are_where_a_fit_may_begin_too():
    tried = list(ends())
    assert len(tried) > 3
    for found, data, chosen in tried:
        end = recommended(found, 0) if "terms" in chosen else None
        fit = identify(data, settings_after(found, **chosen))
        rung = found.ladder[0 if "terms" in chosen else 1]
        assert error_of(fit) <= (1 + SAME) * (rung.error["fit"] or 0.0)
        assert fit.effects == (*found.effects, *((end.added) if end else chosen["effects"]))


def test_a_fit_that_goes_on_from_a_fit_is_not_worse_and_keeps_what_was_held():
    data, _ = stored(STORED[2])
    first = identify(data, Settings(fixed={"tau": 4e-3}, bounds={"Z0": (1e-6, 1e-5)}, options={"generations": 2.0}))
    further = identify(data, start=first)
    assert error_of(further) <= (1 + SAME) * error_of(first)
    assert further.parameters["tau"].fixed
    assert further.values["tau"] == 4e-3
    assert (further.parameters["Z0"].lower, further.parameters["Z0"].upper) == (1e-6, 1e-5)
    assert (further.method, further.evolution) == ("refinement", ())
    assert further.notes[0].startswith("This fit begins where a fit ended, and nothing was searched")
    again = identify(data, Settings.from_json(json.loads(json.dumps(further.to_json()["settings"]))))
    assert again.values == further.values


def test_a_search_beside_the_start_is_never_worse_than_the_start():
    """Two generations of ten: what they find by themselves is far off."""
    data, found = stored(STORED[2])
    settings = replace(settings_after(found, search=True), options={"population": 10.0, "generations": 2.0})
    fit = identify(data, settings)
    assert len(fit.evolution) == 2
    assert error_of(fit) <= (1 + SAME) * (recommended(found).error["fit"] or 0.0)


def test_a_start_where_the_model_is_unstable_is_refused():
    data, found = stored(STORED[2])
    settings = settings_after(found)
    assert settings.start is not None
    values = {**settings.start.values, "Z0": 1e3 * settings.start.values["Z0"]}
    wild = replace(settings, bounds={"Z0": (1e-9, 1.0)}, start=replace(settings.start, values=values))
    with pytest.raises(Unusable, match="unstable where the start ended"):
        identify(data, wild)


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        ({"effects": ("stiction",)}, "refitted no model with just stiction added; choose from "),
        ({"terms": 4}, "4 terms of "),
        ({"effects": ("dead_zone",), "terms": 1}, "give one of the two"),
    ],
)
def test_what_a_diagnosis_did_not_refit_is_refused_with_what_it_did(chosen, said):
    _, found = stored(STORED[-1])
    with pytest.raises(Unusable) as refused:
        settings_after(found, **chosen)
    assert said in str(refused.value)


def definition_with(shape: dict) -> dict:
    """The definition of an effect with that shape."""
    return {
        "name": "proposed_1",
        "place": "spool",
        "equation": ["w = w + s * w * d"],
        "shape": shape,
        "strength": {"symbol": "s", "unit": "1", "lower": -1, "upper": 1},
    }


def test_a_definition_that_a_refit_wrote_is_read_again():
    """A shape that ended at its bound, whatever rounding makes of the bound, in any unit."""
    rng = np.random.default_rng(5)
    for unit, _ in zip(["mm", "ms", "1/s", "kPa"] * 10, range(40), strict=True):
        lower, upper = np.sort(10.0 ** rng.uniform(-6, 3, 2)).tolist()
        for value in (np.nextafter(upper, np.inf), upper * (1 + 4e-16), np.nextafter(lower, 0.0)):
            shape = {"d": {"unit": unit, "lower": lower, "upper": upper, "value": float(value)}}
            read = read_effect(definition_with(shape)).shape[0]
            assert read.lower <= read.value <= read.upper
    shape["d"]["value"] = 1.0001 * upper
    with pytest.raises(Unusable, match="outside its bounds"):
        read_effect(definition_with(shape))
