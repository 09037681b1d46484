"""A seal that is pushed to and fro at four pressures: what its friction hangs on was recorded, the same all a run.

The force is worked out here, sample by sample: 300 N·s/m and a dry friction of 2 N + 1 N/bar against the speed, which
is never zero for longer than a turn.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ident.diagnosis.auxiliary_channels import auxiliary_channels
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.result import Diagnosis
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify

RATE, DAMPING, LEAST, BY_PRESSURE, NOISE = 100.0, 300.0, 2.0, 1e-5, 0.05
BAR = 1e5


def found(matrix: Matrix, settings: Settings) -> tuple[str, ...]:
    """The auxiliary channels of the model of some settings."""
    models = CandidateModels.of(matrix, settings)
    return auxiliary_channels(models.preset, matrix.runs, models.runs)


def pushed(bar: float, seed: int, use: str = "fit") -> Run:
    """A run of 10 s at one pressure: three sines, their middle at 20 mm, begun in motion."""
    rng = np.random.default_rng(seed)
    t = np.arange(1000) / RATE
    w, phase = 2 * np.pi * np.array([0.31, 0.53, 0.97]), rng.uniform(0, 2 * np.pi, 3)
    amplitude = 1e-3 * np.array([8.0, 4.0, 2.0])
    x = 0.02 + np.sin(np.outer(t, w) + phase) @ amplitude
    v = np.cos(np.outer(t, w) + phase) @ (amplitude * w)
    pressure = bar * BAR + 10.0 * rng.standard_normal(len(t))
    force = 5e-4 * bar * BAR + DAMPING * v + (LEAST + BY_PRESSURE * bar * BAR) * np.sign(v)
    channels = {
        "displacement": x,
        "velocity": v,
        "pressure_a": pressure,
        "force": force + NOISE * rng.standard_normal(len(t)),
    }
    units = {"displacement": "m", "velocity": "m/s", "pressure_a": "Pa", "force": "N"}
    return Run(f"{bar:g} bar {seed}", "", RATE, channels, units, output="force", use=use)


@cache
def seals() -> Matrix:
    """Four pressures, and one between to verify."""
    runs = [pushed(bar, i) for i, bar in enumerate((1.0, 3.0, 5.0, 7.0))]
    return Matrix(Actuator("SEAL"), (*runs, pushed(4.0, 9, "verify")))


@cache
def diagnosed() -> Diagnosis:
    matrix = seals()
    return diagnose(matrix, identify(matrix, Settings(model="specimen")))


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_where_a_machine_that_is_moved_begins_is_no_parameter_of_the_run():
    """With the start free each run had a friction of its own: that of a place, far away, where it never was."""
    left = {
        effect: identify(seals(), Settings(model="specimen", effects=(effect,))).error["fit"]
        for effect in ("coulomb_friction", "position_friction")
    }
    assert left["position_friction"] > 1.3 * left["coulomb_friction"]
    assert diagnosed().verdict.effects == ("coulomb_friction",)


@pytest.mark.parametrize("first", [0, 10], ids=["moving", "at a turn"])
def test_its_position_begins_where_it_was_measured(first):
    matrix = replace(seals(), runs=tuple(run.part(first, run.length) for run in seals().runs))
    runs = Identification(matrix, Settings(model="specimen", effects=("position_friction",))).objective
    runs.settle({p.in_equations: p.value for p in runs.preset.parameters})
    place = runs.chain.states.index("x")
    assert [runs.start(run)[place] for run in runs.runs] == [run.channels["displacement"][0] for run in runs.runs]


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_friction_that_grows_with_a_recorded_pressure_is_proposed():
    found = diagnosed()
    assert found.verdict.unexplained
    equations = [one.equation for one in found.proposals]
    assert "Ff = Ff + s * (pressure_a)" in equations
    term = found.proposals[equations.index("Ff = Ff + s * (pressure_a)")]
    assert term.unit == "m^2"
    assert "recorded beside" in term.meaning
    assert found.proposals[-1].error["verify"] < 0.5 * found.ladder[-1].error["verify"]


def test_what_the_machine_answers_is_no_term():
    matrix = seals()
    assert found(matrix, Settings(model="specimen")) == ("pressure_a",)
    steady = [replace(run, channels={**run.channels, "pressure_a": np.full(run.length, BAR)}) for run in matrix.runs]
    same = replace(matrix, runs=tuple(steady))
    assert found(same, Settings(model="specimen")) == ()
    commanded = [
        replace(run, output="displacement", channels={**run.channels, "command": run.channels["displacement"]})
        for run in matrix.runs
    ]
    loop = replace(matrix, runs=tuple(commanded))
    assert found(loop, Settings(model="first_order")) == ()
