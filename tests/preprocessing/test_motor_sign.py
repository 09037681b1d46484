"""An axis that its command drives down from stop to stop, integrated in small steps: a motor against its drive."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.preprocessing.motion_sign import a_motor_is_against, against_its_drive
from ident.run import Run
from ident.workflows import identify

RATE, COUNT, PARTS, LATE = 20.0, 240, 20, 16
DEAD, MOST, SPEED, LAG, STOP = 0.45, 0.8, 3.0, 0.6, 2.0  # of the command, of it, rad/s for each unit, s, rad


def axis(way: float, levels: tuple[float, ...] = (0.6, 0.65, 0.7)) -> Matrix:
    """LAG v' + v = SPEED (u within DEAD and MOST), y' = v from 0 to STOP, turned by `way`; each run is a stroke."""
    runs = []
    for number, level in enumerate(levels):
        on = int(RATE * (STOP / SPEED / (min(level, MOST) - DEAD) + 1.0))
        u = np.repeat([0.0, level, 0.0], [20, on, 10])
        y, v, shown = 0.0, 0.0, []
        for drive in np.clip(np.roll(u, LATE), DEAD, MOST) - DEAD:
            shown.append(way * y)
            for _ in range(PARTS):
                v += (SPEED * drive - v) / (LAG * RATE * PARTS)
                y = min(y + v / (RATE * PARTS), STOP)
        noise = 0.002 * np.random.default_rng([9, number]).standard_normal(len(u))
        channels = {"command": u, "displacement": np.array(shown) + noise}
        runs.append(Run(f"r{number}", "", RATE, channels, {"command": "1", "displacement": "rad"}, hold="zoh"))
    return Matrix(Actuator("ARM"), tuple(runs))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_an_axis_with_a_dead_zone_and_a_stop_is_a_motor_whichever_way_it_goes(way):
    """No balance of mass, damping and spring leaves a tenth of such a drive."""
    matrix = axis(way)
    assert {against_its_drive(run) for run in matrix.runs} == {None}
    assert a_motor_is_against(matrix.runs) is (way < 0)
    fit = identify(matrix, Settings(model="motor"))
    assert any("with the other sign" in note for note in fit.notes) is (way < 0)
    assert fit.error["fit"] < 0.5


def test_what_follows_its_command_is_not_turned() -> None:
    """A swing is behind the integral of a lag by more than a quarter of a period: a motor against it explains it."""
    t = np.arange(2000) / RATE
    r = np.sin(2.0 * np.pi * (0.1 + 0.005 * t) * t)
    run = Run("r", "", RATE, {"command": r, "displacement": r}, {"command": "1", "displacement": "m"})
    assert not a_motor_is_against([run])


def test_a_record_that_no_motor_explains_is_not_turned() -> None:
    command, speed = np.random.default_rng(2).standard_normal((2, COUNT))
    run = Run("r", "", RATE, {"command": command, "velocity": speed}, {"velocity": "rad/s"}, output="velocity")
    assert not a_motor_is_against([run])
    assert not a_motor_is_against([replace(run, channels={"command": command, "velocity": np.zeros(COUNT)})])
    force = replace(run, output="force", channels={"command": command, "force": -command})
    assert not a_motor_is_against([force])
