"""A diagnosis becomes cards: a group is one, a doubted label and what is left have their own."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

from app.diagnoses.service import Stored
from app.pages.diagnosis_view import missing
from app.pages.rendering import _TEMPLATES
from ident.diagnosis.result import Diagnosis


def candidate(effect: str, error: float, group: tuple[str, ...] = (), beyond: bool = True) -> dict[str, Any]:
    parameters = {f"{effect}.force": {"value": 8.51, "unit": "N", "std_error": 0.41, "symbol": "F"}}
    return {
        "effect": effect,
        "error": {"fit": error, "held_out": error, "verify": None},
        "predicted_error": error,
        "parameters": parameters,
        "group": list(group),
        "why": "Because.",
        "evidence": {"beyond_chance": beyond, "looks": "flat tops"},
    }


def found() -> Stored:
    group = ("coulomb_friction", "stribeck_friction")
    suspect = {
        "run": "r <1>",
        "what": "mass",
        "stated": 2.67,
        "found": 0.9,
        "unit": "kg",
        "evidence": "the error is 9 %",
    }
    said = {
        "model": "qian2014",
        "budget": {},
        "next_experiment": {},
        "baseline": {"error": {"fit": 0.02, "held_out": 0.02, "verify": None}, "offset": 0.0},
        "noise_floor": {"fit": 0.005, "verify": None}, "seconds": 3.2,
        "candidates": [candidate("coulomb_friction", 0.01, group), candidate("stribeck_friction", 0.0101, group),
                       candidate("own_effect", 0.012), candidate("lead", 0.0199, beyond=False)],
        "ladder": [{"added": None, "error": {"fit": 0.02}, "parameters": {}, "nats": None},
                   {"added": "coulomb_friction", "error": {"fit": 0.01}, "parameters": {}, "nats": 7.0}],
        "verdict": {"effects": ["coulomb_friction"], "indistinguishable": [list(group)], "suspects": [suspect],
                    "unexplained": True, "text": "The model lacks something."},
    }  # fmt: skip
    return Stored("d", "m", "S", "f", "2026-11-21T08:00:00", Diagnosis.from_json(said))


def test_a_group_is_one_card_that_names_all_and_adds_one():
    group, own = missing(found(), None).cards
    assert group.title == "Coulomb friction or Stribeck friction"
    assert [member.name for member in group.addable] == ["coulomb_friction", "stribeck_friction"]
    assert (group.chosen, own.chosen) == (True, False)
    assert group.gauge == (50.0, 50.0, 25.0)
    assert group.members[0].strength == "8.51 ± 0.41 N"
    assert own.addable == ()  # not of this catalogue


def test_what_does_not_help_stands_apart_and_what_is_left_is_said():
    lacks = missing(found(), None)
    assert [card.title for card in lacks.chance] == ["lead"]
    assert lacks.left == "The error is 1.00 % with all recommended effects, above the noise floor of 0.500 %."
    assert [rung.nats for rung in lacks.ladder] == ["–", "7.00"]
    assert (lacks.suspects[0].stated, lacks.suspects[0].found) == ("2.670 kg", "0.9000 kg")


ANYBODY = SimpleNamespace(has=lambda _role: True)


def test_the_section_is_markup_with_everything_escaped():
    page = {"id": "f", "serial": "S", "matrix": "m", "again": "{}", "on_bench": False, "kept": ()}
    page |= {"missing": missing(found(), None)}
    text = _TEMPLATES.get_template("missing.html").render(fit=page, vega="", who=ANYBODY)
    assert "r &lt;1&gt;" in text
    assert "These 2 effects are" in text
    assert "{&#34;runs&#34;: {&#34;r &lt;1&gt;&#34;: {&#34;specimen&#34;: {&#34;mass&#34;: &#34;0.9 kg&#34;}}}}" in text
    assert text.count('data-add="/api/v1/fits/f/effects"') == 2  # the group and the one by chance
    assert "It shows as: flat tops." in text


def vague() -> Stored:
    """The strength of what the search would add is (35 ± 15023)·10⁻¹²."""
    stored = found()
    first, *others = stored.found.candidates
    lost = {name: replace(entry, value=35e-12, std_error=15023e-12) for name, entry in first.parameters.items()}
    ranked = (replace(first, parameters=lost, group=()), *(replace(one, group=()) for one in others))
    return replace(stored, found=replace(stored.found, candidates=ranked))


def test_a_strength_that_is_not_determined_is_called_so_and_not_offered_by_a_main_button():
    page = {"id": "f", "serial": "S", "matrix": "m", "again": "{}", "on_bench": False, "kept": ()}
    shown = [
        _TEMPLATES.get_template("missing.html").render(fit=page | {"missing": missing(of, None)}, vega="", who=ANYBODY)
        for of in (found(), vague())
    ]
    assert ["not identifiable (±" in text for text in shown] == [False, True]
    assert ['class="main">Add the effect' in text for text in shown] == [True, False]
    assert "not identifiable" in str(vague().found)
