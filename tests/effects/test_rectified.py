"""A speed that was recorded without its sign gets it back from its command."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lsim

from ident.effects.rectified_sensor import with_sign
from ident.run import Run


@pytest.mark.parametrize("lag", [0.7, 4.0, 20.0])  # samples
def test_the_sign_of_a_motor_is_that_of_its_command_behind_its_lag(lag: float) -> None:
    """Noise of 1 %; wrong are only the smallest speeds. Seed 31."""
    rng = np.random.default_rng(31)
    command = np.repeat(rng.uniform(-1, 1, 60), 25)
    _, speed, _ = lsim(([1.0], [lag, 1.0]), command, np.arange(len(command)))
    counted = np.abs(speed) + 0.01 * speed.std() * rng.standard_normal(len(speed))
    run = Run("a", "", 100.0, {"command": command, "velocity": counted}, output="velocity")
    wrong = np.sign(with_sign(run).measured) != np.sign(speed)
    assert np.mean(wrong) < 0.05
    assert np.sum(speed[wrong] ** 2) < 0.01 * np.sum(speed**2)
