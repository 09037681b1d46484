"""What no form of the search reaches is drawn as a free curve, of a machine of the independent reference."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.discovery.search import TermSearch
from ident.diagnosis.result import Diagnosis
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.progress import silent
from ident.workflows import identify
from tests.blind.machines import matrix_of
from tests.diagnosis.discovery.test_search import NOISE, PLANT, proposed
from tests.reference import qian_reference as linear
from tests.reference.outside_reference import Outside, measure_all

SWING = 0.12


@cache
def with_a_bent_gain() -> tuple[Matrix, Diagnosis]:
    """A flow gain that swings along the pressure, as no form of the search does; runs of one size."""
    small = [trial for trial in linear.trials() if trial.use == "fit" and trial.amplitude < 6e-4]
    trials = [*small[:12:2], *(trial._replace(use="verify") for trial in small[12:15])]
    records = measure_all(Outside(swinging_gain=SWING), trials, PLANT, seconds=0.35, noise=NOISE, seed=1)
    matrix = matrix_of(records, PLANT)
    return matrix, proposed(matrix)


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_what_no_form_reaches_is_drawn_as_a_free_curve():
    """It is called one, tells what it is of, goes where the truth does, and holds on runs that nobody fitted."""
    _, found = with_a_bent_gain()
    last = found.proposals[-1]
    assert last.free_curve
    assert "h(P)" in last.equation
    assert "<mo>(</mo><mi>P</mi><mo>)</mo>" in last.formula
    assert "no formula is known" in last.meaning
    assert last.nats > last.bar
    # The runs begin at rest, and what bends the gain moves their means: these count in the fit, and eq. (17), which
    # does not see them, ends a little above its least.
    assert last.error["verify"] < 1.25 * NOISE < found.baseline.error["verify"]
    curve = last.effect["curve"]
    assert (last.effect["place"], curve["of"]) == ("spool", "P")
    gain = (1 + last.strength * np.array(curve["values"])) * last.parameters["Z0"].value / PLANT.Z0
    true = 1 + SWING * np.sin(2 * np.array(curve["knots"]) / 1e6)
    assert gain[1:-1] == pytest.approx(true[1:-1], abs=0.1 * SWING)


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_free_curve_is_an_effect_that_anyone_may_add():
    matrix, found = with_a_bent_gain()
    last = found.proposals[-1]
    customs = tuple(one.effect for one in found.proposals)
    fit = identify(matrix, Settings(model="qian2014", effects=tuple(c["name"] for c in customs), custom=customs))
    assert fit.error["verify"] == pytest.approx(last.error["verify"], rel=1e-2)


@pytest.mark.parametrize(("count", "asked", "drawn"), [(3, False, False), (3, True, True), (12, False, True)])
def test_of_few_runs_a_curve_is_drawn_only_where_it_is_asked_for(count, asked, drawn, monkeypatch):
    """Nothing could confirm it there, and it takes longer than all terms."""
    matrix = replace(with_noise(), runs=with_noise().runs[:count])
    models = CandidateModels.of(matrix, Settings(model="qian2014"))
    sought: list[bool] = []
    monkeypatch.setattr(TermSearch, "_added", lambda _self, curves=False: bool(sought.append(curves)))
    monkeypatch.setattr(CandidateModels, "at_floor", lambda *_: False)
    TermSearch(models, models.refit((), {}), silent, (), asked).run()
    assert (True in sought) is drawn
    assert False in sought


@cache
def with_noise() -> Matrix:
    """Twelve runs of the model itself."""
    small = [trial for trial in linear.trials() if trial.use == "fit"][:12]
    return matrix_of(measure_all(Outside(), small, PLANT, seconds=0.5, noise=NOISE, seed=2), PLANT)
