"""The report opens without a network, runs nothing, and says what the fit and the diagnosis say."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser

import pytest

from app.cli.input_files import read_diagnosis
from app.report.document import document
from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from tests.residuals.conftest import compared

DIAGNOSIS = {
    "baseline": {"error": {"fit": 0.0227, "verify": 0.024}, "offset": 0.0},
    "noise_floor": {"fit": 0.005, "verify": 0.005},
    "budget": {"noise": 0.005, "linear": 0.003, "nonlinear": 0.02},
    "candidates": [
        {
            "effect": "coulomb_friction",
            "error": {"fit": 0.0051, "held_out": 0.0052, "verify": 0.0053},
            "predicted_error": 0.0061,
            "parameters": {},
            "group": None,
            "evidence": {},
            "why": "<script>alert(1)",
        },
    ],
    "ladder": [{"added": "coulomb_friction", "error": {"fit": 0.0051, "verify": 0.0053}, "parameters": {}}],
    "verdict": {
        "effects": ["coulomb_friction"],
        "indistinguishable": [["coulomb_friction", "backlash"]],
        "suspects": [],
        "unexplained": False,
        "text": "Dry friction is missing.",
    },
}


@pytest.fixture(scope="module")
def told() -> str:
    base = compared("coulomb_friction")
    return document(base.matrix, base.fit, Diagnosis.from_json(DIAGNOSIS))


class Elements(HTMLParser):
    """Tags, and every address that a browser would load."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.loaded: list[str] = []
        self.names: list[str] = []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.loaded += [value for name, value in attrs if name in ("src", "href", "xlink:href", "data")]
        self.names += [value for name, value in attrs if name == "id"]


def test_nothing_is_loaded_and_nothing_runs(told):
    """No script, no address but places in the page itself, and what a diagnosis says is text."""
    found = Elements()
    found.feed(told)
    assert "script" not in found.tags
    assert all(address.startswith("#") for address in found.loaded)
    assert "&lt;script&gt;alert(1)" in told
    assert "default-src &#39;none&#39;" in told


def test_every_figure_is_drawn_and_no_two_share_a_name(told):
    """Bode, time, step, map, curves and ladder as SVG, each clipped by its own paths."""
    found = Elements()
    found.feed(told)
    assert found.tags.count("svg") == 6
    assert len(found.names) == len(set(found.names))
    assert set(re.findall(r"url\(#([^)]+)\)", told)) <= set(found.names)


def test_it_says_parameters_errors_budget_and_verdict(told):
    """With units, in per cent, in words."""
    for said in ("10⁻⁶ m⁴/s", "Repeat one run", "Dry friction is missing.", "Coulomb friction and backlash", "0.520 %"):
        assert said in told


@pytest.mark.full
def test_without_a_diagnosis_it_is_a_report_of_the_fit():
    """No empty chapter."""
    base = compared("coulomb_friction")
    said = document(base.matrix, base.fit)
    assert "Residual analysis" in said
    assert "Missing effects" not in said


@pytest.mark.parametrize("text", ["no json", "{}", json.dumps({**DIAGNOSIS, "candidates": 3})])
def test_what_is_no_diagnosis_is_refused(tmp_path, text):
    """With the command that writes one."""
    file = tmp_path / "d.json"
    file.write_text(text)
    with pytest.raises(Unusable, match="not the JSON of a diagnosis"):
        read_diagnosis(file)
