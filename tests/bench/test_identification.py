"""The whole model at once: the same steps as any fit, and the same optimum as the procedures."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from ident.bench.identification import BenchIdentification
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.workflows import identification, identify
from tests.bench.sets import as_matrix, true_model
from tests.reference import kononykhin_reference as reference
from tests.short_form import short_form

SHORT = Settings(model="kononykhin", options={"population": 16.0, "generations": 3.0, "elite": 3.0}, seed=4)
TRUTH = reference.scattered(9)


@pytest.fixture(scope="module")
def matrix(full):
    """The set of an actuator; in the short form without what takes longest."""
    return as_matrix(TRUTH, reference.full_set(TRUTH, 9, short=not full))


def test_a_search_that_was_cut_ends_the_same(matrix, full):
    """Every generation in a process of its own, its state through JSON: the same values, bit for bit."""
    if not full:  # tests/fit cuts one of a chain
        pytest.skip("ten seconds: run with --full")
    whole = identify(matrix, SHORT)
    state = identification(matrix, SHORT).start()
    while not identification(matrix, SHORT).finished(state):
        state = json.loads(json.dumps(identification(matrix, SHORT).advance(state, 1)))
    assert isinstance(identification(matrix, SHORT), BenchIdentification)
    assert identification(matrix, SHORT).finish(state).values == whole.values


@pytest.mark.full
def test_search_and_procedures_agree(matrix):
    """From anywhere in the bounds to where the procedures end: T, B and every speed within 1 %."""
    by_search, by_steps = identify(matrix, SHORT), identify(matrix, replace(SHORT, method="gradient", options={}))
    for name in ("T", "B", *true_model(TRUTH).table.names):
        assert by_search.values[name] == pytest.approx(by_steps.values[name], rel=0.01), name
    assert by_search.error["fit"] <= 1.05 * by_steps.error["fit"]
    assert not any("No member of the search" in note for note in by_search.notes)


def test_runs_to_verify_are_seen_by_no_fit(matrix):
    """The sines of 2 Hz are kept: their error is reported, and the values stay what they are."""
    runs = tuple(replace(run, use="verify") if run.frequency == 2.0 else run for run in matrix.runs)
    found = identify(replace(matrix, runs=runs), SHORT)
    assert found.error["fit"] < 0.02
    assert found.error["verify"] == pytest.approx(found.error["fit"], rel=1.0)
    assert found.values["T"] == pytest.approx(TRUTH.T, rel=0.03)
    assert np.isfinite(found.noise_floor["verify"])


METHODS = ("differential-evolution", "cma-es", "paper-ga")


@pytest.mark.parametrize("method", short_form(METHODS, "cma-es"))
def test_every_method_of_the_contract_starts(matrix, method):
    """They share the target; only the beginning of each is run here."""
    work = identification(matrix, replace(SHORT, method=method, options={}))
    point = np.full((2, len(work.space.axes)), 0.5)
    errors = work.errors(point)
    assert errors[0] == errors[1] > 0
    assert work.generations > 0
    assert not work.finished(work.start())


def test_effects_and_measured_loads_are_refused(matrix):
    with pytest.raises(Unusable):
        identify(matrix, replace(SHORT, load="force"))
    with pytest.raises(Unusable):
        identify(matrix, replace(SHORT, effects=("dead_zone",)))


def test_a_set_without_sines_cannot_be_fitted_and_says_why(matrix):
    bare = replace(matrix, runs=tuple(run for run in matrix.runs if run.kind != "frequency"))
    with pytest.raises(Unusable, match="time constant T cannot be found"):
        identify(bare, SHORT)
