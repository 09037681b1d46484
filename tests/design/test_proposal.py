"""The proposed run tells models apart that the runs there are confuse; and it is one that a lab can make."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scipy.io

from ident.design.candidate_runs import candidate_runs
from ident.design.experiment import Experiment
from ident.design.proposal import propose, ranked
from ident.design.rival import Rival
from ident.design.rivals import Rivals
from ident.diagnosis.competing_models import competing_models
from ident.diagnosis.result import Diagnosis
from ident.errors import Unusable
from ident.fit.levenberg_marquardt import Way
from ident.fit.reduction import excited_band
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import search_space
from ident.matrix import Actuator, Matrix
from ident.presets import Preset, preset
from ident.rig.limits import RigLimits
from ident.run import Run
from ident.workflows import identify
from tests.fit.recovery import NOISE, matrix
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

FRICTION = 1.5  # N, of which two runs at the largest amplitude show next to nothing


@cache
def confused() -> tuple[Matrix, list[tuple[Preset, dict[str, float]]]]:
    """Two runs of a machine with dry friction, and the fits with friction and with a dead zone."""
    whole = matrix("coulomb_friction", FRICTION, seed=5, seconds=0.5)
    few = replace(whole, runs=(whole.runs[2], whole.runs[8]))
    models = []
    for name in ("coulomb_friction", "dead_zone"):
        found, model = identify(few, Settings(effects=(name,), seed=1)), preset("qian2014", (name,))
        assert found.error["fit"] < 1.05 * NOISE
        models.append((model, {model.parameter(key).in_equations: value for key, value in found.values.items()}))
    return few, models


def question(models: list[tuple[Preset, dict[str, float]]]) -> Rivals:
    """Which of these models it is."""
    return Rivals(tuple(models), NOISE)


@cache
def proposed() -> Experiment:
    """The run that tells them apart."""
    few, models = confused()
    return propose(question(models), few, seed=7)


def recorded(experiment: Experiment, seed: int) -> Run:
    """What the machine with the friction does in a run, by the independent reference."""
    s, u = experiment.specimen, experiment.command()
    cell = linear.Cell(s.mass, s.stiffness, s.damping, experiment.gain)
    x = reference.respond(linear.Plant(), reference.named({"coulomb_friction.Fc": FRICTION}), cell, u).displacement
    x = x + NOISE * x.std() * np.random.default_rng(seed).standard_normal(len(x))
    return Run(
        f"new-{seed}",
        "",
        experiment.sample_rate,
        {"command": u, "displacement": x},
        specimen=s,
        gain=experiment.gain,
        kind="other",
    )


@cache
def apart(*added: Run) -> float:
    """χ² by which the wrong model fits worse than the right one with these runs added, both refitted."""
    few, models = confused()
    more = replace(few, runs=(*few.runs, *added))
    left = []
    for model, values in models:
        space = search_space(model, more, Settings(), excited_band(more.runs))
        fitness = SimulatedFitness(model, more, more.runs, 500.0, space)
        start = space.point(values)
        _, here = fitness.optimum(start, Way(converged=1e-6))
        left.append(
            sum(m.gram[-1, -1] / (NOISE * r.measured.std()) ** 2 for m, r in zip(here.runs, more.runs, strict=True))
        )
    return left[1] - left[0]


def separation(experiment: Experiment, seed: int) -> float:
    """What a run of the reference adds to that, in standard deviations."""
    return float(np.sqrt(max(apart(recorded(experiment, seed)) - apart(), 0.0)))


@pytest.mark.full
def test_the_proposed_run_separates_confused_models():
    """Friction and dead zone after two runs: the proposal tells them apart, three times better than the median run."""
    few, models = confused()
    proposal, everything = propose(question(models), few), ranked(question(models), few)
    others = [worth.experiment for worth in everything[5 :: len(everything) // 5]]
    typical = float(np.median([separation(other, 10 + i) for i, other in enumerate(others)]))
    found = separation(proposal, 1)
    assert proposal.so_far < 4 < proposal.separation
    assert found > 3 * max(typical, 1.0)
    assert found == pytest.approx(proposal.separation, rel=0.5)
    assert "coulomb_friction and dead_zone" in proposal.text


def test_the_proposal_is_the_same_again_and_fits_the_bench():
    """Specimen and gain of the matrix, amplitude at most 1.5 times its largest, the command as promised."""
    few, models = confused()
    proposal = proposed()
    assert proposal == propose(question(models), few, seed=7)
    assert proposal.specimen in {run.specimen for run in few.runs}
    assert 5 <= proposal.gain <= 10
    largest = max(np.sqrt(np.mean(run.command**2)) for run in few.runs)
    assert proposal.amplitude <= 1.51 * largest
    command = proposal.command()
    assert np.sqrt(np.mean(command**2)) == pytest.approx(proposal.amplitude)
    assert command[0] == command[-1] == 0
    assert np.array_equal(command, proposal.command())


def test_no_command_leaves_the_stroke():
    """A short stroke takes the large amplitudes away."""
    few, _ = confused()
    short = replace(few, actuator=replace(few.actuator, stroke=0.01))
    peaks = [np.abs(e.command()).max() for e in candidate_runs(short, 500.0)]
    free = [np.abs(e.command()).max() for e in candidate_runs(few, 500.0)]
    assert peaks
    assert max(peaks) <= 0.0045 < max(free)


def test_with_one_model_the_run_teaches_the_parameters():
    """Fisher information: the promised share of the standard errors is left when the run is added."""
    few, models = confused()
    (model, values), proposal = models[0], propose(question(models[:1]), few)
    assert proposal.separation is None
    assert proposal.information == pytest.approx(max(w.information for w in ranked(question(models[:1]), few)))
    more = replace(few, runs=(*few.runs, recorded(proposal, 3)))
    before, after = (
        np.sqrt(np.diag(np.linalg.inv(Rival(model, values, data, 500.0, lambda size: NOISE * size).information)))
        for data in (few, more)
    )
    promised = np.array(list(proposal.std_errors.values()))
    assert after / before == pytest.approx(promised, abs=0.1)
    assert promised.min() < 0.8


@pytest.fixture(scope="module")
def diagnosis() -> dict:
    """The JSON of a diagnosis that cannot tell the two apart, as far as it is read."""
    _, models = confused()
    candidates_ = [
        {
            "effect": model.effects[0].name,
            "parameters": {name.replace("__", "."): {"value": value} for name, value in values.items()},
        }
        for model, values in models
    ]
    group = [entry["effect"] for entry in candidates_]
    return {
        "model": "qian2014",
        "noise_floor": {"fit": NOISE, "verify": None},
        "candidates": candidates_,
        "ladder": [],
        "verdict": {"effects": [], "indistinguishable": [group]},
    }


def test_a_diagnosis_says_what_is_in_question(diagnosis):
    """The group that it cannot tell apart, with its values; its noise floor."""
    again = competing_models(Diagnosis.from_json(json.loads(json.dumps(diagnosis))))
    _, models = confused()
    assert [(m.effects, v) for m, v in again.models] == [(m.effects, v) for m, v in models]
    assert again.noise == NOISE


def test_what_a_diagnosis_settled_on_is_not_in_question(diagnosis):
    """Then the next run is to teach the parameters of the last step."""
    step = {"added": diagnosis["candidates"][0]["effect"], "parameters": diagnosis["candidates"][0]["parameters"]}
    verdict = {"effects": [step["added"]], "indistinguishable": [], "unexplained": False}
    again = competing_models(Diagnosis.from_json(diagnosis | {"ladder": [step], "verdict": verdict}))
    assert [model.effects[0].name for model, _ in again.models] == [step["added"]]


def test_the_command_writes_the_signals(servoident, diagnosis, tmp_path):
    """CSV and MAT hold the same command; a file that is no diagnosis is refused."""
    (tmp_path / "d.json").write_text(json.dumps(diagnosis))
    few = linear.write(
        tmp_path / "matrix",
        linear.measure_all(linear.Plant(), linear.trials()[2:9:6], seconds=0.5, noise=NOISE, seed=1),
        "linear",
        linear.Plant(),
    )
    done = servoident("next", few, "--diagnosis", tmp_path / "d.json", "--out", tmp_path / "out", "--json", "-")
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    rows = np.loadtxt(tmp_path / "out" / "command.csv", delimiter=",", skiprows=1)
    mat = scipy.io.loadmat(tmp_path / "out" / "command.mat")
    assert np.allclose(rows[:, 1], mat["command"][:, 0], atol=1e-9)
    assert 1e-3 * np.sqrt(np.mean(rows[:, 1] ** 2)) == pytest.approx(told["amplitude"], rel=1e-6)
    (tmp_path / "d.json").write_text('{"candidates": [1]}')
    refused = servoident("next", few, "--diagnosis", tmp_path / "d.json", "--out", tmp_path / "out")
    assert (refused.returncode, "not the JSON of a diagnosis" in refused.stderr) == (2, True)


def test_a_run_with_a_doubted_label_does_not_say_what_the_bench_can_do():
    """It is left out, unless nothing to fit would be left."""
    few, _ = confused()
    names = [run.id for run in few.runs]

    def trusted(*doubted: str) -> list[str]:
        said = {"candidates": [], "verdict": {"suspects": [{"run": run} for run in doubted]}}
        return [run.id for run in competing_models(Diagnosis.from_json(said)).trusted(few).runs]

    assert trusted(names[0]) == names[1:]
    assert trusted(*names) == names
    assert trusted() == names


def test_a_slow_machine_gets_a_run_of_as_many_samples():
    """A sample in four seconds: no experiment of a minute would show anything."""
    rng = np.random.default_rng(3)
    channels = {"command": np.repeat(rng.uniform(-1, 1, 128), 8), "displacement": rng.standard_normal(1024)}
    slow = Matrix(Actuator("TANKS"), (Run("one", "", 0.25, channels, {"command": "V", "displacement": "m"}),))
    found = list(candidate_runs(slow, 0.1))
    assert found
    assert {round(experiment.seconds) for experiment in found} == {4000}


def test_a_machine_that_was_only_stepped_gets_a_command_as_large_as_its_steps():
    def stepped(level: float) -> Run:
        channels = {"command": np.full(200, level), "displacement": level * (1 - np.exp(-0.05 * np.arange(200)))}
        return Run(f"to {level}", "", 50.0, channels, {"command": "rad", "displacement": "rad"})

    servo = Matrix(Actuator("SERVO"), tuple(map(stepped, (0.0, -0.1, 0.35))))
    found = [experiment.amplitude for experiment in candidate_runs(servo, 50.0)]
    assert min(found) > 0.01
    assert max(found) < 0.35
    assert not list(candidate_runs(replace(servo, runs=servo.runs[:1]), 50.0))


def test_where_no_run_could_be_made_that_is_said(monkeypatch):
    monkeypatch.setattr("ident.design.proposal.candidate_runs", lambda *_: iter(()))
    with pytest.raises(Unusable, match="unstable in every run that could be proposed"):
        propose(question(confused()[1]), confused()[0])


def test_a_proposal_stays_inside_the_limits_of_the_rig():
    """The speed that the models predict bounds its amplitude; played on the reference it keeps the limit."""
    few, models = confused()
    free = proposed()
    fastest = float(np.abs(np.diff(recorded(free, 3).measured)).max()) * free.sample_rate
    rig = RigLimits(speed=0.5 * fastest)
    proposal = propose(question(models), replace(few, actuator=replace(few.actuator, rig=rig)), seed=7)
    assert proposal.text.startswith("Inside the limits of the rig: speed")
    smooth = np.convolve(recorded(proposal, 3).measured, np.ones(8) / 8, "valid")
    assert np.abs(np.diff(smooth)).max() * proposal.sample_rate < rig.speed
    assert "rig" not in free.text
