"""A logger that starts before the drive is on: the first step is answered later than all others."""

from __future__ import annotations

import numpy as np
import pytest
import scipy

from ident.checks.check import check
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE = 2000.0  # Hz


def motor(volts: np.ndarray, off: int = 0, delay: int = 0) -> np.ndarray:
    """The speed of a motor with a time constant of 5 ms that is off for the first samples, with noise, rad/s."""
    acting = np.where(np.arange(len(volts)) < off, 0.0, volts)
    late = np.concatenate([np.zeros(delay), acting])[: len(acting)]
    fall = np.exp(-1.0 / (0.005 * RATE))
    speed = scipy.signal.lfilter([17.0 * (1.0 - fall)], [1.0, -fall], late)
    return np.asarray(speed) + np.random.default_rng(0).normal(0.0, 1.0, len(volts))


def codes(off: int, delay: int) -> list[tuple[str | None, str]]:
    """The doubts of a start of 12 V and of steps to 6 and 9 V, of a drive that is off or late."""
    start, steps = np.full(3000, 12.0), np.repeat([0.0, 6.0, 0.0, 9.0, 0.0], 1000)
    runs = [("start", start, motor(start, off, delay)), ("steps", steps, motor(steps, 0, delay))]
    units = {"command": "V", "velocity": "rad/s"}
    listed = tuple(
        Run(name, "", RATE, {"command": volts, "velocity": speed}, units, hold="zoh", output="velocity")
        for name, volts, speed in runs
    )
    found = [one for one in check(Matrix(Actuator("M"), listed)) if one.code == "late-start"]
    assert all("leave out the rows before 97.50 ms" in one.text for one in found)
    return [(one.run, one.severity) for one in found]


def test_a_start_that_is_answered_late_is_doubted():
    assert codes(off=194, delay=0) == [("start", "doubt")]


@pytest.mark.parametrize("delay", [0, 10, 194])
def test_a_drive_that_is_on_is_not_however_late_it_always_is(delay):
    assert codes(off=0, delay=delay) == []


@pytest.mark.parametrize("wander", [0.0, 0.3])
def test_an_arm_that_its_drive_holds_sets_out_when_the_command_changes(wander):
    """The record begins while it is held; the command of a slow swing changes by a few per cent before it is seen."""
    time = np.arange(6000) / 100.0
    volts = 6.0 + np.where(time > 8.0, 0.3 * (1.0 - np.cos(0.5 * (time - 8.0))), 0.0)
    steps = np.repeat([6.0, 9.0, 6.0, 3.0, 6.0], 1200)
    rng, units = np.random.default_rng(1), {"command": "V", "displacement": "rad"}
    listed = []
    for name, command in (("held", volts + wander * np.sin(0.4 * time) * (time > 5.0)), ("steps", steps)):
        fall = np.exp(-1.0 / (0.2 * 100.0))
        angle = scipy.signal.lfilter([0.1 * (1.0 - fall)], [1.0, -fall], command - 6.0) + 1.0
        channels = {"command": command, "displacement": angle + rng.normal(0.0, 1e-4, len(time))}
        listed.append(Run(name, "", 100.0, channels, units, hold="zoh"))
    assert not [one for one in check(Matrix(Actuator("M"), tuple(listed))) if one.code == "late-start"]
