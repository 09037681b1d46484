"""A body that radiates more than in proportion: the loss is named, no curve of the drive or of the sensor."""

from __future__ import annotations

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

NOISE, STEP, COUNT = 0.005, 4.0, 700
FEW = ("progressive_loss", "flow_saturation", "sensor_nonlinearity", "sensor_lag", "dead_zone", "second_capacity")


def heated(seed: int) -> Run:
    """300 T′ = P − 0.5 (T − 22) − 4·10⁻³ (T − 22)², held powers of up to 80 W, by SciPy, in noise of 0.5 %."""
    rng, t = np.random.default_rng([5, seed]), STEP * np.arange(COUNT)
    power = np.repeat(rng.uniform(0.0, 80.0, COUNT // 70 + 1), 70)[:COUNT]
    power[:20] = 0.0

    def rates(at: float, s: NDArray[np.float64]) -> list[float]:
        excess = max(s[0] - 22.0, 0.0)
        return [(power[min(int(at / STEP + 1e-9), COUNT - 1)] - 0.5 * (s[0] - 22.0) - 4e-3 * excess**2) / 300.0]

    warm = scipy.integrate.solve_ivp(rates, (0.0, t[-1]), [22.0], t_eval=t, rtol=1e-8, max_step=STEP).y[0]
    warm = warm + NOISE * np.std(warm) * rng.standard_normal(COUNT)
    channels, units = {"command": power, "temperature": warm + 273.15}, {"command": "W", "temperature": "K"}
    use = "verify" if seed else "fit"
    return Run(f"run-{seed}", "", 1.0 / STEP, channels, units, output="temperature", use=use, hold="zoh")


def test_a_heat_that_is_radiated_is_a_progressive_loss(monkeypatch):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("OVEN"), (heated(0), heated(1)))
    found = diagnose(records, identify(records, model="first_order"), propose=False)
    assert found.verdict.effects == ("progressive_loss",)
    assert found.ladder[-1].error["verify"] < 1.2 * NOISE
    assert found.ladder[-1].parameters["progressive_loss.inverse_output"].value == pytest.approx(8e-3, rel=0.1)
