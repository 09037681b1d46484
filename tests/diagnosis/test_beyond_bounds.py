"""The range of a strength is an order of magnitude: one that lies beyond it is found."""

from __future__ import annotations

import numpy as np

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.reference.periodic_reference import Law, driven

LOOP = "machine:controller=p,load=mass_spring_damper,sensor=displacement"
LAW = Law(m=1.2, c=28.0, Kt=41.0, Kp=4.0, backlash_b=0.046)
NOISE = 3e-5


def matrix() -> Matrix:
    """A position loop whose play is wider than the drive signal of so small a motion usually is; seed 5."""
    rate = 200.0
    command = 0.013 * np.sin(2 * np.pi * 0.7 * np.arange(2000) / rate)
    x = driven(LAW, command, rate, "linear", 64, "displacement")
    x = x + NOISE * np.random.default_rng(5).standard_normal(len(x))
    run = Run("a", "", rate, {"command": command, "displacement": x}, gain=LAW.Kp, hold="linear")
    return Matrix(Actuator("A"), (run,))


def test_a_strength_beyond_its_range_is_found():
    record = matrix()
    models = CandidateModels.of(record, Settings(model=LOOP))
    base = models.refit((), {"Kt": LAW.Kt / LAW.m, "c0": LAW.c / LAW.m})
    symbol = models.strength("backlash")
    usual = models.fitness(("backlash",)).space.bounds({**models.off, **base.values})[symbol][1]
    assert usual < LAW.backlash_b
    found = models.converged(models.refit(("backlash",), {**base.values, symbol: 0.5 * usual}))
    assert abs(found.values[symbol] / LAW.backlash_b - 1) < 0.02
    assert found.error < 1.05 * NOISE / np.std(record.runs[0].measured)


def test_a_part_of_a_whole_stays_within_its_bounds():
    """A gain cannot fall short of itself by more than all: its range is no order of magnitude."""
    record = matrix()
    models = CandidateModels.of(record, Settings(model=LOOP))
    found = models.refit(("gain_asymmetry",), {"Kt": 30.0, "c0": 20.0, models.strength("gain_asymmetry"): 0.9})
    lower, upper = found.space.bounds(found.values)[models.strength("gain_asymmetry")]
    parameter = found.fitness.preset.parameter(models.strength("gain_asymmetry"))
    assert (lower, upper) == (parameter.lower, parameter.upper)
