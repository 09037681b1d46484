"""The range of a strength is an order of magnitude: one that lies beyond it is found."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.screening import predict
from ident.fit.levenberg_marquardt import Way
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


@pytest.mark.full
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


def test_a_refit_begins_where_it_was_told_to_though_that_lies_beyond_its_range():
    """One that is continued begins where the one before it ended: not at the end of the usual range again."""
    models = CandidateModels.of(matrix(), Settings(model=LOOP))
    base = models.refit((), {"Kt": LAW.Kt / LAW.m, "c0": LAW.c / LAW.m}, way=Way(most=0))
    symbol, start = models.strength("backlash"), base.values
    usual = models.fitness(("backlash",)).space.bounds({**models.off, **start})[symbol][1]
    for times in (0.5, 5.0, 50.0):
        found = models.refit(("backlash",), {**start, symbol: times * usual}, way=Way(most=0))
        assert abs(found.values[symbol] / (times * usual) - 1) < 1e-9


def test_a_part_of_a_whole_stays_within_its_bounds():
    """A gain cannot fall short of itself by more than all: its range is no order of magnitude."""
    record = matrix()
    models = CandidateModels.of(record, Settings(model=LOOP))
    found = models.refit(("gain_asymmetry",), {"Kt": 30.0, "c0": 20.0, models.strength("gain_asymmetry"): 0.9})
    lower, upper = found.space.bounds(found.values)[models.strength("gain_asymmetry")]
    parameter = found.fitness.preset.parameter(models.strength("gain_asymmetry"))
    assert (lower, upper) == (parameter.lower, parameter.upper)


def stepped() -> Matrix:
    """A mass on a spring with damping as v², moved to and fro by steps of a force; noise of 1 %, seed 7.

    Steps reach far beyond the band in which the mass moves, and its speed is taken for that of the band.
    """
    rate, law = 40.0, Law(m=55.0, c=40.0, k=30.0, quadratic_damping_c2=190.0)
    command = 20.0 * np.tile(np.repeat([1.0, 0.4, -1.0, -0.4], 80), 8)
    x = driven(law, command, rate, "zoh", 8, "displacement")
    x = x + 0.01 * x.std() * np.random.default_rng(7).standard_normal(len(x))
    units = {"command": "N", "displacement": "m"}
    run = Run("a", "", rate, {"command": command, "displacement": x}, units, hold="zoh")
    return Matrix(Actuator("A"), (run,))


def test_what_promises_most_at_the_end_of_its_range_is_predicted_beyond_it():
    models = CandidateModels.of(stepped(), Settings(model="drive"))
    base = models.converged(models.refit((), {"m0": 50.0, "c0": 100.0, "k0": 30.0}))
    symbol = models.strength("quadratic_damping")
    space = models.fitness(("quadratic_damping",)).space
    usual = space.bounds({**models.off, **base.values, **space.fixed})[symbol][1]
    (found,) = predict(models, base, ["quadratic_damping"])
    assert usual < 0.1 * 190.0
    assert found.remaining < 0.9
    assert max(start[symbol] for start in found.starts) > 2.0 * usual
    refit = models.converged_trial(models.trial(("quadratic_damping",), found.starts))
    assert abs(refit.values[symbol] / 190.0 - 1) < 0.1
