"""What a fit finds does not hang on how the data were rounded: every model, on copies that differ by 1e-12."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from ident.comparison.compare import modelled
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Actuator, Controller, Matrix
from ident.presets import PRESETS
from ident.run import Run, Specimen
from ident.workflows import identify
from tests.bench import sets
from tests.conftest import short_searches
from tests.fit.recovery import matrix as with_hidden
from tests.reference import kononykhin_reference
from tests.reference.qian_reference import band_limited_noise
from tests.rounding import perturbed
from tests.short_form import short_form

RATE = 4096.0
CLOSE = 0.1  # standard errors
COPIES = 10  # in the full form
BENCH = kononykhin_reference.scattered(9)
NEAR = {name: tuple(sorted((0.7 * value, 1.4 * value))) for name, value in sets.true_model(BENCH).values().items()}
SHORT = Settings("kononykhin", bounds=NEAR, options={"population": 16.0, "generations": 3.0, "elite": 3.0}, seed=4)
"""A search that the rows of tests/papers make, too."""


def simulated(model: str, values: dict[str, float], output: str = "displacement", **of_matrix: object) -> Matrix:
    """Two runs of a linear model with 1 % of noise."""
    rng = np.random.default_rng(6)
    driven = "command" if of_matrix else PRESETS[model].data.driven_by
    runs = [
        Run(
            f"run-{i}",
            "",
            RATE,
            {driven: band_limited_noise(2048, 1e-3, rng), output: np.zeros(2048)},
            output=output,
            specimen=Specimen(mass=i * 2.0),
        )
        for i in range(2)
    ]
    preset, matrix = PRESETS[model].for_matrix(
        Matrix(Actuator("A", piston_area=5e-4), tuple(runs), **of_matrix), "none"
    )
    clean = modelled(preset, values, matrix)
    noise = {run.id: 0.01 * np.std(clean[run.id]) * rng.standard_normal(run.length) for run in runs}
    measured = [
        Run(
            run.id,
            "",
            RATE,
            {**run.channels, output: clean[run.id] + noise[run.id]},
            output=output,
            specimen=run.specimen,
        )
        for run in runs
    ]
    return Matrix(matrix.actuator, tuple(measured), controller=matrix.controller)


@cache
def bench() -> Matrix:
    """A set without what takes longest."""
    return sets.as_matrix(BENCH, kononykhin_reference.full_set(BENCH, 9, short=True))


OPEN = {"m0": 5.0, "tau": 3e-3, "c0": 400.0, "Ka": 2e-14, "Cl": 1e-12, "Z0": 1e-5}
CASES: dict[str, tuple[Callable[[], Matrix], Settings]] = {
    "qian2014": (lambda: with_hidden("dead_zone", 0.0, 5, 0.5, 6), Settings(seed=4)),
    "qian2014 with an effect": (lambda: with_hidden("dead_zone", 2e-4, 5, 0.5, 6), Settings(effects=("dead_zone",))),
    "first_order": (lambda: simulated("first_order", {"gain": 0.9, "tau": 4e-3}), Settings(model="first_order")),
    "drive": (lambda: simulated("drive", {"m0": 3.0, "c0": 40.0, "k0": 2e4}), Settings(model="drive")),
    "drive under its loop": (
        lambda: simulated(
            "drive", {"m0": 3.0, "c0": 40.0, "k0": 1.0, "kp": 60.0, "kv": 900.0}, controller=Controller(60.0, 900.0)
        ),
        Settings(model="drive"),
    ),
    "open_valve": (lambda: simulated("open_valve", OPEN, "load_pressure"), Settings(model="open_valve")),
    "kononykhin": (bench, Settings(model="kononykhin")),
    "kononykhin step by step": (bench, Settings(model="kononykhin", method="gradient")),
}


def known(fit: FitResult) -> dict[str, tuple[float, float]]:
    """What the data determine: value and standard error, of parameters and of their combinations."""
    found = {name: (e.value, e.std_error) for name, e in fit.parameters.items() if e.std_error is not None}
    return found | {entry.expression: (entry.value, entry.std_error) for entry in fit.determined}


@pytest.mark.parametrize("case", short_form(CASES, "qian2014 with an effect"))
def test_copies_of_the_data_give_the_same_values(case, full):
    """Within a tenth of a standard error of the fit to the data as they are; ten copies in the full form, else one."""
    make, settings = CASES[case]
    matrix = make()
    with short_searches(full):
        _same(matrix, settings, COPIES if full else 1)


def _same(matrix, settings, copies):
    first = known(identify(matrix, settings))
    assert first
    for seed in range(copies):
        again = known(identify(perturbed(matrix, seed), settings))
        assert again.keys() == first.keys()
        far = {name: abs(again[name][0] - value) / error for name, (value, error) in first.items()}
        assert not {name: by for name, by in far.items() if not by < CLOSE}
