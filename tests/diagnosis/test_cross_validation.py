"""What models leave of data that was left out of their fits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.diagnosis.cross_validation import OutOfFold, bounded_step, fold_of_segments, is_sweep, out_of_fold
from ident.fit.fitness import Local, local
from ident.fit.normal_matrices import NormalMatrices, normal_matrices_of
from ident.noise.effective_sample_size import independent_samples
from ident.run import Run

N, BLOCKS = 512, 32


@pytest.fixture
def rng() -> np.random.Generator:
    """Each test draws for itself, so that its data do not hang on which tests ran before it."""
    return np.random.default_rng(8)


def records(rng: np.random.Generator, count: int) -> list[tuple[Run, np.ndarray]]:
    """Runs whose output is a line in two parameters, with noise, and the sensitivities."""
    found = []
    for i in range(count):
        J = rng.standard_normal((N, 2))
        y = J @ [0.3, -0.2] + 0.1 * rng.standard_normal(N) + 0.1
        found.append((Run(f"r{i}", "", 1.0, {"command": y, "displacement": y}), J))
    return found


def objective(data, point: np.ndarray) -> Local:
    """The objective of the line at a point of the unit cube, values = point − 0.5."""
    runs: list[NormalMatrices] = []
    for run, J in data:
        residual = run.measured - run.measured.mean() - J @ (point - 0.5)
        z = np.column_stack([J, np.ones(N), residual]).reshape(BLOCKS, N // BLOCKS, -1)
        runs += normal_matrices_of([run], np.einsum("bni,bnj->bij", z, z)[None], len(point))
    return local(runs)


def left_of(data):
    """What the line at each point leaves of some runs, means and all."""

    def simulate(points, numbers) -> list[list[np.ndarray]]:
        return [[data[i][0].measured - data[i][1] @ (point - 0.5) for i in numbers] for point in points]

    return simulate


def less_mean(_number: int, residual: np.ndarray) -> np.ndarray:
    """What the objective sees of a residual."""
    return residual - residual.mean()


def fitted(data, columns: int = 2) -> tuple[np.ndarray, Local]:
    """The optimum of everything, and the objective there."""
    point = np.full(columns, 0.5)
    for _ in range(6):
        here = objective(data, point)
        point = point - np.linalg.solve(here.curvature, here.gradient)
    return point, objective(data, point)


@pytest.mark.parametrize("count", [1, 3, 9])
def test_residuals_out_of_fold_are_those_of_fits_without_each_fold(rng, count):
    """One step from the optimum of everything is exact: the same as solving without the fold."""
    data = records(rng, count)
    point, here = fitted(data)
    found = out_of_fold(point, here, left_of(data), less_mean, [N] * count)
    weights = np.array([1 / np.sqrt(run.gram[-1, -1] * run.total) for run in here.runs])
    folds = [np.repeat(fold_of_segments(i, BLOCKS, count), N // BLOCKS) for i in range(count)]
    for fold in range(max(of.max() for of in folds) + 1):
        A, b = np.zeros((2, 2)), np.zeros(2)
        for (run, J), weight, of in zip(data, weights, folds, strict=True):
            D, r = (J - J.mean(axis=0))[of != fold], (run.measured - run.measured.mean())[of != fold]
            A += weight * D.T @ D
            b += weight * D.T @ r
        best = np.linalg.solve(A, b)
        for (run, J), residual, of in zip(data, found, folds, strict=True):
            left = run.measured - J @ best
            expected = (left - left.mean())[of == fold]
            assert (residual - residual.mean())[of == fold] == pytest.approx(expected, abs=1e-3 if count < 4 else 1e-9)


def test_of_four_runs_whole_ones_are_left_out_of_fewer_stretches():
    """Four folds of runs, eight stretches of a single one, four of two or three, of sweeps another one of each."""
    assert {int(of) for number in range(4) for of in fold_of_segments(number, 32, 4)} == {0, 1, 2, 3}
    assert all(len(set(fold_of_segments(number, 32, 4).tolist())) == 1 for number in range(4))
    assert fold_of_segments(0, 32, 1).tolist() == np.repeat(np.arange(8), 4).tolist()
    assert fold_of_segments(0, 32, 3).tolist() == np.repeat([0, 1, 2, 3], 8).tolist()
    assert fold_of_segments(2, 32, 3).tolist() == np.repeat([0, 1, 2, 3], 8).tolist()
    assert fold_of_segments(2, 32, 3, swept=True).tolist() == np.repeat([2, 3, 0, 1], 8).tolist()


@pytest.mark.parametrize("count", [2, 3])
def test_a_resonance_is_known_by_every_fold_of_two_sweeps(rng, count):
    """Of two parameters one hardly shows but in an eighth of each record, as a resonance does in a sweep."""
    data = []
    for run, J in records(rng, count):
        J[:, 1] *= np.where(np.arange(N) * 8 // N == 1, 20.0, 0.05)
        y = J @ [0.3, -0.2] + 0.1 * rng.standard_normal(N)
        data.append((replace(run, channels={"command": y, "displacement": y}), J))
    point, here = fitted(data)
    found = out_of_fold(point, here, left_of(data), less_mean, [N] * count, swept=True)
    assert all(np.std(residual) < 0.11 for residual in found)


def test_only_a_sweep_is_one(rng):
    """Up, down, slow and in noise; not noise, a sine, steps, a multisine, a staircase, nor a command that rests."""
    t = np.arange(4000) / 100.0
    up = np.sin(2 * np.pi * (0.3 * t + 0.04 * t**2))
    slow = np.sin(2 * np.pi * 0.2 * 40.0 / np.log(20.0) * (20.0 ** (t / 40.0) - 1))
    assert all(map(is_sweep, (up, up[::-1], 3.0 * slow + 7.0, up + 0.1 * rng.standard_normal(4000))))
    noise = np.convolve(rng.standard_normal(4000), np.ones(30) / 30, "same")
    multisine = sum(np.sin(2 * np.pi * k * t / 8 + k**2) for k in range(1, 12))
    steps, staircase = np.sign(np.sin(0.7 * t)), np.floor(t / 4)
    others = (noise, np.sin(3 * t), multisine, steps, staircase, np.zeros(4000), np.ones(8), t)
    assert not any(map(is_sweep, others))


def test_the_errors_are_those_of_the_residuals_with_offsets_beside_the_zero(rng):
    """Eq. (17) of each run; of three runs or more their offsets tell something."""
    residuals = tuple(rng.standard_normal(N) for _ in range(3))
    residuals = tuple(r - r.mean() for r in residuals)
    found = OutOfFold(residuals, np.array([1.0, 2.0, 4.0]), np.array([0.1, -0.1, 0.0]), np.ones(3))
    assert found.errors == pytest.approx([np.std(r) / s for r, s in zip(residuals, (1.0, 2.0, 4.0), strict=True)])
    assert found.levels == pytest.approx([0.1, -0.1, 0.0])
    assert not replace(found, offsets=np.array([0.1, -0.1])).levels.any()


def test_where_a_model_without_a_fold_is_unstable_that_of_all_data_stands_in(rng):
    """What it leaves elsewhere is no number: the residual is that of the fit."""
    data = records(rng, 4)
    point, here = fitted(data)
    simulate = left_of(data)

    def unstable(points, numbers) -> list[list[np.ndarray]]:
        known = zip(points, simulate(points, numbers), strict=True)
        return [left if np.array_equal(at, point) else [np.full(N, np.inf) for _ in left] for at, left in known]

    found = out_of_fold(point, here, unstable, less_mean, [N] * 4)
    assert np.array(found) == pytest.approx(np.array(simulate([point], range(4))[0]))


@pytest.mark.parametrize("reach", [1.0, 0.2])
def test_a_step_that_is_too_long_is_shortened(rng, reach):
    """Beyond so much of a step the model goes astray: the longest part of it that helps is taken."""
    data = records(rng, 4)
    best = fitted(data)[0]
    point = np.add(best, [0.05, -0.05])
    here, simulate, tried = objective(data, point), left_of(data), []

    def astray(points, numbers) -> list[list[np.ndarray]]:
        tried.extend(points)
        gone = [float((at - point) @ (best - point) / np.sum((best - point) ** 2)) for at in points]
        known = zip(gone, simulate(points, numbers), strict=True)
        return [[r if far < 1.1 * reach else 9.0 * r for r in left] for far, left in known]

    found = out_of_fold(point, here, astray, less_mean, [N] * 4)
    ends = np.array([(at - point) @ (best - point) / np.sum((best - point) ** 2) for at in tried])
    assert ends.max() == pytest.approx(1.0, abs=0.05)
    (expected,) = simulate([point + reach * (best - point)], range(4))
    assert [np.std(r) for r in found] == pytest.approx([np.std(r) for r in expected], rel=0.05)


def test_white_noise_is_all_new_and_a_slow_one_is_not(rng):
    white = rng.standard_normal(4096)
    assert independent_samples(white) > 2000
    assert independent_samples(np.convolve(white, np.ones(32) / 32, "same")) < 400
    assert independent_samples(white[:3]) == 3.0  # of so few nothing is known of a memory


def test_a_step_stays_in_the_cube_and_the_rest_makes_up_for_it():
    H, g = np.array([[2.0, 1.0], [1.0, 2.0]]), np.array([4.0, 0.0])
    step = bounded_step(np.array([0.1, 0.5]), H, g)
    assert step == pytest.approx([-0.1, 0.05])
