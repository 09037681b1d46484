"""Each number of the checks of labels decides a case that lies within a third of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.diagnosis import label_checks
from ident.diagnosis.label_checks import _label, _label_suspect, _shift, label_suspects
from ident.run import Run, Specimen

Suspects = Callable[[Sequence[float]], list[str]]


@pytest.fixture
def suspects(monkeypatch: pytest.MonkeyPatch) -> Suspects:
    """The runs that are asked for another label, for the errors of all runs."""

    def of(errors: Sequence[float]) -> list[str]:
        runs = [SimpleNamespace(id=str(n), error=error) for n, error in enumerate(errors)]
        monkeypatch.setattr(label_checks, "_errors", lambda _models, _fitted, run, _changed: [run.error])
        monkeypatch.setattr(label_checks, "_label_suspect", lambda _models, _fitted, run, *_: _suspect(run.id))
        models: Any = SimpleNamespace(matrix=SimpleNamespace(of_use=lambda _use: runs))
        return [one.run for one in label_suspects(models, SimpleNamespace(), {})]  # type: ignore[arg-type]

    return of


def _suspect(run: str) -> Any:
    return SimpleNamespace(run=run, error=SimpleNamespace(usual=1.0, as_labelled=1.0))


def scattered(deviations: float, spread: float = 0.05) -> list[float]:
    """Errors whose logarithms scatter by so much, by their median deviation, and one so many deviations above."""
    usual = [np.exp(sign * spread) for sign in (-1, 1) * 5]
    return [1.0, *usual, float(np.exp(deviations * 1.4826 * spread))]


@pytest.mark.parametrize(("runs", "found"), [(4, []), (5, ["0"])])
def test_the_labels_of_four_runs_are_not_checked(suspects, runs, found):
    assert suspects([3.0, *[1.0] * (runs - 1)]) == found


@pytest.mark.parametrize(("error", "found"), [(1.125, []), (1.175, ["0"])])
def test_a_run_is_checked_where_its_error_is_a_seventh_above_the_usual(suspects, error, found):
    """Though all others have one error."""
    assert suspects([error, *[1.0] * 9]) == found


@pytest.mark.parametrize(("deviations", "found"), [(4.4, []), (5.6, ["11"])])
def test_a_run_is_checked_where_its_error_is_five_deviations_above_the_usual(suspects, deviations, found):
    assert suspects(scattered(deviations)) == found


@pytest.mark.parametrize(("outside", "found"), [(4, 4), (5, 0)])
def test_where_more_than_a_fifth_of_the_runs_stand_out_no_label_is_doubted(suspects, outside, found):
    assert len(suspects([2.0] * outside + [1.0] * (20 - outside))) == found


@pytest.mark.parametrize(("removed", "doubted"), [(0.42, False), (0.58, True)])
def test_a_label_is_doubted_where_another_removes_half_of_the_excess(monkeypatch, removed, doubted):
    """An error of twice the usual one: three times its power too much."""
    left = float(np.sqrt(4.0 - 3.0 * removed))
    monkeypatch.setattr(label_checks, "_label", lambda *_: ("mass", 1.0, 2.0, left))
    monkeypatch.setattr(label_checks, "_of_channel", lambda *_: [])
    run: Any = SimpleNamespace(id="a")
    found = _label_suspect(SimpleNamespace(), SimpleNamespace(), run, 1.0, 2.0)  # type: ignore[arg-type]
    assert (found is not None) is doubted


@pytest.mark.parametrize("true", [*np.geomspace(0.075, 0.9, 9), *np.geomspace(1.1, 13.5, 9)])
def test_a_value_from_a_tenth_to_ten_times_is_found(monkeypatch, true):
    """Though the error shows it within a factor of 1.42 alone: each is nearer than that to one that is tried."""
    run = Run("a", "", 1.0, {"command": np.arange(3.0)}, specimen=Specimen(mass=1.0), output="command")

    def errors(_models: Any, _fitted: Any, _run: Run, changed: Mapping[str, np.ndarray]) -> np.ndarray:
        return np.minimum(np.abs(np.log(changed["mL"] / true)) / np.log(1.42), 1.0)

    monkeypatch.setattr(label_checks, "_errors", errors)
    models: Any = SimpleNamespace(matrix=SimpleNamespace(actuator=None, runs=(run,)))
    monkeypatch.setattr(label_checks, "conditions", lambda of, _actuator: {"mL": of.specimen.mass})
    _, _, found, least = _label(models, SimpleNamespace(), run, "mass")  # type: ignore[arg-type]
    assert least < 1.0
    if 0.1 <= true <= 10.0:
        assert found == pytest.approx(true, rel=1e-3)


def test_a_record_that_is_late_by_a_third_of_its_memory_is_found_to_be_so():
    """Filtered noise: four rounds would miss it by a sample."""
    model = np.random.default_rng(0).standard_normal(3000)
    for _ in range(3):
        model = lfilter([0.1], [1.0, -0.9], model)
    places, late = np.arange(3000), 26.0
    assert _shift(np.interp(places - late, places, model), model) == pytest.approx(late, abs=0.2)
