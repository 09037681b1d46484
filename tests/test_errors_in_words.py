"""An error where it is shown: a large offset and an unstable model are said on terminal, page, figure and report."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import ident
from app.cli.tables import show, show_fit
from app.fits.rows import error_rows
from app.pages.compare_view import _errors, _runs
from app.pages.rendering import HERE
from app.report.content import _error
from ident.comparison.side_by_side import of_comparisons, of_fits
from ident.diagnosis.result import Diagnosis, Ranked, Rung, Verdict
from ident.figures import figure, figures_of, look, words
from ident.figures.ladder import ladder
from ident.figures.side_by_side import side_by_side
from ident.fit.result import FitResult
from ident.fit.run_errors import rmse_of, run_error
from ident.matrix import Matrix
from ident.residuals.survey import survey
from ident.run import USES, over_runs
from ident.unstable import UNSTABLE
from ident.workflows import study
from schemas.fit import ComparisonView
from schemas.result import FitResultView

LARGE = re.compile(r"(?<![\d.])\d{4,}(\.\d*)?\s*%|e\+\d+\s*%")
OFFSET = 830.0  # m
UNSURVEYED: Any = SimpleNamespace(budget=None, white={})
"""What is known of a residual that nobody looked at."""


@pytest.fixture(scope="module")
def matrix() -> Matrix:
    return ident.simulate(seconds=0.25, small=True)


@pytest.fixture(scope="module")
def fit(matrix) -> FitResult:
    return ident.identify(matrix, fixed={"tau": "3.6 ms"}, seed=1, options={"population": 20, "generations": 4})


@pytest.fixture(scope="module")
def shifted(matrix) -> Matrix:
    """The same runs, the transducer's zero 830 m away: eq. (17) does not see it."""
    far = (
        replace(run, channels={**run.channels, "displacement": run.channels["displacement"] + OFFSET})
        for run in matrix.runs
    )
    return replace(matrix, runs=tuple(far))


@pytest.fixture(scope="module")
def off(shifted) -> FitResult:
    return ident.identify(shifted, fixed={"tau": "3.6 ms"}, seed=1, options={"population": 20, "generations": 4})


def unstable_on(matrix: Matrix, fit: FitResult, name: str) -> FitResult:
    """The fit as it is stored where its model is unstable on one run, at which a simulation overflows."""
    errors = tuple(
        run_error(run, np.inf if run.id == name else 0.005, 0.0, float(np.std(run.measured)), "m")
        for run in matrix.runs
    )
    shares = {use: [run.share for run in matrix.of_use(use)] for use in USES}
    mean = {use: float(over_runs([one.error for one in errors if one.use == use], matrix.of_use(use))) for use in USES}
    return replace(fit, runs=errors, error={**fit.error, **mean}, error_with_mean=mean, **rmse_of(errors, shares))


def blown_up(fit: FitResult) -> FitResult:
    """The fit with a loop twenty times as fast: its model grows by a hundred powers of ten and more on every run."""
    fast = replace(fit.parameters["Z0"], value=20 * fit.parameters["Z0"].value)
    return replace(fit, parameters={**fit.parameters, "Z0": fast})


def text_of(chart) -> str:
    return json.dumps(chart.to_dict(), allow_nan=False)


def test_offset_stands_in_the_first_line_in_tables_json_page_figures_and_report(shifted, off, capsys):
    """The error is that of a sound fit once the zero of the transducer is known, which is 830 m away."""
    assert off.error["fit"] < 0.01
    assert off.error_with_mean == off.anchored_error
    assert off.rmse["fit"] < 1e-5
    assert off.transducer_offset["displacement"].value == pytest.approx(OFFSET, rel=1e-3)
    assert off.rmse_unit == "m"
    show_fit(off)
    first, *rest = capsys.readouterr().out.splitlines()
    for text in (first, str(off).splitlines()[0], ident.compare(shifted, off).headline):
        assert re.search(r"0\.\d+ % \(after an offset of 830\.0 m\)", text)
    errors = next(i for i, line in enumerate(rest) if line.startswith("error "))
    assert [line.split("  ")[0] for line in rest[errors + 1 : errors + 5]] == [
        "RMSE",
        "with the mean",
        "NRMSE fit",
        "eq. (17)",
    ]
    assert any("reads 830.0 m above the model" in line for line in rest)
    (table,) = [one for one in ident.compare(shifted, off).listings() if not isinstance(one, str)]
    assert table.header[2:6] == ("RMSE", "with the mean", "NRMSE fit", "eq. (17)")
    data = FitResultView(**off.to_json()).model_dump()
    assert data["transducer_offset"]["displacement"]["value"] == pytest.approx(OFFSET, rel=1e-3)
    assert data["runs"][0]["offset"] > 1e3
    said = off.error_of("fit").in_print()
    assert said in error_rows(off)[0].error
    assert said in str(list(_error(off, UNSURVEYED)))
    assert said in next(_errors(off, off)).first
    assert words.error(off.error_of("fit")) in words.verdict(off)
    studied = study(shifted, off)
    for name in ("bode", "residual-map", "time"):
        assert "after an offset of 830.0 m" in text_of(figure(name, studied)), name


