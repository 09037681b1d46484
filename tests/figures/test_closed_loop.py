"""The figure of a designed controller's closed loop."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import lru_cache
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from ident.figures import MEDIA, look, render
from ident.figures.closed_loop import closed_loop
from ident.fit.result import FitResult
from ident.hybrid.controller_design import design_controller
from ident.run import Specimen
from tests.short_form import short_form

FIT = Path(__file__).resolve().parents[1] / "stored" / "fit.json"


@lru_cache
def made(structure="feedback"):
    """A controller of a stored fit."""
    fit = FitResult.from_json(json.loads(FIT.read_text()))
    case = {"sample_rate": 4096.0, "gain": 2.0, "piston_area": 4.97e-4, "draws": 20}
    return design_controller(fit, Specimen(8.75, 17.5e3), structure=structure, **case)


@pytest.mark.parametrize(("theme", "format_"), short_form(product(["light", "dark"], MEDIA), ("dark", "svg")))
def test_it_is_drawn_in_every_format_and_theme(theme, format_):
    """As JSON, SVG, PNG and PDF."""
    starts = {"svg": b"<svg", "png": b"\x89PNG", "pdf": b"%PDF", "json": b"{"}
    assert render(closed_loop(made(), look(theme)), format_).startswith(starts[format_])


def test_it_shows_the_response_and_the_band_in_decibel():
    """The curve with the controller is the loop's; each edge of the band is the draws' at that frequency."""
    design = made()
    spec = json.loads(render(closed_loop(design, look("light"), "case qian"), "json"))
    curve = [row for row in spec["datasets"]["curves"] if row["s"] == "with the controller"]
    f = np.array([row["f"] for row in curve])
    wanted = 20 * np.log10(np.abs(design.design.loop.response(f)))
    assert [row["a"] for row in curve] == pytest.approx(wanted, abs=2e-3)
    assert [row["A"] for row in spec["datasets"]["band"]] == pytest.approx(design.robustness.magnitude[1], abs=1e-3)
    assert "case qian" in spec["title"]["text"]


def test_it_is_drawn_where_nothing_is_known_of_the_covariance():
    """Without a band, and without a word of draws."""
    spec = json.loads(render(closed_loop(replace(made(), robustness=None), look("light")), "json"))
    assert not spec["datasets"]["band"]
    assert not any("draws" in line for line in spec["title"]["subtitle"])


def test_the_target_is_only_drawn_for_feedback():
    """A path forward aims at 1, not at the target closed by itself; where that is unstable, the legend says so."""
    names = {
        structure: {
            row["s"]
            for row in json.loads(render(closed_loop(made(structure), look("light")), "json"))["datasets"]["curves"]
        }
        for structure in ("feedback", "two-degree")
    }
    assert "target Gd/(1 + Gd), unstable without controller" in names["feedback"]
    assert not any("target" in name for name in names["two-degree"])
