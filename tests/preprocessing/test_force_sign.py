"""Which records say that a specimen would drive what moves it: one friction, moved to and fro and one way."""

from __future__ import annotations

import numpy as np
import pytest

from ident.preprocessing.force_sign import gives_work_back
from ident.run import Run

TIME = np.arange(4000) / 200.0
TO_AND_FRO = 2.0 * np.sin(2.0 * np.pi * TIME)
ONE_WAY = -5.0 + 0.3 * np.sin(20.0 * TIME)


def friction(speed: np.ndarray) -> np.ndarray:
    """Dry and viscous friction, N."""
    return 3.0 * np.sign(speed) + 0.2 * speed


def recorded(speed: np.ndarray, force: np.ndarray) -> Run:
    """A run of a specimen whose speed is given."""
    channels, units = {"velocity": speed, "force": force}, {"velocity": "m/s", "force": "N"}
    return Run("r", "", 200.0, channels, units, output="force")


def test_a_specimen_that_is_moved_one_way_takes_its_work_by_the_means() -> None:
    """A drive at constant speed, with the ripple of its regulator: the force falls while the speed rises."""
    force = friction(ONE_WAY) - 4.0 * (ONE_WAY - ONE_WAY.mean())
    assert np.mean(force * ONE_WAY) > 0 > np.mean((force - force.mean()) * (ONE_WAY - ONE_WAY.mean()))
    assert not gives_work_back(recorded(ONE_WAY, force))


@pytest.mark.parametrize("offset", [0.0, 20.0, -20.0])
def test_the_sign_of_a_force_is_found_whatever_its_zero_is(offset: float) -> None:
    assert gives_work_back(recorded(TO_AND_FRO, -friction(TO_AND_FRO) + offset))
    assert not gives_work_back(recorded(TO_AND_FRO, friction(TO_AND_FRO) + offset))


def test_of_a_position_the_sign_is_found_by_its_rate() -> None:
    position = 0.3 * np.sin(2.0 * np.pi * TIME)
    for sign in (1.0, -1.0):
        force = sign * friction(0.6 * np.pi * np.cos(2.0 * np.pi * TIME)) + 8.0 * position
        channels, units = {"displacement": position, "force": force}, {"displacement": "m", "force": "N"}
        assert gives_work_back(Run("r", "", 200.0, channels, units, output="force")) is (sign < 0)
