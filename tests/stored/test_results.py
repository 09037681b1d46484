"""What earlier versions wrote is read, and goes out again as it came in: library, files and HTTP say the same."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, get_args, get_type_hints

import pytest
from pydantic import BaseModel

from app.cli.input_files import read_diagnosis, read_fit
from ident.diagnosis.competing_models import competing_models
from ident.diagnosis.result import Diagnosis, LabelErrors, Verdict
from ident.errors import Unusable
from ident.fit.result import FitResult
from schemas.diagnosis import DiagnosisView
from schemas.diagnosis_result import DiagnosisResult
from schemas.fit import FitView, LadderView
from schemas.result import FitResultView

HERE = Path(__file__).parent
FITS = ("fit", "bench")
DIAGNOSES = ("diagnosis", "bench-diagnosis")


def stored(name: str) -> dict[str, Any]:
    """The JSON of a file as `--json` wrote it."""
    data: dict[str, Any] = json.loads((HERE / f"{name}.json").read_text(encoding="utf-8"))
    return data


def again(data: object) -> object:
    """As a file or a database gives it back."""
    return json.loads(json.dumps(data, allow_nan=False))


@pytest.mark.parametrize("name", FITS)
def test_a_fit_goes_out_as_it_came_in(name):
    """From its file, and over HTTP."""
    assert again(read_fit(HERE / f"{name}.json").to_json()) == stored(name)
    assert FitResultView(**stored(name)).model_dump(mode="json", exclude_unset=True) == stored(name)


@pytest.mark.parametrize("name", DIAGNOSES)
def test_a_diagnosis_goes_out_as_it_came_in(name):
    """From its file, with its keys in their order, and over HTTP; that it is complete is said since."""
    found = again(read_diagnosis(HERE / f"{name}.json").to_json())
    assert found.pop("complete") is True
    assert json.dumps(found) == json.dumps(stored(name))
    assert DiagnosisResult(**stored(name)).model_dump(mode="json", exclude_unset=True) == stored(name)


def test_the_first_versions_knew_less_and_later_ones_know_more():
    """What is not there, or null, takes its default; what is not known is passed over."""
    data = stored("diagnosis")
    for key in ("budget", "next_experiment", "settings", "notes", "seconds"):
        del data[key]
    data["ladder"][1]["deviations"] = data["ladder"][1].pop("nats")
    data["candidates"][0]["group"] = None
    data["verdict"]["suspects"] = [{"run": "r", "what": "mass", "evidence": "its error is large"}]
    found = Diagnosis.from_json(data)
    assert (found.budget, found.next_experiment, found.settings, found.notes) == (None, None, {}, ())
    assert (found.ladder[1].nats, found.candidates[0].group) == (None, ())
    assert found.verdict.suspects[0].error == LabelErrors()
    said = found.to_json()
    assert (said["budget"], said["next_experiment"], said["verdict"]["suspects"][0]["unit"]) == ({}, {}, "1")
    fit = stored("fit")
    for key in ("notes", "settings", "searched", "evolution"):
        del fit[key]
    assert FitResult.from_json(fit | {"later": 1}).evolution == ()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"candidates": 3}, "candidates is not a list"),
        (
            {"candidates": [{"effect": "lead", "error": {"fit": "small"}}]},
            r"candidates\[0\]\.error\.fit is not a number",
        ),
        ({"verdict": {"effects": [1]}}, r"verdict\.effects\[0\] is not text"),
        ({"verdict": {"unexplained": 0}}, r"verdict\.unexplained is neither true nor false"),
        ({"seed": 1.5}, "seed is not a whole number"),
        ({"budget": {"linear": 0.1}}, r"budget\.noise is missing"),
        (
            {"budget": {"noise": 0, "linear": 0, "nonlinear": 0, "bounds": {"noise": [1]}}},
            "bounds.noise is not a list of",
        ),
    ],
)
def test_what_is_no_diagnosis_is_refused_with_the_entry_at_fault(change, said):
    with pytest.raises(Unusable, match=f"not the JSON of a diagnosis: .*{said}") as refused:
        Diagnosis.from_json(stored("diagnosis") | change)
    assert refused.value.code == "bad-diagnosis"


@pytest.mark.parametrize("text", ["no json", "[]", "{}", '{"model": "qian2014"}', "[" * 100_000])
def test_a_file_that_is_no_result_is_refused_by_its_name(tmp_path, text):
    file = tmp_path / "x.json"
    file.write_text(text)
    for read, code in ((read_fit, "bad-fit"), (read_diagnosis, "bad-diagnosis")):
        with pytest.raises(Unusable, match=r"x\.json") as refused:
            read(file)
        assert refused.value.code == code


def test_a_fit_with_a_value_that_is_no_number_is_refused(tmp_path):
    for value in ("NaN", "1e999", '"1"', "true", "null"):
        data = stored("fit")
        data["parameters"]["tau"]["value"] = "HERE"
        file = tmp_path / "fit.json"
        file.write_text(json.dumps(data).replace('"HERE"', value))
        with pytest.raises(Unusable, match="not the JSON of a fit"):
            read_fit(file)


def test_a_stored_diagnosis_says_which_models_are_in_question_and_whose_label_is_doubted():
    found = Diagnosis.from_json(stored("diagnosis"))
    asked = competing_models(found)
    assert asked.models
    assert asked.noise == found.noise_floor["fit"]
    assert asked.doubted == {suspect["run"] for suspect in stored("diagnosis")["verdict"]["suspects"]}
    with pytest.raises(Unusable, match="bench"):
        competing_models(Diagnosis.from_json(stored("bench-diagnosis")))
    assert competing_models(Diagnosis(candidates=(), verdict=Verdict())).models == ()


def parts(annotation: Any) -> Iterator[Any]:
    """An annotation and all that it is made of."""
    yield annotation
    for part in get_args(annotation):
        yield from parts(part)


def differences(result: Any, model: type[BaseModel]) -> Iterator[str]:
    """Fields that only one of the two has, also within what they hold."""
    of_result, of_model = get_type_hints(result), model.model_fields
    written = {field.name for field in fields(result) if field.metadata.get("written", True)}
    yield from (f"{model.__name__}.{name}" for name in written ^ of_model.keys())
    for name in written & of_model.keys():
        inner = [part for part in parts(of_result[name]) if is_dataclass(part)]
        models = [part for part in parts(of_model[name].annotation) if hasattr(part, "model_fields")]
        for one, other in zip(inner, models, strict=False):  # settings are a mapping here, and a model there
            yield from differences(one, other)


def test_a_client_without_the_library_reads_every_field_of_a_result():
    """`schemas` says again what the library's results hold, for it imports nothing of the library."""
    assert set(differences(FitResult, FitResultView)) == {"FitResultView.machine"}  # of the model, where it is sent
    assert not set(differences(Diagnosis, DiagnosisResult))


def anything(schema: Any, path: str = "") -> Iterator[str]:
    """The places of a JSON schema that say nothing of what may stand there."""
    if isinstance(schema, dict):
        said = {"type", "$ref", "anyOf", "oneOf", "allOf", "const", "enum"} & schema.keys()
        if not said:
            yield path
        if schema.get("type") == "object" and not {"properties", "additionalProperties"} & schema.keys():
            yield path
        if schema.get("additionalProperties") is True:
            yield path
        parts = {**schema.get("properties", {}), **schema.get("$defs", {})}
        parts |= {"[]": schema["items"]} if "items" in schema else {}
        parts |= {"*": schema["additionalProperties"]} if isinstance(schema.get("additionalProperties"), dict) else {}
        for number, one in enumerate([*schema.get("anyOf", ()), *schema.get("prefixItems", ())]):
            parts[str(number)] = one
        for name, part in parts.items():
            yield from anything(part, f"{path}.{name}")


@pytest.mark.parametrize("model", [DiagnosisView, FitView, LadderView])
def test_the_document_shows_a_result_in_full(model):
    """No place of it is said to hold just anything."""
    found = set(anything(model.model_json_schema(mode="serialization")))
    assert found - {".$defs.Nothing"} == set()
