"""A machine whose thrust grows with the square of its command: no dead zone and no bent sensor stands for it."""

from __future__ import annotations

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

RATE, NOISE = 50.0, 0.01
FEW = ("progressive_drive", "dead_zone", "sensor_nonlinearity", "sensor_curve", "underlap", "flow_saturation")


def propeller(seed: int) -> Run:
    """0.6 x″ + 0.9 x′ + 8 x = 0.3 u + 1.4 u² of held voltages, by SciPy, in 2 % of noise of its deviation."""
    rng = np.random.default_rng(seed)
    volts = np.repeat(rng.uniform(0.2, 2.0, 20), 75)

    def rates(t: float, s: NDArray[np.float64]) -> list[float]:
        u = volts[min(int(t * RATE), len(volts) - 1)]
        return [s[1], (0.3 * u + 1.4 * u**2 - 0.9 * s[1] - 8.0 * s[0]) / 0.6]

    t = np.arange(len(volts)) / RATE
    x = scipy.integrate.solve_ivp(rates, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-7, max_step=0.5 / RATE).y[0]
    x = x + NOISE * np.std(x) * rng.standard_normal(len(x))
    channels, units = {"command": volts, "displacement": x}, {"command": "V", "displacement": "rad"}
    return Run(f"run-{seed}", "", RATE, channels, units, hold="zoh", use="verify" if seed else "fit")


@pytest.mark.full
def test_a_thrust_that_grows_with_the_square_of_the_voltage_is_named(monkeypatch):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("PROPELLER"), (propeller(0), propeller(1)))
    found = diagnose(records, identify(records, Settings(model="sprung_motor")), propose=False)
    assert found.verdict.effects == ("progressive_drive",)
    assert found.ladder[0].error["verify"] > 0.2
    assert found.ladder[-1].error["verify"] < 1.1 * NOISE
