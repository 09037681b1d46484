"""A speed that was recorded without its sign gets it back from its command."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.signal import lsim

from ident.effects.rectified_sensor import rectified, with_sign
from ident.matrix import Actuator, Matrix
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


@pytest.mark.parametrize("signs", [(1.0, 1.0), (1.0, -1.0)], ids=["one way", "each run another way"])
def test_a_motor_that_is_driven_one_way_by_a_noisy_torque_is_not_rectified(signs: tuple[float, float]) -> None:
    """The torque's noise passes zero, its speed never does. Seed 32."""
    rng = np.random.default_rng(32)

    def run(torque: np.ndarray, seen: Callable[[np.ndarray], np.ndarray]) -> Run:
        _, speed, _ = lsim(([1.0], [300.0, 1.0]), torque, np.arange(len(torque)))
        noisy = torque + 0.6 * rng.standard_normal(len(torque))
        return Run("a", "", 1000.0, {"command": noisy, "velocity": seen(speed)}, output="velocity")

    steps = np.repeat([0.5, 1.0], 2000)
    one_way = tuple(run(sign * steps, lambda speed: speed) for sign in signs)
    both_ways = tuple(run(np.concatenate([sign * steps, -sign * steps]), np.abs) for sign in signs)
    assert not rectified(Matrix(Actuator("A"), one_way))
    assert rectified(Matrix(Actuator("A"), both_ways))
