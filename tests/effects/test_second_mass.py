"""A mass behind a spring is one that swings: a slow part of a machine does not pass for it. SciPy makes the records."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lsim

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.free_shapes import with_free_shapes
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE, NOISE = 50.0, 0.02
SPRING = ([120.0, 96.0, 1920.0], [1.0, 4.6, 34.4, 48.0])
"""60 N(s) / ((1 − μ) s³ + 2 ζ ω s² + ω² s + c N(s)) with N(s) = s² + 2 ζ ω s + ω², ω = 4 rad/s, ζ = 0.1, μ = 0.5 and
c = 1.5 1/s: the drive's speed for each volt."""
CREEPING = ([58.4, 30.0], [0.2, 2.58, 1.0])
"""12/(0.08 s + 1) + 18/(2.5 s + 1): two lags side by side."""


@pytest.mark.parametrize(("machine", "is_explained"), [(SPRING, True), (CREEPING, False)])
def test_a_load_that_swings_is_found_and_a_part_that_creeps_is_no_load_behind_a_spring(machine, is_explained):
    rng, time = np.random.default_rng(1), np.arange(1500) / RATE
    volts = np.repeat(rng.normal(0.0, 1.0, 20), 75)
    speed = lsim(machine, volts, time, interp=False)[1]
    speed += NOISE * speed.std() * rng.standard_normal(len(speed))
    channels, units = {"command": volts, "velocity": speed}, {"command": "V", "velocity": "rad/s"}
    run = Run("steps", "", RATE, channels, units, output="velocity", hold="zoh")
    models = CandidateModels.of(Matrix(Actuator("X"), (run,)), Settings(model="motor"), ())
    models = with_free_shapes(models, ["elastic_load"])
    start = {"m0": 1.0, "c0": 1.0, "Kt": 30.0, "elastic_load__share": 0.5, "elastic_load__damping": 0.1}
    refits = [models.refit(("elastic_load",), start | {"elastic_load__frequency": each}) for each in (1.0, 3.0)]
    assert (min(refit.error for refit in refits) < 1.2 * NOISE) is is_explained
