"""A record that left a limit of the rig is said first; one that kept it is not doubted for its noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.checks.check import check
from ident.matrix import Actuator, Matrix
from ident.rig.limits import RigLimits
from ident.rig.motion import edge_of_band, motion_peaks
from ident.run import Run

RATE = 2048.0
T = np.arange(4096) / RATE


def matrix(noise: float, **limits: float) -> Matrix:
    """A sine of 10 mm at 5 Hz and its answer, 0.314 m/s and 9.87 m/s², with white noise on it (m)."""
    rng = np.random.default_rng(3)
    x = 0.01 * np.sin(2 * np.pi * 5 * T)
    channels = {"command": x, "displacement": x + noise * rng.standard_normal(len(x))}
    run = Run("r1", "", RATE, channels, {"command": "m", "displacement": "m"}, kind="sine", gain=5.0)
    return Matrix(Actuator("A", piston_area=5e-4, rig=RigLimits(**limits)), (run, replace(run, id="v", use="verify")))


@pytest.mark.parametrize(
    ("limit", "kept", "left"),
    [("speed", 0.33, 0.30), ("acceleration", 10.5, 9.5), ("stroke", 0.0212, 0.0198), ("flow", 1.65e-4, 1.5e-4)],
)
def test_each_limit_is_held_against_the_motion(limit, kept, left):
    """Noise of 0.5 % of the answer does not count as speed or acceleration."""
    assert not [one for one in check(matrix(5e-5, **{limit: kept})) if one.code == "beyond-rig"]
    first = check(matrix(5e-5, **{limit: left}))[0]
    assert (first.code, first.severity) == ("beyond-rig", "doubt")
    assert limit in first.text


def test_the_peaks_of_a_record_that_begins_in_motion():
    """A part of a sine: neither its ends nor its slope between them make speed or acceleration of their own."""
    part = 0.01 * np.sin(2 * np.pi * 5 * T + 1.0)[:3333] + 0.2 * T[:3333]
    found = motion_peaks(part, RATE, 20.0)
    assert found["speed"] == pytest.approx(0.2 + 0.1 * np.pi, rel=0.02)
    assert found["acceleration"] == pytest.approx(np.pi**2, rel=0.2)
    assert edge_of_band(part - 0.2 * T[:3333], RATE) < 40
