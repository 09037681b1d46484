"""The offset of a transducer: shared by its runs, found with a standard error, hidden by no headline.

The machines are a mass on a spring and a damper that a measured force drives, in Euler steps of a fiftieth sample, and
a lag in closed form: neither is the code under test. A constant force on the mass is what the means of runs tell from
the transducer's zero only where the springs differ.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
import scipy

from ident.chain.chain import linear_model
from ident.fit.identification import Identification
from ident.fit.linear_fitness import LinearFitness
from ident.fit.normal_matrices import output
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import compare, diagnose, identify

RATE, SMALL = 200.0, {"population": 20.0, "generations": 6.0, "elite": 3.0}
GAIN, TAU = 0.8, 0.05


def lag(
    seed: int,
    offset: float,
    zeroed: bool | None = None,
    levels: tuple[float, ...] = (0.3,),
    noise: float = 0.02,
    verify: bool = True,
) -> Matrix:
    """A first-order lag of gain 0.8 under held commands about other levels, with a transducer that is off.

    The command is held: the answer to it is exact, y[k+1] = a y[k] + K (1 − a) u[k], a = exp(−1/(rate τ)).
    """
    rng, runs = np.random.default_rng([61, seed]), []
    a = np.exp(-1.0 / RATE / TAU)
    for number, level in enumerate((*levels, *([0.5] if verify else []))):
        u = np.repeat(level + rng.standard_normal(120), 10)
        u[:20] = 0.0
        y = scipy.signal.lfilter([0.0, GAIN * (1.0 - a)], [1.0, -a], u)
        y = y + offset + noise * y.std() * rng.standard_normal(len(y))
        known, units = (
            {} if zeroed is None else {"displacement": zeroed},
            dict.fromkeys(("command", "displacement"), "m"),
        )
        runs.append(
            Run(
                f"r{number}",
                "",
                RATE,
                {"command": u, "displacement": y},
                units,
                hold="zoh",
                zeroed=known,
                use="verify" if number == len(levels) else "fit",
            )
        )
    return Matrix(Actuator("LAG"), tuple(runs))


def fitted(matrix: Matrix):
    return identify(matrix, Settings(model="first_order", options=SMALL, seed=1))


def test_an_offset_is_found_shared_with_the_validation_data_and_said_in_the_first_line():
    found = fitted(lag(0, 3.0))
    offset = found.transducer_offset["displacement"]
    assert offset.value == pytest.approx(3.0, abs=4 * offset.std_error)
    assert 0 < offset.std_error < 0.05
    assert found.error_with_mean["verify"] < 1.2 * found.error["verify"]
    assert found.offset["verify"] > 1.0  # of the model alone: nothing is hidden
    assert re.search(r"\(after an offset of [23]\.\d+ m\)", found.headline)
    assert any("reads" in note and "above the model" in note for note in found.notes)
    compared = compare(lag(0, 3.0), found)
    assert compared.rmse["verify"] == pytest.approx(found.rmse["verify"], rel=1e-6)
    assert compared.offset["verify"] == pytest.approx(found.offset["verify"], rel=1e-6)
    assert "after an offset of" in compared.headline


def test_a_diagnosis_says_the_offset_with_its_errors():
    matrix = lag(5, 3.0)
    found = diagnose(matrix, fitted(matrix), most=0, propose=False)
    assert re.search(r"\(after an offset of [23]\.\d+ m\)", found.headline)
    rung = found.ladder[0]
    assert rung.transducer_offset["displacement"].large
    assert rung.error_with_mean["verify"] < 1.2 * rung.error["verify"]
    sizes = {run.use: float(np.std(run.measured)) for run in matrix.runs}
    for judged in (rung, found.baseline):
        assert judged.rmse_unit == "m"
        for use, size in sizes.items():
            assert judged.rmse[use] == pytest.approx(judged.error_with_mean[use] * size, rel=1e-9)


def test_without_an_offset_nothing_is_found_and_the_fit_is_that_of_equation_17():
    """What nobody asked for changes no number: the parameters are the same, bit for bit, at any offset of one run."""
    without, off = fitted(lag(1, 0.0, zeroed=True)), fitted(lag(1, 0.0))
    assert not off.transducer_offset
    assert off.values == without.values
    assert off.error == without.error
    assert off.rmse == without.rmse


def test_where_the_zero_was_set_by_hand_no_offset_is_shared():
    found = fitted(lag(2, 3.0, zeroed=True))
    assert not found.transducer_offset
    assert "with the mean" in found.headline


def test_where_the_mean_counts_it_is_part_of_what_is_fitted():
    """Runs about other levels tell the static gain by their means: far better than by their motion in this noise."""
    levels = (-20.0, 0.0, 20.0, 40.0)
    blind = fitted(lag(3, 3.0, None, levels, noise=0.5))
    counted = fitted(lag(3, 3.0, False, levels, noise=0.5))
    (gain,) = [name for name in counted.parameters if counted.parameters[name].unit != "s"]
    narrow, wide = counted.parameters[gain], blind.parameters[gain]
    assert narrow.std_error < 0.5 * wide.std_error
    assert narrow.value == pytest.approx(GAIN, abs=4 * narrow.std_error)


@pytest.mark.parametrize("std_error", [None, 0.3, 1e-4])
def test_the_loss_with_means_is_the_one_of_its_definition_and_its_gradient_is_that_of_the_loss(std_error, monkeypatch):
    """F at the best offset, found by a search of its own, and its slope by differences, away from the optimum.

    Without a prior of the offset from rest, with one that tells as much as the means do, and with one that tells all.
    """
    zero = 0.8
    monkeypatch.setattr(Run, "zero_at_rest", None if std_error is None else (zero, std_error))
    matrix = lag(4, 1.0, False, (-1.0, 0.5, 2.0), noise=0.1)
    begun = tuple(replace(run, assumed_beginning="at rest") for run in matrix.runs)  # else first states are free, too
    made = Identification(replace(matrix, runs=begun), Settings(model="first_order"))
    assert isinstance(made.objective, LinearFitness)
    fitness, point = made.objective, np.array([0.55, 0.5])
    here = fitness.exact(point)

    def loss(at: np.ndarray) -> float:
        values = {name: float(value[0]) for name, value in fitness.space.values(at[None]).items()}
        models = [linear_model(fitness.preset.core, values, run, fitness.matrix.actuator) for run in fitness.runs]
        left = [run.measured - output(run, model) for run, model in zip(fitness.runs, models, strict=True)]
        sizes = [run.measured.std() for run in fitness.runs]

        def at_offset(b: float) -> float:
            error = np.mean([np.sqrt(np.mean((r - b) ** 2)) / s for r, s in zip(left, sizes, strict=True)])
            # Each of the runs tells the same: three times as much.
            apart = 0.0 if std_error is None else 3.0 * ((b - zero) / std_error) ** 2
            return float(np.log(error) + 0.5 * apart / sum(run.length for run in fitness.runs))

        return float(np.exp(scipy.optimize.minimize_scalar(at_offset, (zero, zero + 1e-3), tol=1e-14).fun))

    assert here.error == pytest.approx(loss(point), rel=1e-9)
    slope = [(loss(point + step) - loss(point - step)) / 2e-5 for step in 1e-5 * np.eye(2)]
    assert here.gradient == pytest.approx(slope, rel=1e-4, abs=1e-6)


def test_parameters_and_offsets_lie_within_their_standard_errors(full):
    """z of gain, time constant and offset over machines: within three for 98 %, with an rms of 0.8 to 1.25."""
    scores = []
    for seed in range(100 if full else 10):
        for zeroed in (None, False):
            offset = float(np.random.default_rng([62, seed]).normal() * 2.0)
            found = fitted(lag(100 + seed, offset, zeroed, (-1.0, 0.5, 2.0), noise=0.1))
            names = list(found.parameters)
            for name, truth in zip(names, truths(found), strict=True):
                scores.append((found.parameters[name].value - truth) / found.parameters[name].std_error)
            told = found.transducer_offset.get("displacement")
            if told is not None:
                scores.append((told.value - offset) / told.std_error)
            if abs(offset) > 1.5:
                assert "offset" in found.headline
    z = np.array(scores)
    assert np.mean(np.abs(z) < 3.0) >= 0.98
    assert 0.8 < np.sqrt(np.mean(z**2)) < 1.25


def truths(found) -> list[float]:
    return [TAU if estimate.unit == "s" else GAIN for estimate in found.parameters.values()]
