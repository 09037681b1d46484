"""How late a machine answers to a slow command: the sum of its lags and delays."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.fit.slow_answer import NAME, lags
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify

RATE = 50.0


def axis(seed: int) -> Matrix:
    """Two lags of 60 and 45 ms and a delay of 40 ms into a cylinder that integrates: steps of 0.4 ms, 2 % noise."""
    runs = []
    for number, use in enumerate(("fit", "verify")):
        rng = np.random.default_rng([seed, number])
        u = np.repeat(rng.uniform(-1, 1, 60), 20)
        fine = np.repeat(u, 50)
        fine = np.concatenate([np.zeros(100), fine])[: len(fine)]
        first = second = x = 0.0
        out = []
        for k, now in enumerate(fine):
            if k % 50 == 0:
                out.append(x)
            x += 0.3 * second * 4e-4
            second += (first - second) * -np.expm1(-4e-4 / 0.045)
            first += (now - first) * -np.expm1(-4e-4 / 0.06)
        y = np.array(out)
        y += 0.002 * y.std() * rng.standard_normal(len(y))
        channels, units = {"command": u, "displacement": y}, {"command": "V", "displacement": "m"}
        runs.append(Run(use, "", RATE, channels, units, hold="zoh", use=use))
    return Matrix(Actuator("LATE"), tuple(runs))


@pytest.mark.parametrize("seed", [4, 5])
def test_which_stage_is_late_is_not_known_but_how_late_all_are(seed):
    fit = identify(axis(seed), Settings(model="open_valve"))
    assert fit.undetermined
    (late,) = [entry for entry in fit.determined if entry.expression == NAME]
    assert late.unit == "s"
    assert late.value == pytest.approx(0.145, rel=0.06)
    assert abs(late.value - 0.145) < 5 * late.std_error + 0.003  # of a matrix whose model has no delay


@pytest.mark.parametrize("output", ["velocity", "displacement"])
def test_lags_and_delays_of_stages_and_effects_add_up(output):
    rng = np.random.default_rng(1)
    u, y = rng.standard_normal((2, 800))
    channels, units = {"command": u, output: y}, {"command": "V", output: "rad/s" if output == "velocity" else "rad"}
    matrix = Matrix(Actuator("ANY"), (Run("one", "", 100.0, channels, units, output=output),))
    settings = Settings(model="motor", effects=("command_delay", "sensor_lag"))
    objective = Identification(matrix, settings).objective
    point = rng.uniform(0.3, 0.7, (4, len(objective.space.axes)))
    values = objective.space.values(point)
    summed = values["m0"] / values["c0"] + values["command_delay__delay"]
    summed += values["sensor_lag__time_constant"] if output == "displacement" else 0.0  # the speed is not read late
    assert lags(objective, matrix.runs[0], point) == pytest.approx(summed, rel=1e-4)
