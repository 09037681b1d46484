"""An oscillator whose hysteresis has a loop of any shape, after Bouc and Wen, as SciPy integrates it."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.short_form import short_form

RATE, COUNT = 200.0, 800
MASS, DAMPING, SPRING = 2.0, 12.0, 4e3
ALPHA, BETA = 4e3, 500.0  # N/m, 1/m: z' = α v − β |v| z − γ v |z| (Noël and Schoukens 2016, with ν = 1)
FEW = ("cubic_stiffness", "quadratic_damping", "specimen_hysteresis")


def oscillator(gamma: float, seed: int, use: str) -> Run:
    """Its displacement under a force of several sines, which it follows from rest."""
    rng = np.random.default_rng([91, seed])
    lines = np.arange(1, 41) * 10.0 / 40.0
    phases = rng.uniform(0, 2 * np.pi, 40)

    def force(t: float | np.ndarray) -> np.ndarray:
        ramp = np.minimum(np.asarray(t) / 0.5, 1.0)
        return ramp * 4.2 * np.sin(2 * np.pi * np.multiply.outer(np.asarray(t), lines) + phases).sum(axis=-1)

    def rates(t: float, s: np.ndarray) -> list[float]:
        x, v, z = s
        turn = ALPHA * v - BETA * abs(v) * z - gamma * v * abs(z)
        return [v, (float(force(t)) - DAMPING * v - SPRING * x - z) / MASS, turn]

    t = np.arange(COUNT) / RATE
    x = scipy.integrate.odeint(rates, np.zeros(3), t, tfirst=True, rtol=1e-8, atol=1e-11, hmax=1e-2)[:, 0]
    x = x + 2e-3 * x.std() * rng.standard_normal(COUNT)
    return Run(use, "", RATE, {"command": force(t), "displacement": x}, {"command": "N", "displacement": "m"}, use=use)


@pytest.fixture(autouse=True)
def _few_effects(monkeypatch, full):
    """In the short form what comes nearest to it is ranked."""
    if not full:
        rank_only(monkeypatch, FEW)


@pytest.mark.parametrize("share", short_form([-1.4, 0.2], 0.2))
def test_an_oscillator_that_hardens_is_named_with_the_shape_of_its_loop(share, full):
    """γ = −1.4 β, that of the benchmark, whose force grows ever faster along its way; and nearly Dahl's loop.

    In the short form one effect is added at most.
    """
    if share > 0 and not full:
        pytest.skip("the long form")
    matrix = Matrix(Actuator("BW"), (oscillator(share * BETA, 1, "fit"), oscillator(share * BETA, 2, "verify")))
    found = diagnose(matrix, identify(matrix), propose=False, **({} if full else {"most": 1}))
    assert found.verdict.effects == ("specimen_hysteresis",)
    last = found.ladder[-1]
    assert last.error["verify"] < 0.01
    values = {name.partition(".")[2]: estimate.value for name, estimate in last.parameters.items() if "." in name}
    assert values["gamma"] == pytest.approx(0.5 * share, abs=0.1)
    assert values["force"] / values["yield_displacement"] == pytest.approx(ALPHA, rel=0.1)
