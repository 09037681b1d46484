"""Every effect of the catalogue in every model: it can be searched for with its usual bounds, or one line says why not.

The models are the presets and ten machines put together from stages. Kernels are carried out in plain Python, for each
pair has one of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from ident.bench import analysis as bench
from ident.bench import identification as bench_identification
from ident.bench.records import bench_set
from ident.effects import CATALOGUE
from ident.effects import effect as known_effect
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.matrix import Actuator, Matrix
from ident.presets import PRESETS, preset
from ident.run import Run, Specimen
from ident.unstable import UNSTABLE
from ident.workflows import identification, identify
from tests.bench.sets import as_matrix
from tests.presets.test_composed import RATE, UNITS, drawn, smooth, with_own_outputs
from tests.reference import kononykhin_reference as reference
from tests.short_form import short_form
from tests.simulation.plain_kernel import plain_kernels

MACHINES = tuple(drawn(np.random.default_rng([50, seed])) for seed in range(10))
MODELS = (*PRESETS, *MACHINES)
CHANNELS = ("command", "displacement", "velocity", "acceleration", "force", "load_pressure", "spool", "drive_force",
            "vertical_load", "current")  # fmt: skip
KNOWN = {"command": "m", "spool": "V", "drive_force": "N", "vertical_load": "N", "current": "A", **UNITS}
SHORT, LONG = 16, 2000  # samples: of one simulation, of a fit
FITTED = 60  # pairs that are fitted to the end in the full form


def test_there_are_over_eight_hundred_pairs():
    assert len(set(MODELS)) * len(CATALOGUE) > 800


@cache
def records(model: str, length: int) -> Matrix:
    """A run of noise with every channel that a model may ask for; of a bench a short sine."""
    if preset(model).kind == "bench":
        matrix = bench_records()
        return replace(matrix, runs=tuple(run for run in matrix.runs if run.id == "sine-50-5"))
    rng, output = np.random.default_rng(50), next(iter(preset(model).chain.outputs))
    channels = {name: 1e-3 * smooth(rng, length, 20.0) for name in CHANNELS}
    units = KNOWN | {"command": (preset(model).data.command_units or ("m",))[0]}
    run = Run("one", "", RATE, channels, units, gain=5.0, specimen=Specimen(1.0, 1e4, 10.0), kind="blwn", output=output)
    return Matrix(Actuator("ANY", piston_area=5e-4, supply_pressure=2e7), (run,))


@cache
def bench_records() -> Matrix:
    """A set of records of a bench without those that take longest."""
    truth = reference.scattered(9)
    return as_matrix(truth, reference.full_set(truth, 9, short=True))


@pytest.fixture
def prepared(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """No kernel is compiled, and a bench's procedures, which know of no effects, are those of its whole set, once."""
    analysed = cache(lambda: bench.analyse(bench_set(bench_records())))
    monkeypatch.setattr(bench_identification, "analyse", lambda _: analysed())
    monkeypatch.setattr(SimulatedFitness, "prepare", lambda _: None)
    with plain_kernels():
        yield


@pytest.mark.usefixtures("prepared")
@pytest.mark.parametrize("model", short_form(MODELS, *(name for name in MODELS if name != "kononykhin")))
def test_an_effect_is_searched_within_bounds_and_simulated_or_refused_in_one_line(model, full):
    """Refused are those that the model has no place for, and those that read what the model is to show; no others.

    In the short form a preset takes every sixth effect, a machine that was put together every tenth, the next one
    others.
    """
    matrix = records(model, SHORT)
    step = 1 if full else 10 if model in MACHINES else 6
    for effect in CATALOGUE[MODELS.index(model) % step :: step]:
        settings = Settings(model=model, effects=(effect.name,))
        if preset(model).takes(effect) and reads_output(effect, matrix):
            with pytest.raises(Unusable, match="no effect can read it"):
                identification(matrix, settings)
        elif preset(model).takes(effect):
            simulated(identification(matrix, settings), effect)
        else:
            with pytest.raises(Unusable, match=effect.name) as refused:
                identification(matrix, settings)
            assert "\n" not in str(refused.value)


def reads_output(effect: Effect, matrix: Matrix) -> bool:
    """Whether an effect reads the channel that the model is to show."""
    return any(matrix.runs[0].output in text for text in effect.texts)


def simulated(work: Any, effect: Effect) -> None:
    """Look at the bounds of an effect's strength, and simulate the middle of the search space."""
    searched = work if isinstance(work, bench_identification.BenchIdentification) else work.objective
    middle = np.full((1, len(searched.space.axes)), 0.5)
    values = {name: float(v[0]) for name, v in searched.space.values(middle).items()}
    lower, upper = searched.space.reach(effect.added[0].in_equations, values)
    if effect.whole:
        assert lower == upper == effect.strength.upper
    else:
        assert -np.inf < lower <= 0.0 <= upper < np.inf
        assert lower < upper
    assert 0.0 < searched.errors(middle)[0] <= UNSTABLE


@pytest.mark.parametrize(("model", "effect"), [("qian2014", "sensor_lag"), ("strano", "coulomb_friction")])
def test_a_kernel_in_plain_python_gives_what_the_compiled_one_gives(model, effect):
    """With a lag that is advanced exactly, and with dry friction."""
    work = identification(records(model, SHORT), Settings(model=model, effects=(effect,)))
    points = np.random.default_rng(7).uniform(0.2, 0.8, (3, len(work.objective.space.axes)))
    compiled = work.objective.errors(points)
    with plain_kernels():
        assert work.objective.errors(points) == pytest.approx(compiled, rel=1e-6)
    assert np.ptp(compiled) > 0.0


def test_drawn_pairs_are_fitted_to_the_end(full):
    """Each to what the model itself does without the effect: the fit ends with a finite error, no larger than that."""
    if not full:
        pytest.skip("minutes: run with --full")
    rng, fitted = np.random.default_rng(50), 0
    pairs = [(model, effect.name) for model in MODELS for effect in CATALOGUE if preset(model).takes(effect)]
    for number in rng.permutation(len(pairs)):
        model, effect = pairs[number]
        matrix = bench_records() if preset(model).kind == "bench" else own_records(model)
        if matrix is None or reads_output(known_effect(effect), matrix):
            continue
        found = identify(matrix, Settings(model=model, effects=(effect,), seed=1))
        assert found.effects == (effect,)
        assert found.error["fit"] <= 1.02 * error_without(model, matrix), (model, effect)
        fitted += 1
        if fitted == FITTED:
            break
    assert fitted == FITTED


@cache
def error_without(model: str, matrix: Matrix) -> float:
    """The error of the model without an effect."""
    error = identify(matrix, Settings(model=model, seed=1)).error["fit"]
    assert error is not None
    return error


@cache
def own_records(model: str) -> Matrix | None:
    """What a model does under noise at values from the middle of its search; None where hardly any is stable."""
    return with_own_outputs(model, records(model, LONG), np.random.default_rng(51))
