"""The signals inside a simulated machine, against SciPy's own integration of its equations."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

from ident.fit.simulated_runs import every_run
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.residuals.traces import inside
from ident.run import Run

RATE = 50.0
VALUES = {"m0": 1.0, "Z0": 1.7, "c0": 4.0, "Ka": 0.011, "Cl": 0.016}
"""A loop of 0.3 Hz, its oil at 1.5 Hz; the valve's lag comes with each test."""


def loop(tau: float, r: np.ndarray) -> dict[str, np.ndarray]:
    """τ w' = r − x − w, Ka P' = Z0 w − v − Cl P, m v' = P − c v, x' = v of a unit area, r straight between samples."""
    v = VALUES
    A = np.array(
        [
            [-1 / tau, 0, 0, -1 / tau],
            [v["Z0"] / v["Ka"], -v["Cl"] / v["Ka"], -1 / v["Ka"], 0],
            [0, 1 / v["m0"], -v["c0"] / v["m0"], 0],
            [0, 0, 1, 0],
        ]
    )
    _, _, states = scipy.signal.lsim((A, [[1 / tau], [0], [0], [0]], np.eye(4), np.zeros((4, 1))), r, TIME)
    w, P, speed, x = states.T
    return {"w": w, "P": P, "v": speed, "x": x, "e": r - x, "dq": (r - x - w) / tau}


TIME = np.arange(1000) / RATE


@pytest.mark.parametrize(("tau", "lost"), [(0.05, ""), (2e-3, ""), (1e-5, "dq")])
def test_a_valve_much_faster_than_the_samples_leaves_the_other_signals(tau, lost):
    """From 2.5 samples long down to a two-thousandth of one: only its own rate asks for steps as short as itself."""
    steps = np.repeat([0.0, 1.0, -0.5, 0.7, 0.0], 200)
    command = scipy.signal.lfilter([0.1], [1, -0.9], steps)
    expected = loop(tau, command)
    run = Run(
        "r",
        "",
        RATE,
        {"command": command, "displacement": expected["x"]},
        {"command": "m", "displacement": "m"},
        gain=1.0,
    )
    matrix = Matrix(Actuator("FAST", piston_area=1.0), (run,))
    found = inside(every_run(preset("qian2014"), matrix), VALUES | {"tau": tau}, list(expected))
    for name in expected.keys() - {lost}:
        assert np.std(found[name]["r"] - expected[name]) < 2e-3 * np.std(expected[name]), name
