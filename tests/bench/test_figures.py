"""The bench's figures: what they show, in every format and theme."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from ident.bench import identification
from ident.bench.acceptance import sheet
from ident.errors import Unusable
from ident.figures import FIGURES, figures_of, render, renders
from ident.figures import figure as drawn
from ident.figures.acceptance_sheet import acceptance_sheet
from ident.fit.settings import Settings
from ident.workflows import figure, identify, study
from tests.bench.sets import as_matrix
from tests.reference import kononykhin_reference as reference
from tests.short_form import short_form

OF_BENCH = tuple(name for name, drawing in FIGURES.items() if drawing.kind == "bench")
DRAWN, SHEET = ["time", "evolution", *OF_BENCH], "acceptance-sheet"  # which the test of its quantities draws


@pytest.fixture(scope="module")
def fitted():
    """A matrix of the reference without what takes longest, and a fit of two generations; one vector is refined."""
    truth = reference.scattered(4)
    matrix = as_matrix(truth, reference.full_set(truth, 4, short=True))
    options = {"population": 10.0, "generations": 2.0, "elite": 3.0}
    with pytest.MonkeyPatch.context() as own:
        own.setattr(identification, "_OF", replace(identification._OF, starts=1))
        return matrix, identify(matrix, Settings(model="kononykhin", options=options))


@pytest.fixture(scope="module")
def studied(fitted):
    """What its figures take from the data, worked out once."""
    return study(*fitted)


def texts(chart) -> str:
    return render(chart, "json").decode()


def test_a_fit_of_the_bench_has_its_own_figures(fitted):
    _, fit = fitted
    assert figures_of(fit) == ("time", "evolution", *OF_BENCH)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("name", short_form(DRAWN, *(name for name in DRAWN if name != SHEET)))
def test_every_figure_is_drawn(studied, name, theme, full):
    """As SVG, with the actuator's serial in its title."""
    if theme != "light" and name != "time" and not full:
        pytest.skip("one in the other theme: run with --full")
    chart = drawn(name, studied, theme)
    found = renders(chart, ("svg", "json"))
    assert found["svg"].startswith(b"<svg")
    assert b"REFERENCE" in found["json"]


def test_the_pressure_loop_has_three_colours(fitted):
    """Rest, movement forward, movement back, each with points of its own."""
    found = texts(figure(fitted[1], "pressure-loop"))
    for group in ("static", "moving +", "moving −"):
        assert found.count(json.dumps(group, ensure_ascii=False)) > 20


@pytest.mark.parametrize("smoothing", ["iir", "fir", "bezier"])
def test_the_speed_is_smoothed_as_asked(fitted, smoothing):
    assert "fixed levels" in texts(figure(fitted[1], "speed-characteristic", smoothing=smoothing))


def test_an_unknown_smoothing_and_a_figure_of_another_model_are_refused(fitted):
    with pytest.raises(Unusable, match="iir, fir, bezier"):
        figure(fitted[1], "speed-characteristic", smoothing="none")
    with pytest.raises(Unusable, match="pressure-loop"):
        figure(fitted[1], "bode")


def test_the_sheet_names_every_quantity_and_the_verdict(fitted, studied):
    """A broken limit is seen on the page."""
    matrix, _ = fitted
    bench, analysis = studied.procedures
    lines = sheet(analysis, {"hysteresis": (None, 1e-6), "T": (None, 1.0)})
    drawn = renders(acceptance_sheet(matrix, bench, analysis, lines), ("json", "pdf"))
    page = drawn["json"].decode()
    assert "NOT passed" in page
    assert "FAIL" in page
    assert "dead space" in page
    assert drawn["pdf"].startswith(b"%PDF")
