"""A table under a position loop that an accelerometer watches: displacement command → acceleration."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import butter, lsim, sosfiltfilt

from ident.matrix import Actuator, Matrix
from ident.presets.suitable_models import in_question
from ident.run import Run
from ident.workflows import identify

RATE, NOISE = 500.0, 0.005
LOOP, VALVE, COLUMN, DAMPING = 20.0, 4e-3, 2 * np.pi * 30.0, 0.2


def table(unit: str = "m") -> Matrix:
    """x = r / (1 + s (τ s + 1)(s²/ω² + 2 ζ s/ω + 1) / K), by SciPy, and its second derivative beside white noise."""
    around = np.polymul(np.polymul([1.0, 0.0], [VALVE, 1.0]), [COLUMN**-2, 2 * DAMPING / COLUMN, 1.0]) / LOOP
    closed = np.polyadd(around, [1.0])
    rng, time, runs = np.random.default_rng(4), np.arange(5000) / RATE, []
    for use, size in (("fit", 0.01), ("fit", 0.005), ("verify", 0.008)):
        command = sosfiltfilt(butter(2, [0.5, 20.0], "bandpass", fs=RATE, output="sos"), rng.standard_normal(len(time)))
        command[:250] = 0.0
        command = sosfiltfilt(butter(2, 40.0, fs=RATE, output="sos"), command)
        command *= size / command.std()
        _, shown, _ = lsim(([1.0, 0.0, 0.0], closed), command, time)
        shown = shown + NOISE * shown.std() * rng.standard_normal(len(shown))
        channels, units = {"command": command, "acceleration": shown}, {"command": unit, "acceleration": "m/s^2"}
        runs.append(Run(f"{use}-{size}", "", RATE, channels, units, output="acceleration", use=use))
    return Matrix(Actuator("TABLE"), tuple(runs))


def test_a_table_whose_acceleration_alone_is_recorded_is_a_machine_under_a_position_loop():
    """No model is named: what is commanded is a way, and no lag of a way is an acceleration."""
    matrix = table()
    assert [model.name for model in in_question(matrix.runs)] == ["qian2014"]
    found = identify(matrix)
    assert found.error["verify"] < 1.2 * NOISE
    (gain,) = [one.value for one in found.determined if one.expression.startswith("Z0 / (A^2")]
    assert gain == pytest.approx(LOOP, rel=0.02)


def test_a_voltage_before_an_acceleration_is_compared_with_nothing():
    assert "qian2014" not in [model.name for model in in_question(table("V").runs)]
