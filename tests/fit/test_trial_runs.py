"""Finely sampled records are decimated for searches and trials: the machine at the samples that remain is the same."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit.settings import Settings
from ident.fit.simulated_runs import SimulatedRuns
from ident.fit.trial_runs import decimated, is_stationary, shortened
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.run import Run
from ident.simulation.steps import MOST, steps_needed
from tests.reference.periodic_reference import Law, driven

RATE, BAND, SAMPLES = 1000.0, 2.0 * np.pi * 3.0, 12_000
FRICTION = Law(c=6.0, k=160.0, coulomb_friction_Fc=0.5)


def slow(hold: str) -> np.ndarray:
    """A force of lines up to 3 Hz, 1 N; a held one changes every 20 samples."""
    t, rng = np.arange(SAMPLES) / RATE, np.random.default_rng(5)
    force = sum(np.sin(2 * np.pi * (f * t + rng.uniform())) for f in (0.25, 0.9, 1.7, 3.0))
    return np.repeat(force[::20], 20) if hold == "zoh" else force


@pytest.mark.parametrize("hold", ["linear", "zoh"])
def test_at_the_samples_that_remain_the_simulated_machine_is_where_it_was(hold):
    """A mass with dry friction, by a reference of its own: simulated at every second sample it is as close to it."""
    force = slow(hold)
    truth = driven(FRICTION, force, RATE, hold, 8, "displacement")
    run = Run("r", "", RATE, {"command": force, "displacement": truth}, hold=hold, units={"command": "N"})
    (few,) = decimated((run,), BAND)
    assert few.every == 2
    assert few.measured.tolist() == truth[::2].tolist()
    values = {"m0": 1.0, "c0": FRICTION.c, "k0": FRICTION.k, "coulomb_friction__force": 0.5}
    model, matrix = preset("drive", ("coulomb_friction",)), Matrix(Actuator("A"), (run,))
    at = {p.in_equations: p.value for p in model.parameters} | values
    for each in (run, few):
        output = SimulatedRuns(model, matrix, (each,), BAND).outputs_at(at)["r"]
        assert np.std(output - each.measured) < 3e-3 * np.std(truth)


def test_trials_of_a_diagnosis_are_decimated_and_what_is_reported_is_not():
    """The records of trials and of rough steps are the same objects, so that what is known of them is found once."""
    force = slow("linear")
    run = Run("r", "", RATE, {"command": force, "displacement": force}, units={"command": "N"})
    models = CandidateModels.of(Matrix(Actuator("A"), (run,)), Settings(model="drive"))
    few, rough = (models.fitness((), samples).runs for samples in (131_072, 49_152))
    assert [one.every for one in few] == [2]
    assert [one.every for one in models.fitness(()).runs] == [1]
    assert all(one is other for one, other in zip(few, rough, strict=True))


def test_a_held_command_is_its_mean_until_the_next_sample_that_remains():
    """The area under it stays, and so does what was commanded before the record."""
    ramp = np.arange(10.0)
    run = Run("r", "", RATE, {"command": ramp, "displacement": ramp}, hold="zoh", past=np.arange(-7.0, 0.0))
    few = run.decimated(4)
    assert few.command.tolist() == [1.5, 5.5, 8.5]
    assert few.measured.tolist() == [0.0, 4.0, 8.0]
    assert few.past is not None
    assert few.past.tolist() == [-2.5]
    assert (few.sample_rate, few.every, few.decimated(2).every) == (250.0, 4, 8)
    lines = Run("r", "", RATE, {"command": ramp, "displacement": ramp}, past=np.arange(-7.0, 0.0)).decimated(4)
    assert lines.command.tolist() == [0.0, 4.0, 8.0]
    assert lines.past is not None
    assert lines.past.tolist() == [-4.0]


def test_a_record_begins_as_it_did():
    """Whether it stands is told by all of its samples."""
    still = np.concatenate([np.zeros(40), np.sin(np.arange(400) / 30.0)])
    run = Run("r", "", RATE, {"command": still, "displacement": still})
    assert run.decimated(9).begins == run.begins


def test_as_many_steps_are_allowed_as_in_the_samples_of_the_record():
    """A fast mode of six samples together gets four times the most steps of one: a power of two."""
    chain = preset("qian2014").chain
    (steps,) = steps_needed(chain, np.array([-1e4 + 1e4j]), "linear", (), every=6)
    assert steps == 4 * MOST


TURNS = np.sin(2.0 * np.pi * 240 * np.arange(24_000) / 24_000)  # 240 periods


def larger(times: float, share: float) -> np.ndarray:
    """A sine that is so many times as large in the first share of it."""
    return np.where(np.arange(len(TURNS)) < share * len(TURNS), times, 1.0) * TURNS


@pytest.mark.parametrize(
    ("signal", "alike"),
    [
        (larger(1.4, 1 / 2), True),
        (larger(1.6, 1 / 2), False),
        (larger(2.0, 1 / 16), False),  # of a sixth it would be a smaller part
        (larger(1.95, 1 / 20), True),  # of a tenth it would be a larger part
        (np.sin(300.0 * np.linspace(0.3, 2.0, 24_000) ** 2), False),
        (np.cumsum(np.random.default_rng(1).standard_normal(24_000)), False),
        (np.repeat(np.random.default_rng(2).choice([-1.0, 1.0], 2400), 10), True),
    ],
)
def test_a_record_is_cut_where_its_parts_are_alike(signal, alike):
    assert is_stationary(signal) is alike
    units = {"command": "N", "displacement": "m"}
    run = Run("a", "", RATE, {"command": signal, "displacement": TURNS}, units)
    assert shortened([run], 6000)[0].length == (6000 if alike else 24_000)
