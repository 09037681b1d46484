"""A counter that does not see the sign of a motor's speed is named, though nothing linear answers the command."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lsim

from ident.diagnosis.structure_selection import choose_structure
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.readers import from_arrays
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

FEW = ("rectified_sensor", "coulomb_friction", "dead_zone", "null_bias")
LAG, NOISE = 6.0, 0.005  # samples, of the output


def counted(seed: int, use: str) -> Matrix:
    """A motor under levels about zero, its speed counted without a sign; integrated by SciPy."""
    rng = np.random.default_rng([65, seed])
    volts = np.repeat(rng.uniform(-5.0, 5.0, 30), 20)
    _, speed, _ = lsim(([8.0], [LAG, 1.0]), volts, np.arange(len(volts)))
    speed = np.abs(speed) + NOISE * speed.std() * rng.standard_normal(len(speed))
    return from_arrays(
        {"command": volts, "velocity": speed},
        units={"command": "V", "velocity": "rad/s"},
        output="velocity",
        sample_rate="100 Hz",
        id=f"{use}-{seed}",
        use=use,
        hold="linear",
        actuator={"serial": "COUNTER"},
    )


@pytest.mark.full
def test_a_counter_without_a_sign_is_named_whatever_the_command(monkeypatch):
    rank_only(monkeypatch, FEW)
    runs = (*counted(1, "fit").runs, *counted(2, "fit").runs, *counted(3, "verify").runs)
    matrix = Matrix(Actuator("COUNTER"), runs)
    choice = choose_structure(matrix)
    assert choice.structures[0].machine == "motor"
    assert "The records show rectified sensor. The models were compared" in choice.matrix.notices[0]
    fit = identify(matrix, Settings(model="motor", options={"population": 24.0, "generations": 8.0, "elite": 4.0}))
    assert (fit.error["fit"] or 0.0) > 0.5
    found = diagnose(matrix, fit, propose=False)
    assert found.verdict.effects == ("rectified_sensor",)
    assert found.ladder[-1].error["verify"] < 2 * NOISE  # of a counted speed, which deviates by less