def test_a_run_on_which_the_model_is_unstable_is_named_wherever_the_error_stands(matrix, fit, capsys):
    name = matrix.of_use("verify")[0].id
    stored = unstable_on(matrix, fit, name)
    told = f"unstable on run {name}"
    json.dumps(stored.to_json(), allow_nan=False)
    assert stored.error["verify"] > 100  # a mean that says nothing
    assert FitResult.from_json(stored.to_json()).error_of("verify").said() == told
    show_fit(stored)
    out = capsys.readouterr().out
    assert out.splitlines()[0].endswith(f"on estimation data 0.500 %, on validation data {told}")
    assert not LARGE.search(out)
    assert "times" not in out
    assert error_rows(stored)[-1].error == told
    assert (error_rows(stored)[-1].ratio, error_rows(stored)[-1].offset) == ("–", "–")
    assert f"{told} (validation)" in words.verdict(stored)
    assert told in str(list(_error(stored, UNSURVEYED)))
    assert any(one.said_second and one.said_second.in_print() == told for one in _runs(fit, stored))
    assert told in str(of_fits([fit, stored]))


def test_a_model_that_overflows_is_compared_drawn_and_written_without_a_number_that_is_none(matrix, fit, capsys):
    """Errors and figures of a model whose outputs reach 1e300 and beyond; JSON stays valid, and nothing warns."""
    model = blown_up(fit)
    compared = ident.compare(matrix, model)
    assert all(one.unstable for one in compared.runs)
    found = survey(compared)
    view = ComparisonView(
        fit="f",
        error=compared.error,
        offset=compared.offset,
        error_with_mean=compared.error_with_mean,
        rmse=compared.rmse,
        runs=compared.records(),
        **found.to_json(),
    )
    json.dumps(view.model_dump(), allow_nan=False)
    assert compared.rmse == {"fit": None, "verify": None}
    assert {one.rmse for one in view.runs} == {None}
    show((*compared.listings(), *found.listings(), *of_comparisons([compared, compared]).listings()))
    out = capsys.readouterr().out
    assert f"unstable on run {matrix.runs[0].id}" in out
    assert not LARGE.search(out)
    studied, refused = study(matrix, model), []
    for name in figures_of(model):
        try:
            text = text_of(figure(name, studied))
        except ident.Unusable as error:  # the figures that need the residual say so
            refused.append(error.what)
            continue
        assert not LARGE.search(text), name
    assert all("unstable" in what for what in refused)
    assert "unstable on" in text_of(figure("time", studied))
    assert "error unstable" not in text_of(figure("time", studied))
    assert "unstable on" in text_of(side_by_side(of_comparisons([compared, compared]), matrix.actuator, look("light")))


def test_a_diagnosis_names_the_verify_run_that_an_effect_makes_unstable():
    """In ranking, ladder and JSON; what earlier versions wrote has neither field and goes out as it came in."""
    gone = {"verify": ("k24",)}
    errors = {"fit": 0.01, "held_out": 0.011, "verify": None}
    found = Diagnosis(
        candidates=(Ranked(effect="lead", error=errors, unstable=gone, parameters={"lead.T": None}),),  # type: ignore[dict-item]
        ladder=(Rung(error=dict.fromkeys(errors, 0.1)), Rung(added="lead", error=errors, unstable=gone)),
        verdict=Verdict(effects=("lead",)),
    )
    assert found.candidates[0].error_of("verify").said() == "unstable on run k24"
    assert str(found).count("unstable on run k24") == 2
    data = found.to_json()
    assert data["ladder"][1]["unstable"] == {"verify": ["k24"]}
    assert "unstable" not in data["ladder"][0]
    assert Rung(error=errors, unstable={"fit": ("a",)}).error_of("held_out").said() == "unstable on run a"


def test_a_ladder_draws_what_has_a_number_and_names_what_has_none(matrix):
    chart = ladder([("fit", 0.1, 0.1), ("lead", 0.01, UNSTABLE)], 0.005, matrix.actuator, look("light"))
    assert not LARGE.search(text_of(chart))


def test_no_page_shows_an_error_as_a_bare_per_cent():
    """Every template writes errors by the filter that knows the mean and the unstable runs."""
    pages = sorted((HERE / "templates").glob("*.html"))
    assert len(pages) > 20
    bare = [
        (page.name, found)
        for page in pages
        for found in re.findall(r"\{\{[^}]*\b(?:error|predicted)\w*(?:\.\w+|\[\w+\])?\s*\|\s*percent", page.read_text())
    ]
    assert not bare


def test_the_measured_tanks_say_both_errors(measured_data):
    """Levels of 2 to 10 V about which eq. (17) knows nothing: with the mean the model is volts away."""
    tanks = ident.read_matrix(measured_data / "cascaded_tanks")
    found = ident.identify(tanks, model="first_order", seed=1, options={"population": 20, "generations": 6})
    for use in USES:
        said = found.error_of(use)
        assert said.with_mean == pytest.approx(found.anchored_error[use])
        assert ("with the mean" in found.headline) is any(found.error_of(each).mean_counts for each in USES)
    assert found.rmse["fit"] == pytest.approx(
        float(np.sqrt(np.mean((tanks.runs[0].measured - ident.compare(tanks, found).runs[0].modelled) ** 2))), rel=1e-6
    )
