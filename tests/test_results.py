"""Results of the library in a notebook: they show themselves, become records, are saved and loaded without pickle."""

from __future__ import annotations

import json
import subprocess
import sys

import altair as alt
import pytest

import ident
import ident.fit.result
from tests.test_imports import ROOT


@pytest.fixture(scope="module")
def matrix():
    return ident.simulate(seconds=0.25, small=True)


@pytest.fixture(scope="module")
def fit(matrix):
    return ident.identify(matrix, fixed={"tau": "3.6 ms"}, seed=1)


@pytest.fixture(scope="module")
def found(matrix, fit):
    return ident.diagnose(matrix, fit, most=0, propose=False)


def test_choices_carry_units_and_are_refused_by_name(matrix, fit):
    assert fit.parameters["tau"].fixed
    assert fit.parameters["tau"].value == pytest.approx(3.6e-3)
    with pytest.raises(ident.Unusable, match=r"no choice 'efects' about a fit; did you mean effects\?"):
        ident.identify(matrix, efects=["dead_zone"])


def test_every_result_shows_itself_and_becomes_records(matrix, fit, found):
    for result in (matrix, ident.check(matrix), fit, ident.compare(matrix, fit), found):
        shown = result._repr_html_()
        assert shown.count("<table>") == shown.count("</table>")
        json.dumps(result.records())
    assert [one["parameter"] for one in fit.records()] == list(fit.parameters)
    assert [one["id"] for one in ident.compare(matrix, fit).records()] == [run.id for run in matrix.runs]
    assert "No errors, no warnings" in type(ident.check(matrix))()._repr_html_()


def test_what_is_saved_is_loaded_as_it_was_and_draws_beside_its_data(tmp_path, matrix, fit, found):
    for name, result in (("f.json", fit), ("d.json", found)):
        ident.save(result, tmp_path / name)
        assert ident.load(tmp_path / name) == result
    read = ident.load(tmp_path / "f.json")
    with pytest.raises(ident.Unusable, match=r"does not hold the data.*give matrix="):
        ident.figure(read, "bode")
    assert ident.figure(read, "evolution", matrix).to_dict() == ident.figure(fit, "evolution").to_dict()
    (tmp_path / "no.json").write_bytes(b"\\x80\\x04K*.")  # a pickle
    with pytest.raises(ident.Unusable, match="not the JSON of a fit"):
        ident.load(tmp_path / "no.json")


def test_a_figure_is_a_chart_of_altair_that_shows_itself(matrix, fit, found):
    for result, name in ((fit, "residual-map"), (ident.compare(matrix, fit), "evolution"), (found, "ladder")):
        chart = ident.figure(result, name)
        assert isinstance(chart, alt.TopLevelMixin)
        assert chart._repr_mimebundle_()
    with pytest.raises(ident.Unusable, match="no figure 'bode' of a diagnosis"):
        ident.figure(found, "bode")


def test_the_next_run_of_a_diagnosis_needs_no_more_than_it(found):
    experiment = ident.next_run(found)
    assert len(experiment.command()) == experiment.samples


def test_a_simulated_matrix_in_memory_is_the_one_on_disk(tmp_path, matrix):
    from ident.synthesis.matrix import simulate_matrix

    simulate_matrix(tmp_path / "out", seconds=0.25, small=True)
    read = ident.read_matrix(tmp_path / "out")
    assert read.actuator == matrix.actuator
    for one, other in zip(read.runs, matrix.runs, strict=True):
        assert (one.measured == other.measured).all()
        assert (one.id, one.use, one.gain, one.specimen) == (other.id, other.use, other.gain, other.specimen)
        assert one.amplitude == pytest.approx(other.amplitude)


def test_a_search_that_runs_out_of_its_time_says_so_and_one_that_does_not_is_the_usual(matrix):
    choices = {"options": {"population": 20, "generations": 6}, "fixed": {"tau": 3.6e-3}}
    usual = ident.identify(matrix, **choices)
    short, long = (ident.identify(matrix, **choices, budget=budget) for budget in (1e-9, 1e6))
    assert (short.ended_early, len(short.evolution)) == (True, 1)
    assert "ended at generation 1 of 6" in short.notes[0]
    assert ident.fit.result.FitResult.from_json(short.to_json()).ended_early
    assert not long.ended_early
    assert long.values == usual.values
    assert "ended_early" not in long.to_json()
    for wrong in ({"budget": -1}, {"budget": 1, "method": "cma-es"}):
        with pytest.raises(ident.Unusable, match="budget"):
            ident.identify(matrix, **wrong)


USES = """
import ident
from ident import Matrix

matrix: Matrix = ident.read_matrix("x.csv", units={"command": "mm"}, sample_rate="1 Hz")
fit = ident.identify(matrix, effects=["dead_zone"])
reveal_type(fit)
reveal_type(ident.figure(fit, "bode"))
ident.read_matrix("x.csv", unit={"command": "mm"})
"""


def test_a_type_checker_knows_the_face(tmp_path, full):
    """What a function gives, and a word that it does not take."""
    if not full:
        pytest.skip("--full")
    (tmp_path / "uses.py").write_text(USES)
    options = ["--config-file=", "--follow-imports=silent", "--ignore-missing-imports"]
    said = subprocess.run(
        [sys.executable, "-m", "mypy", *options, tmp_path / "uses.py"],
        capture_output=True,
        text=True,
        cwd=ROOT,
        check=False,
    ).stdout
    assert "ident.fit.result.FitResult" in said
    assert "altair.vegalite" in said
    assert 'Unexpected keyword argument "unit"' in said
