"""One catalogue of all figures: what each is of, and the options that forms and documents read from it."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

import ident.figures
from ident.figures import DRAWINGS, drawings, figure
from ident.figures.drawing import Drawing
from ident.figures.subjects import Ladder
from ident.matrix import Actuator
from tests.conftest import ROOT

FOLDER = Path(ident.figures.__file__).parent
STEPS = Ladder([("fitted", 0.1, None), ("dead zone", 0.02, None)], 0.01, Actuator("SW-1"))


def test_every_file_that_holds_a_figure_is_in_the_catalogue_and_no_two_of_a_subject_share_a_name():
    """So that a chart that is drawn anywhere has forms, files and documents without a line more."""
    holding = [file for file in FOLDER.glob("*.py") if "= Drawing(" in file.read_text(encoding="utf-8")]
    assert len(holding) == len(DRAWINGS)
    assert max(Counter((drawing.of, drawing.name) for drawing in DRAWINGS).values()) == 1


@pytest.mark.parametrize("drawing", DRAWINGS, ids=lambda one: f"{one.of.__name__}-{one.name}")
def test_a_figure_and_its_options_are_documented(drawing: Drawing[object]):
    """By their names, in the page of all figures."""
    said = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    assert drawing.title
    assert f"`{drawing.name}`" in said
    assert [option.name for option in drawing.options if f"`{option.name}`" not in said] == []


def test_a_subject_has_the_figures_of_its_kind():
    assert list(drawings(STEPS)) == ["ladder"]
    assert figure("ladder", STEPS, "dark").to_dict()["height"] == 80
    assert drawings(object()) == {}
