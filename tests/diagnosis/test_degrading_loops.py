"""Columns under a cyclic test whose loops shrink and pinch, after Baber and Noori, as SciPy integrates them."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

FEW = ("specimen_hysteresis", "degrading_hysteresis")
SMALL = {"population": 24.0, "generations": 6.0, "elite": 3.0}
PERIOD, SAMPLES = 40.0, 40  # of a cycle, s and samples
AMPLITUDES = np.repeat(np.arange(1.0, 7.0), 2) * 1e-2  # m, of the cycles one after the other
COUNT = SAMPLES * len(AMPLITUDES)


def way(t: np.ndarray | float) -> np.ndarray:
    """The displacement at a time, m."""
    cycle = np.minimum(np.asarray(t) // PERIOD, len(AMPLITUDES) - 1).astype(int)
    return AMPLITUDES[cycle] * np.sin(2 * np.pi * np.asarray(t) / PERIOD)


def column(seed: int, degrades: bool) -> Matrix:
    """Two thirds of its test to fit, the rest to verify; noise of 1 %. Every number is drawn by the seed."""
    rng = np.random.default_rng([92, seed])
    force, yields, stiffness = rng.uniform(2e5, 5e5), rng.uniform(6e-3, 1.2e-2), rng.uniform(1e6, 4e6)
    nu, eta = rng.uniform(0.02, 0.08, 2) if degrades else (0.0, 0.0)
    slip, growth, width = rng.uniform(0.5, 0.8), rng.uniform(0.3, 1.0), rng.uniform(0.3, 0.6)
    slip = slip if degrades else 0.0

    def rates(t: float, s: np.ndarray) -> list[float]:
        z, energy = s
        v = (float(way(t + 1e-4)) - float(way(t - 1e-4))) / 2e-4
        pinched = 1.0 - slip * (1.0 - np.exp(-growth * energy)) * np.exp(-((z / width) ** 2))
        turn = v - (1.0 + nu * energy) * 0.5 * (abs(v) * z + v * abs(z))
        return [pinched * turn / (1.0 + eta * energy) / yields, z * v / yields]

    t = np.arange(COUNT) * PERIOD / SAMPLES
    z = scipy.integrate.odeint(rates, [0.0, 0.0], t, tfirst=True, rtol=1e-7, atol=1e-8, hmax=0.5)[:, 0]
    x, f = way(t), stiffness * way(t) + force * z
    f = f + 0.01 * f.std() * rng.standard_normal(COUNT)
    cut = COUNT * 2 // 3
    return Matrix(Actuator("COLUMN"), tuple(
        Run(use, "", SAMPLES / PERIOD, {"displacement": x[part], "force": f[part]},
            {"displacement": "m", "force": "N"}, output="force", use=use)
        for use, part in {"fit": slice(0, cut), "verify": slice(cut, None)}.items()
    ))  # fmt: skip


@pytest.fixture(autouse=True)
def _few_effects(monkeypatch, full):
    """In the short form what comes nearest to it is ranked."""
    if not full:
        rank_only(monkeypatch, FEW)


def test_the_energy_with_which_a_record_begins_is_found_in_its_own_unit():
    """It is no force: a thousandth of the force as a number is hundreds of times what a whole test dissipates."""
    matrix = column(1, degrades=True)
    shapes = {"yield_displacement": 9e-3, "degradation": 0.05, "pinching": 0.6}
    fixed = {f"degrading_hysteresis.{name}": value for name, value in shapes.items()}
    fit = identify(matrix, Settings(model="specimen", effects=("degrading_hysteresis",), fixed=fixed, options=SMALL))
    assert fit.error["verify"] < 0.11


@pytest.mark.full
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_column_that_degrades_and_pinches_is_named(seed):
    matrix = column(seed, degrades=True)
    found = diagnose(matrix, identify(matrix), propose=False)
    assert "degrading_hysteresis" in found.verdict.effects
    assert "specimen_hysteresis" not in found.verdict.effects
    last = found.ladder[-1].error
    assert last["fit"] < 0.05
    assert last["verify"] < 0.1


@pytest.mark.full
def test_a_column_that_stays_as_it_is_degrades_in_no_verdict():
    matrix = column(1, degrades=False)
    found = diagnose(matrix, identify(matrix), propose=False)
    assert "degrading_hysteresis" not in found.verdict.effects
    assert found.ladder[-1].error["verify"] < 0.03
