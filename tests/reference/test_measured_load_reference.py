"""The reference of a measured force agrees with the linear one, where both say the same machine."""

from __future__ import annotations

import numpy as np
import pytest

from tests.reference import measured_load_reference as reference
from tests.reference import qian_reference as linear

PLANT, GAIN = linear.Plant(), 7.0


@pytest.mark.parametrize("hold", ["linear", "zoh"])
@pytest.mark.parametrize("samples", [0, 7])
def test_without_a_force_it_is_the_linear_reference(hold, samples):
    """Also where the command is late by whole samples: 2e-8 of the displacement's standard deviation."""
    command = linear.band_limited_noise(512, 1.27e-3, np.random.default_rng(1))
    command[0] = 0.0  # a straight line from nothing to the first value would last a sample where it is late
    late = np.concatenate([np.zeros(samples), command[: 512 - samples]])
    wanted = linear.simulate(PLANT, linear.Cell(0.0, 0.0, 0.0, GAIN), late, hold)
    delay = samples / linear.SAMPLE_RATE
    got = reference.respond(PLANT, GAIN, command, np.zeros(512), delay, hold)
    assert np.max(np.abs(got - wanted)) < 2e-8 * np.std(wanted)


def test_the_force_of_a_spring_is_the_spring():
    """Given what a spring took, it moves as with the spring; drawing the force in lines costs 1e-4."""
    command = linear.band_limited_noise(512, 1.27e-3, np.random.default_rng(2))
    spring = linear.Cell(0.0, 200e3, 0.0, GAIN)
    wanted = linear.simulate(PLANT, spring, command)
    got = reference.respond(PLANT, GAIN, command, spring.stiffness * wanted, 0.0, "linear")
    free = reference.respond(PLANT, GAIN, command, 0.0 * wanted, 0.0, "linear")
    assert np.std(got - wanted) < 1e-4 * np.std(wanted)
    assert np.std(free - wanted) > 0.05 * np.std(wanted)
