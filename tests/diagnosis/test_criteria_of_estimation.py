"""Each number of the estimation decides a case that lies within a third of it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.stats

from ident.diagnosis.auxiliary_channels import _varies
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.undetermined import _with_fewer_steps
from ident.diagnosis.verdict import Residual, is_noise
from ident.fit.levenberg_marquardt import levenberg_marquardt
from ident.residuals.correlation import memory
from ident.run import Run
from ident.simulation.steps import MOST

BOUNDS = (0.0, 100.0)


def slope(gain: float, falls: bool = True) -> Any:
    """An objective on a line, 1 at the start: each step of length one promises a gain, and keeps it where it falls."""

    def evaluate(point: np.ndarray) -> Any:
        error = 1.0 - gain * float(point[0]) if falls or not point[0] else 2.0
        return SimpleNamespace(error=error, gradient=np.array([-2.0 * gain]), curvature=np.array([[2.0 * gain]]))

    return evaluate


@pytest.mark.parametrize(("effort", "steps"), [("full", 20), ("coarse", 20), ("trial", 10), ("screen", 3)])
def test_a_refit_that_still_gains_ends_after_its_steps(effort, steps):
    way = replace(getattr(CRITERIA.estimation, effort), within=BOUNDS)
    point, _ = levenberg_marquardt(slope(0.01), np.zeros(1), way)
    assert point[0] == pytest.approx(steps, rel=0.01)


@pytest.mark.parametrize(("effort", "least"), [("full", 1e-7), ("coarse", 1e-4), ("trial", 1e-4), ("screen", 1e-5)])
@pytest.mark.parametrize(("share", "moves"), [(0.85, False), (1.15, True)])
def test_a_refit_ends_where_a_step_promises_next_to_nothing(effort, least, share, moves):
    way = replace(getattr(CRITERIA.estimation, effort), within=BOUNDS, most=1)
    point, _ = levenberg_marquardt(slope(share * least), np.zeros(1), way)
    assert bool(point[0] > 0) is moves


@pytest.mark.parametrize(("effort", "rough"), [("full", 1e-5), ("coarse", 1e-4), ("trial", 1e-4)])
@pytest.mark.parametrize(("share", "once"), [(0.85, True), (1.15, False)])
def test_a_step_that_failed_is_the_last_where_it_promised_less_than_the_error_is_smooth(effort, rough, share, once):
    tried: list[float] = []
    objective = slope(share * rough, falls=False)

    def evaluate(point: np.ndarray) -> Any:
        tried.append(float(point[0]))
        return objective(point)

    way = replace(getattr(CRITERIA.estimation, effort), within=BOUNDS, converged=0.0)
    levenberg_marquardt(evaluate, np.zeros(1), way)
    assert (len(tried) == 2) is once


@pytest.mark.parametrize(
    ("asked", "cut", "kept"),
    [("trial", 150_000, 115_000), ("global_starts", 56_000, 43_000)],
)
def test_a_refit_takes_so_much_of_the_records(asked, cut, kept):
    """Of a trial 131 072 samples, of rough first steps 49 152."""

    def fitness(_effects: Any, samples: int) -> Any:
        raise StopIteration(samples)

    models: Any = SimpleNamespace(fitness=fitness)
    with pytest.raises(StopIteration) as stopped:
        getattr(CandidateModels, asked)(models, (), *([[{}]] if asked == "trial" else []))
    assert kept < stopped.value.value < cut


def test_a_model_of_unknown_place_is_begun_from_the_four_best_of_128_points():
    """The best of these is the hundredth of the sequence; a better one comes later, and would cost as much again."""
    points = scipy.stats.qmc.Sobol(2, rng=0).random(256)
    order = [100, 60, 20, 5, 110, *range(128)]
    error = {150: 0.0} | {n: 1.0 + place for place, n in reversed(list(enumerate(order)))}

    def errors(tried: np.ndarray) -> np.ndarray:
        return np.array([error.get(int(np.flatnonzero(np.all(points == of, axis=1))[0]), 1e3) for of in tried])

    space = SimpleNamespace(axes=(0, 1), values=lambda at: {"x": at[:, 0]})
    models: Any = SimpleNamespace(
        fitness=lambda *_: SimpleNamespace(space=space, errors=errors),
        resting=SimpleNamespace(held=lambda _space, of: of),
        refit=lambda _effects, start, *_: start["x"],
    )
    assert CandidateModels.global_starts(models, ()) == [points[n, 0] for n in order[:4]]


@pytest.mark.parametrize(("error", "is_another"), [(0.9885, True), (0.9915, False)])
def test_a_refit_one_per_cent_better_is_at_another_optimum(error, is_another):
    found = SimpleNamespace(effects=(), values={}, local=SimpleNamespace(error=error))
    models: Any = SimpleNamespace(
        trial_error=lambda _refit: 1.0,
        multistart=lambda *_: found,
        refit=lambda *_: found,
    )
    given: Any = SimpleNamespace(effects=(), local=SimpleNamespace(error=1.0))
    assert (CandidateModels.better_optimum(models, given, []) is found) is is_another


def test_a_refit_is_continued_five_times_at_most():
    """Each time it falls by two per cent."""

    def refit(_effects: Any, count: int, *_: Any) -> Any:
        return SimpleNamespace(effects=(), values=count + 1, finite=True, local=SimpleNamespace(error=0.98**count))

    models: Any = SimpleNamespace(refit=refit)
    assert CandidateModels.converged(models, refit((), 0)).values == 6


@pytest.mark.parametrize(("deviation", "varies"), [(0.8e-12, False), (1.2e-12, True)])
def test_a_channel_varies_where_it_does_by_more_than_rounding(deviation, varies):
    load = 1.0 + deviation * np.tile([-1.0, 1.0], 500)
    assert _varies("load_pressure", (Run("r", "", 100.0, {"load_pressure": load}),)) is varies


@pytest.mark.parametrize(
    ("residual", "noise"),
    [
        (Residual(0.0103, 0.01, spread=0.004), True),  # 2 % and 2.5 deviations
        (Residual(0.0105, 0.01, spread=0.008), False),  # 2 % and 3.75 deviations
        (Residual(0.0121, 0.01, excess=CRITERIA.noise.bench_excess), True),
        (Residual(0.0129, 0.01, excess=CRITERIA.noise.bench_excess), False),
        (Residual(0.010143, 0.01), True),
        (Residual(0.010257, 0.01), False),
        (Residual(0.01, None, correlation=0.4), True),
        (Residual(0.01, None, correlation=0.6), False),
    ],
)
def test_an_error_is_noise_within_each_margin(residual, noise):
    assert is_noise(residual) is noise


@pytest.mark.parametrize("samples", [3.0, 5.4, 11.0, 19.0])
def test_what_swings_is_no_noise_where_no_floor_is_known(samples):
    """Neighbours of a swing of four to six samples are hardly alike, and half a period later it has turned round."""
    rng = np.random.default_rng(9)
    noise, swing = rng.standard_normal(2000), np.sin(2 * np.pi * np.arange(2000) / samples)
    most, limit = CRITERIA.noise.memory, CRITERIA.noise.noise_correlation
    assert memory(noise, most) < 0.2 * limit
    assert memory(swing + 0.5 * noise, most) > limit
    assert memory(np.zeros(50), most) == 0.0


@pytest.mark.parametrize(("strength", "off"), [(0.0085, True), (0.0115, False)])
def test_an_effect_is_as_good_as_off_at_a_hundredth_of_its_range(strength, off):
    models: Any = SimpleNamespace(effects={"a": SimpleNamespace(has_searched_shapes=False)}, strength=lambda _: "s")
    refit: Any = SimpleNamespace(space=SimpleNamespace(reach=lambda *_: (-0.5, 1.0)), values={"s": strength})
    assert CandidateModels.may_be_dispensable(models, refit, "a") is off


def test_a_pair_begins_with_all_of_the_second_effect_and_with_a_small_part():
    """Of which the first may have taken over all but a hundredth: a start lies within a factor of 3.4 of the rest."""
    begun: list[float] = []
    models: Any = SimpleNamespace(
        strength=lambda effect: effect,
        trial=lambda _effects, starts, _aim: begun.extend(start["b"] for start in starts if start["a"] == 1.0),
    )
    first, second = (SimpleNamespace(effects=(name,), values={name: 1.0}) for name in "ab")
    CandidateModels.pair_trial(models, first, second, 1.0)  # type: ignore[arg-type]
    assert 1.0 in begun
    for rest in np.geomspace(0.0092, 1.0, 50):
        assert np.exp(np.abs(np.log(np.array(begun) / rest)).min()) < 3.4


def test_a_parameter_at_rest_is_looked_for_at_each_64th_of_its_range():
    places: list[np.ndarray] = []

    def values(points: np.ndarray) -> np.ndarray:
        places.append(points[:-1, 0])
        return points

    fitness = SimpleNamespace(space=SimpleNamespace(values=values), steps=lambda points: np.ones(len(points)))
    models: Any = SimpleNamespace(fitness=lambda _effects: fitness)
    refit: Any = SimpleNamespace(effects=(), point=np.array([0.5]))
    assert _with_fewer_steps(models, refit, 0) is None
    assert np.diff(places[0]) == pytest.approx(1.0 / 64.0)


def sized(samples: int, steps: int) -> tuple[Any, Any]:
    """Models of one run of so many samples, and a fitted one that asks for so many steps a sample."""
    models: Any = SimpleNamespace(runs=(SimpleNamespace(length=samples),))
    models._steps = lambda fitted, most=MOST: CandidateModels._steps(models, fitted, most)
    space = SimpleNamespace(values=lambda points: points)
    fitness = SimpleNamespace(space=space, steps=lambda _values: np.array([steps]))
    return models, SimpleNamespace(fitness=fitness, point=np.zeros(1))


@pytest.mark.parametrize(
    ("samples", "steps", "short"),
    [(42_000, 1, True), (58_000, 1, False), (5_500, 32, True), (7_000, 32, False)],
)
def test_records_are_short_below_fifty_thousand_steps_of_eight_a_sample_at_most(samples, steps, short):
    assert CandidateModels.is_short(*sized(samples, steps)) is short


@pytest.mark.parametrize(("samples", "quick"), [(170_000, True), (230_000, False)])
def test_a_matrix_is_quick_below_two_hundred_thousand_steps(samples, quick):
    assert CandidateModels.is_quick(*sized(samples, 1)) is quick
