"""What a fit says first of validation data that it explains worse than their mean would."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify

RATE, COUNT = 50.0, 600
SMALL = {"population": 20.0, "generations": 6.0, "elite": 3.0}


def turned(use: str, gain: float, unit: str) -> Run:
    """Held torques into 0.4 ω' + ω = gain u, from sample to sample as SciPy's filter has it; noise of 1 %."""
    rng = np.random.default_rng([67, use == "fit"])
    u, held = np.repeat(rng.uniform(-1.0, 1.0, COUNT // 40), 40), np.exp(-1.0 / RATE / 0.4)
    v = gain * scipy.signal.lfilter([0.0, 1.0 - held], [1.0, -held], u)
    v += 0.01 * v.std() * rng.standard_normal(COUNT)
    units = {"command": unit, "velocity": "rad/s"}
    return Run(use, "", RATE, {"command": u, "velocity": v}, units, output="velocity", hold="zoh", use=use)


def first_note(gain: float, unit: str, model: str) -> str:
    matrix = Matrix(Actuator("DRIVE"), (turned("fit", 3.0, unit), turned("verify", gain, unit)))
    return identify(matrix, Settings(model=model, options=SMALL)).notes[0]


@pytest.mark.parametrize(("unit", "model"), [("N*m", "drive"), ("V", "motor")])
def test_validation_data_that_contradict_a_fit_are_named_first(unit, model):
    """At the same torque the speed is a quarter: 300 % are left, and a torque may be what answers."""
    note = first_note(0.75, unit, model)
    assert note.startswith("Validation data contradict the model: of run verify it leaves 30")
    assert ("set output: force" in note) == (unit == "N*m")


@pytest.mark.parametrize("gain", [3.0, 2.0])
def test_nothing_is_said_of_validation_data_that_a_fit_explains_in_part(gain):
    """Two thirds of the gain leave a half."""
    assert not first_note(gain, "N*m", "drive").startswith("Validation")
