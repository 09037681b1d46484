"""Motors that move a mass along a way, with dry friction and with or without a constant force, stepped here."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.operating_point import CONSTANTS, at_operating_point
from ident.diagnosis.structure_selection import compared_structures
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE, SECONDS, FINE = 100.0, 20.0, 50
GAIN, DAMPING, FRICTION = 0.37, 2.0, 0.2  # for each kg: m/(s² V), 1/s, m/s²
WINDOW = 0.35  # s


def rail(constant: float, seed: int, use: str = "fit") -> Run:
    """v' = GAIN u − DAMPING v − FRICTION sgn v − constant, x' = v, by steps of 0.2 ms; noise of 20 µm."""
    rng = np.random.default_rng([61, seed])
    n = round(RATE * SECONDS)
    u = np.repeat(rng.uniform(-4.0, 4.0, n // 50), 50) + constant / GAIN
    v = x = 0.0
    places, dt = [], 1.0 / RATE / FINE
    for command in u.tolist():
        places.append(x)
        for _ in range(FINE):
            driven = GAIN * command - DAMPING * v - constant
            after = v + dt * driven
            v = math.copysign(max(abs(after) - dt * FRICTION, 0.0), after)
            x += dt * v
    out = np.array(places) + 2e-5 * rng.standard_normal(n)
    units = {"command": "V", "displacement": "m"}
    return Run(use, "", RATE, {"command": u, "displacement": out}, units, hold="zoh", use=use)


def over_windows(constant: float) -> CandidateModels:
    matrix = Matrix(Actuator("RAIL"), (rail(constant, 1),))
    return CandidateModels.of(matrix, Settings(model="motor"), (), WINDOW, None)


@pytest.mark.parametrize("constant", [0.0, 0.08])
def test_a_constant_force_belongs_to_the_operating_point_where_there_is_one(constant):
    models = over_windows(constant)
    base = models.refit((), {"m0": 1.0, "c0": DAMPING, "Kt": GAIN})
    found = at_operating_point(models, base)
    assert bool(set(found.effects) & {*CONSTANTS}) is bool(constant)
    assert found.held_out.error <= base.held_out.error


def test_whole_runs_have_no_other_operating_point():
    """The free run of one that settles tells its constant as an effect like any other."""
    models = CandidateModels.of(Matrix(Actuator("RAIL"), (rail(0.08, 1),)), Settings(model="motor"))
    base = models.refit((), {"m0": 1.0, "c0": DAMPING, "Kt": GAIN})
    assert at_operating_point(models, base) is base


def test_a_motor_with_friction_and_a_constant_force_is_no_cylinder(full):
    """A valve's and an oil's lags make up for a part of the friction, and the constant hides the rest."""
    if not full:
        pytest.skip("a minute: run with --full")
    first, *_ = compared_structures(Matrix(Actuator("RAIL"), (rail(0.08, 1), rail(0.08, 2, "verify"))))
    assert first.machine == "motor"
