"""Each number about what the data determine decides a case that lies within a third of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ident.fit import low_frequency_delay, summary
from ident.fit.settings import Settings
from ident.fit.uncertainty import Covariance, covariance

NOTHING = np.empty((0, 2))
BLIND = Covariance(np.full(2, 0.5), np.zeros((2, 2)), np.array([[1.0], [0.0]]), NOTHING)
"""Of two axes of which the data do not see the first."""


def determined(monkeypatch: pytest.MonkeyPatch, parameter: float, combination: float) -> list[str]:
    """What is said to be determined, of a parameter and a combination with these relative standard errors."""
    monkeypatch.setattr(summary, "slow_lag", lambda *_: ())
    monkeypatch.setattr(summary, "_labels", lambda _: {"a": ("a", "kg")})
    equation = SimpleNamespace(names={"a"}, value=lambda known: known["a"])
    objective: Any = SimpleNamespace(
        space=SimpleNamespace(conventions=(), convention=None, values=lambda points: {"a": points[:, 0]}),
        preset=SimpleNamespace(
            combinations=(SimpleNamespace(equation=equation, text="2*a", unit="kg"),),
            display=SimpleNamespace(recorded=SimpleNamespace(shown=str)),
            combined_unit=lambda combined: combined.unit,
        ),
    )
    found: Any = SimpleNamespace(point=np.ones(1), relative=lambda _: combination)
    return [one.expression for one in summary._determined(objective, found, {"a": parameter}, {"a": 1.0}, ())]


@pytest.mark.parametrize(("error", "expected"), [(0.45, ["a"]), (0.55, [])])
def test_a_parameter_is_determined_up_to_half_of_its_value(monkeypatch, error, expected):
    assert determined(monkeypatch, error, 1.0) == expected


@pytest.mark.parametrize(("error", "expected"), [(0.085, ["2*a"]), (0.115, [])])
def test_a_combination_is_reported_up_to_a_tenth_of_its_value(monkeypatch, error, expected):
    assert determined(monkeypatch, 1.0, error) == expected


@pytest.mark.parametrize(("share", "directions"), [(0.85e-9, 1), (1.15e-9, 0)])
def test_a_direction_of_a_billionth_is_not_determined(share, directions):
    H = np.array([[1.0, 1.0 - 2.0 * share], [1.0 - 2.0 * share, 1.0]])
    here: Any = SimpleNamespace(error=1.0, curvature=H, scores=np.eye(2))
    assert covariance(here, np.full(2, 0.5)).blind.shape[1] == directions


def test_what_moves_along_a_blind_direction_has_a_deviation_of_ten_thousand():
    assert BLIND.deviation(lambda points: points[:, 0]) == pytest.approx(1e4, rel=0.01)


@pytest.mark.parametrize(("slope", "is_blind"), [(2.55e-5, False), (3.45e-5, True)])
def test_what_hardly_moves_along_a_blind_direction_is_not_blind(slope, is_blind):
    assert bool(BLIND.deviation(lambda points: points[:, 1] + slope * points[:, 0]) > 0.1) is is_blind


def test_the_slope_of_a_quantity_is_taken_over_a_millionth_to_either_side():
    """Of a cube it is off by the square of that."""
    asked: list[np.ndarray] = []

    def known(points: np.ndarray) -> np.ndarray:
        asked.append(points - BLIND.point)
        return points[:, 0]

    BLIND.deviation(known)
    assert np.abs(asked[-1]).max() == pytest.approx(1e-6, rel=0.15, abs=0.0)


@pytest.mark.parametrize(("error", "said"), [(8.5, "standard error 850 %"), (11.5, "no influence")])
def test_from_ten_times_its_value_on_a_parameter_has_no_influence(error, said):
    objective: Any = SimpleNamespace(space=SimpleNamespace(convention=None, conventions=()))
    assert summary._reason(objective, "a", {"a": error}, np.ones(1)).startswith(said)


@pytest.mark.parametrize(("rise", "felt"), [(0.85e-3, False), (1.15e-3, True)])
def test_an_effect_is_felt_whose_absence_raises_the_error_by_a_thousandth(rise, felt):
    space = SimpleNamespace(point=lambda _: np.zeros(1), values=lambda _: {"a": np.ones(1)})
    objective: Any = SimpleNamespace(space=space, errors=lambda _: np.array([1.0, 1.0 + rise]))
    assert summary._felt(objective, "a", np.ones(1)) is felt


@pytest.mark.parametrize(("error", "doubted"), [(0.72, False), (0.88, True)])
def test_a_fit_that_leaves_four_fifths_of_the_output_explains_hardly_anything(monkeypatch, error, doubted):
    monkeypatch.setattr(summary, "far_bounds", lambda *_: ())
    monkeypatch.setattr(summary, "excited_band", lambda _: 1.0)
    monkeypatch.setattr(summary, "integrates", lambda *_: False)
    monkeypatch.setattr(summary, "unit_causes", lambda _: ())
    monkeypatch.setattr(summary, "is_assumed_loop", lambda *_: False)
    matrix = SimpleNamespace(runs=(), actuator=None)
    objective: Any = SimpleNamespace(preset=SimpleNamespace(name="m", chain=None), runs=(), matrix=matrix)
    assert bool(list(summary._hardly_explained(Settings(), objective, error))) is doubted


def test_the_interval_of_a_free_run_holds_95_of_100_draws(monkeypatch):
    """The errors of the draws are their numbers."""

    class Fitness(SimpleNamespace):
        """A fit over windows."""

    run = SimpleNamespace(id="r", share=1.0)
    moments = SimpleNamespace(error=0.1, share=1.0, errors_beside=lambda scatter: scatter)
    fitness: Any = Fitness(
        horizon=1.0,
        memory=None,
        matrix=SimpleNamespace(of_use=lambda use: (run,) if use == "fit" else ()),
        preset=SimpleNamespace(display=SimpleNamespace(recorded=SimpleNamespace(clock="s"))),
        exact=lambda *_, **__: SimpleNamespace(runs=(moments,)),
    )
    fitness.fresh, fitness.whole = lambda _: fitness, lambda: fitness
    monkeypatch.setattr(summary, "SimulatedFitness", Fitness)
    window = summary._window(fitness, np.ones(1), SimpleNamespace(drawn=lambda count: np.arange(float(count))), ())
    assert window is not None
    assert window.free_run["fit"] == pytest.approx((0.025 * 99, 0.975 * 99))


def lag_is_read_at(monkeypatch: pytest.MonkeyPatch, *poles: float) -> float:
    """The angular frequency at which the lag of a machine with these poles is read."""
    asked: list[float] = []

    def response(frequency: np.ndarray) -> np.ndarray:
        asked.append(2 * np.pi * float(frequency[1]))
        return np.ones((1, 2))

    model = SimpleNamespace(A=np.diag(-np.array(poles))[None], frequency_response=response)
    core = SimpleNamespace(symbols=(), linearise=lambda *_: model)
    objective: Any = SimpleNamespace(
        preset=SimpleNamespace(core=core, chain=None),
        space=SimpleNamespace(values=lambda _: {}),
        matrix=SimpleNamespace(actuator=None),
    )
    monkeypatch.setattr(low_frequency_delay, "conditions", lambda *_: {})
    monkeypatch.setattr(low_frequency_delay, "_times", lambda *_: ())
    low_frequency_delay.lags(objective, SimpleNamespace(output="displacement"), np.ones((1, 1)))
    return asked[0]


def test_the_lag_to_a_slow_command_is_read_a_thousand_times_below_the_poles(monkeypatch):
    assert lag_is_read_at(monkeypatch, 10.0, 100.0) == pytest.approx(1e-3 * 10.0)


@pytest.mark.parametrize(("pole", "integrates"), [(0.85e-6, True), (1.15e-6, False)])
def test_a_pole_a_million_times_slower_than_the_fastest_integrates(monkeypatch, pole, integrates):
    slowest = 1.0 if integrates else pole
    assert lag_is_read_at(monkeypatch, 1.0, pole) == pytest.approx(1e-3 * slowest)
