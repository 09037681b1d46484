"""A group reaches across models: without mass, dry friction and a dead zone of the drive are one equation."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.result import Diagnosis
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify

RATE, SPEED, WIDTH = 400.0, 30.0, 0.4


def turned(tau: float, stops: bool) -> Matrix:
    """τ ω' + ω = 30 (u − 0.4 sgn) in ten exact steps a sample: sgn of the drive, a dead zone, or of ω, which `stops`.

    u is drawn through; τ in s; the noise is 5 %.
    """
    runs = []
    for number, use in enumerate(("fit", "fit", "verify")):
        random, n = np.random.default_rng([7, number]), int(2.5 * RATE)
        t = np.arange(n) / RATE
        u = sum(np.sin(2 * np.pi * f * t + random.uniform(0, 6)) for f in (0.4, 0.9, 1.7)) / 1.5
        u *= np.minimum(1.0, t / 0.5)
        w, out, share = 0.0, np.zeros(n), -np.expm1(-0.1 / RATE / tau)
        for k in range(1, n):
            for part in range(10):
                now = u[k - 1] + (part + 0.5) / 10 * (u[k] - u[k - 1])
                if stops:
                    after, stop = w + share * (SPEED * now - w), share * SPEED * WIDTH
                    w = after - stop if after > stop else after + stop if after < -stop else 0.0
                else:
                    w += share * (SPEED * np.sign(now) * max(abs(now) - WIDTH, 0.0) - w)
            out[k] = w
        out += 0.05 * out.std() * random.standard_normal(n)
        channels, units = {"command": u, "velocity": out}, {"command": "V", "velocity": "rad/s"}
        runs.append(Run(f"r{number}", "", RATE, channels, units, output="velocity", use=use))
    return Matrix(Actuator("DRIVE"), tuple(runs))


def found(tau: float) -> Diagnosis:
    matrix = turned(tau, stops=True)
    return diagnose(matrix, identify(matrix, Settings(model="")), most=1, propose=False)


def told(of: Diagnosis) -> set[tuple[str, tuple[str, ...], bool]]:
    return {(one.machine, one.effects, one.better) for one in of.verdict.elsewhere}


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_without_mass_dry_friction_and_a_dead_zone_are_one_equation_in_every_model():
    light = found(1.5e-3)
    assert light.model == "motor"
    assert {"dead_zone", "coulomb_friction"} <= {*light.verdict.effects, *light.verdict.indistinguishable[0]}
    assert ("first_order", ("dead_zone",), False) in told(light)
    assert "cannot distinguish this model from others" in light.verdict.text
    assert type(light).from_json(light.to_json()).verdict == light.verdict


@pytest.mark.usefixtures("few_effects")
def test_with_mass_they_are_two_and_the_model_that_explains_more_is_told():
    """Compared before anything was added, a model with a valve's lag looked better than the motor that it is."""
    heavy = found(0.15)
    assert not any("dead_zone" in group for group in heavy.verdict.indistinguishable)
    assert ("motor", ("coulomb_friction",), True) in told(heavy) or heavy.model == "motor"
    assert not any(one.effects == ("dead_zone",) for one in heavy.verdict.elsewhere)
