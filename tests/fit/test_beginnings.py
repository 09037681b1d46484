"""How a run begins: at rest, standing elsewhere, or moving; simulated here by SciPy's own integrator.

What begins away from zero was taken for moving: its first state was free, and explained what it should not.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import odeint
from scipy.signal import lfilter

from ident.beginning import beginning
from ident.diagnosis.candidate_models import CandidateModels
from ident.fit.first_guesses import begins_about_middle, in_order, order_stays
from ident.fit.identification import Identification, completed
from ident.fit.initial_state_estimation import BestInitialState, better
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.simulated_runs import SimulatedRuns, every_run
from ident.linear import LinearModel
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.simulation.steps import FASTEST
from ident.workflows import compare, diagnose, identify
from tests.rounding import perturbed_run

RATE = 50.0
SATURATED = Settings(
    model="qian2014",
    effects=("command_limit",),
    seed=3,
    fixed={"m0": 1.0, "c0": 6.829, "Ka/A^2": 2.615e-6},
)
SERVO = {
    "Z0/A^2": 9.004,
    "tau": 0.02998,
    "m0": 1.0,
    "c0": 6.829,
    "Ka/A^2": 2.615e-6,
    "Cl/A^2": 1.805e-5,
    "command_limit.inverse_limit": 7.144,
}
"""Values of that machine, of which a search ends in one with such a c0 and Ka or another: rounding decides."""


def staircase(seed: int, first: float, lowest: float = -5.0, highest: float = 5.0) -> np.ndarray:
    """Levels of 3 s each, the first one given."""
    levels = np.random.default_rng(seed).uniform(lowest, highest, 14)
    levels[0] = first
    return np.repeat(levels, int(3 * RATE))


def run_of(command: np.ndarray, rates, start, shown: int, output: str, use: str = "fit", noise: float = 0.01) -> Run:
    """A held command into ordinary differential equations ż = rates(z, u), integrated level by level."""
    edges = [0, *(np.flatnonzero(np.diff(command)) + 1), len(command)]
    states, z = [], np.asarray(start, dtype=float)
    for begin, end in pairwise(edges):
        at = np.arange(end - begin + 1) / RATE
        found = odeint(lambda z, _, u=command[begin]: rates(z, u), z, at, rtol=1e-9, atol=1e-11)
        states.append(found[:-1])
        z = found[-1]
    record = np.concatenate(states)[:, shown]
    record = record + noise * record.std() * np.random.default_rng(len(use)).standard_normal(len(record))
    units = {"command": "V", output: {"velocity": "rad/s", "displacement": "m"}[output]}
    return Run(use, "", RATE, {"command": command, output: record}, units, hold="zoh", output=output, use=use)


def motor(seed: int, first: float, drag: float = 0.0) -> Matrix:
    """0.3 ω' + ω + drag ω|ω| = 3.5 u, which has stood under the first command for long."""

    def rates(z, u):
        return [(3.5 * u - z[0] - drag * z[0] * abs(z[0])) / 0.3]

    def standing(u: float) -> float:
        x = 3.5 * abs(u)
        return float(np.sign(u) * (x if drag == 0 else (np.sqrt(1 + 4 * drag * x) - 1) / (2 * drag)))

    runs = [
        run_of(staircase(seed + i, level), rates, [standing(level)], 0, "velocity", use)
        for i, (level, use) in enumerate(((first, "fit"), (-first, "verify")))
    ]
    return Matrix(Actuator("MOTOR"), tuple(runs))


def cylinder(seed: int, neutral: float, place: float = 0.0) -> Matrix:
    """ẋ = q, 0.1 q̇ = 0.02 (u − neutral) − q: a valve's lag and a cylinder in open loop, of any neutral."""
    runs = []
    for i, use in enumerate(("fit", "verify")):
        command = neutral + staircase(seed + i, 0.0)
        command[-int(1.5 * RATE) :] = neutral
        runs.append(
            run_of(
                command,
                lambda z, u: [z[1], (0.02 * (u - neutral) - z[1]) / 0.1],
                [place, 0.0],
                0,
                "displacement",
                use,
                0.005,
            )
        )
    return Matrix(Actuator("CYLINDER"), tuple(runs))


def test_the_three_ways_to_begin():
    first = motor(1, 3.0).runs[0]
    assert first.begins == "standing"
    assert first.stands == 150
    assert perturbed_run(first, 1).begins == "standing"  # a held command is held but for rounding
    assert perturbed_run(first, 1).stands == 150
    assert motor(1, 0.0).runs[0].begins == "at rest"
    assert first.part(155, first.length).begins == "moving"
    assert first.part(290, first.length).begins == "moving"  # it stands, but for fewer samples than a late step needs
    still = replace(
        first, channels={**first.channels, "command": first.command + 1e-2 * np.sin(np.arange(first.length))}
    )
    assert still.begins == "moving"  # a command that moves meanwhile


def test_the_jumps_of_repeated_steps_are_no_noise_that_a_beginning_hides_in():
    """It stands a fourteenth of its deviation from zero, twenty deviations of the noise; seed 4."""
    levels = np.tile([1.0, -0.05, -1.0, 0.05], 20)
    command = 0.027 * np.repeat(levels, np.tile([9, 9, 8, 9], 20))[32:]
    follows = np.full(len(command), command[0])
    for k in range(1, len(command)):
        follows[k] = follows[k - 1] + 0.5 * (command[k - 1] - follows[k - 1])
    x = follows + 6.5e-5 * np.random.default_rng(4).standard_normal(len(command))
    run = Run("a", "", RATE, {"command": command, "displacement": x}, {"command": "m"}, gain=1.0, hold="zoh")
    assert 0.06 < abs(x[0]) / x.std() < 0.08
    assert run.begins == "moving"
    assert replace(run, channels={**run.channels, "displacement": x - command[0]}).begins == "at rest"


def test_a_motor_that_runs_at_first_is_found_and_its_offset_is_nothing():
    fit = identify(motor(2, 3.0), Settings(model="motor"))
    assert fit.values["Kt"] / fit.values["c0"] == pytest.approx(3.5, rel=0.005)
    assert fit.values["m0"] / fit.values["c0"] == pytest.approx(0.3, rel=0.01)
    assert max(fit.error["fit"], fit.error["verify"]) < 0.0115
    assert abs(fit.offset["fit"]) < 0.01


def test_one_machine_stands_under_many_commands():
    """z' = −2 z + 4 u, y = 3 z, and a position that nothing holds: matrices of one point, commands of three."""
    system = np.array([[-2.0, 0.0, 4.0], [0.0, 0.0, 0.0], [3.0, 1.0, 0.0]])[:, :, None, None]
    u, y = np.array([[1.0], [2.0], [-1.0]]), np.array([[7.0], [12.0], [0.0]])
    standing = LinearModel(system).standing(u, y)
    assert standing.shape == (3, 1, 2)
    assert standing[..., 0] == pytest.approx(2.0 * u)
    assert standing[..., 1] == pytest.approx(y - 6.0 * u)


def test_a_mass_that_nothing_holds_or_brakes_stands_where_it_is():
    """v' = u, x' = v: the speed is held by no command, which a solution refuses with an error."""
    system = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])[:, :, None]
    assert LinearModel(system).standing_at(0.3)[0] == pytest.approx([0.0, 0.3])
    held = np.array([[-2.0, -4.0, 4.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])[
        :, :, None
    ]  # x'' + 2 x' + 4 x = 4 u, y = 2 x
    assert LinearModel(held).standing_at(0.3)[0] == pytest.approx([0.0, 0.15])


@pytest.mark.parametrize("first", [3.0, 0.0])
def test_search_fit_comparison_and_diagnosis_have_one_error(first):
    """Of a record of steps, whose power beyond the band of the search made it promise a fifth less."""
    matrix, settings = motor(3, first, drag=0.05), Settings(model="motor")
    work = Identification(matrix, settings)
    state = work.start()
    while not work.finished(state):
        state = work.advance(state, 50)
    fit = work.finish(state)
    assert fit.error["fit"] <= min(state["history"][-1]["errors"]) * 1.001
    family = CandidateModels.of(matrix, settings)
    start = {family.preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    assert family.refit((), start).error == pytest.approx(fit.error["fit"], rel=1e-6)
    compared = {run.run.id: run.error for run in compare(matrix, fit).runs}
    assert compared == pytest.approx({run.id: run.error for run in fit.runs}, rel=1e-6)


def test_the_standstill_of_a_nonlinear_machine_is_where_it_begins():
    """ω|ω| takes a third of the speed: begun where the linear model stands, the run would begin with a transient."""
    fit = completed(Identification(motor(4, 4.0, drag=0.05), Settings(model="motor", effects=("quadratic_damping",))))
    assert max(fit.error["fit"], fit.error["verify"]) < 0.0115
    drag = fit.parameters["quadratic_damping.coefficient"].value / fit.values["c0"]
    assert drag == pytest.approx(0.05, rel=0.02)


@pytest.mark.parametrize(("neutral", "place"), [(0.0, 0.0), (2.5, 0.0), (2.5, 0.4)])
def test_a_command_is_counted_from_where_it_is_held_while_the_cylinder_stands(neutral, place, full):
    if not place and not full:
        pytest.skip("ten seconds each: run with --full")
    matrix = cylinder(5, neutral, place)
    fit = identify(matrix, Settings(model="motor"))
    assert max(fit.error["fit"], fit.error["verify"]) < 0.01
    assert abs(fit.offset["fit"]) < 0.1
    said = [note for note in fit.notes if "counted from" in note]
    assert bool(said) is (neutral != 0)
    assert all("2.5 V" in note for note in said)


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_lag_far_below_the_sample_time_is_not_searched_and_the_diagnosis_follows_the_fit():
    """The time constant went to microseconds at a sample of milliseconds; then no simulation followed the fit."""
    matrix = motor(6, 3.0)
    quick = [
        replace(run, channels={**run.channels, "velocity": 3.5 * np.append(run.command[:1], run.command[:-1])})
        for run in matrix.runs
    ]
    for model in ("first_order", "open_valve"):
        fit = identify(replace(matrix, runs=tuple(quick)), Settings(model=model))
        assert fit.values["tau"] >= 0.99 / (FASTEST * RATE)
        found = diagnose(replace(matrix, runs=tuple(quick)), fit, most=0, propose=False)
        assert found.baseline.error["fit"] == pytest.approx(fit.error["fit"], rel=0.02, abs=1e-5)


def servo(cut: int = 0, late: int = 0, noise: float = 0.004) -> Matrix:
    """0.03 q̇ + q = 9 clip(u − x, ±0.14), ẋ = q: of limited speed, behind jumps, cut out of its motion; late samples."""
    runs = []
    for i, (size, hold) in enumerate(((0.1, 12), (0.3, 25), (0.6, 18), (0.6, 30))):
        command = np.repeat(np.where(np.arange(9) % 2, -size, size), hold)
        acts = np.concatenate([np.zeros(late), command])[: len(command)]
        run = run_of(
            acts,
            lambda z, u: [z[1], (9 * np.clip(u - z[0], -0.14, 0.14) - z[1]) / 0.03],
            [0.0, 0.0],
            0,
            "displacement",
            "fit" if i < 3 else "verify",
            noise,
        )
        channels, units = {**run.channels, "command": command}, {"command": "m", "displacement": "m"}
        run = replace(run, id=str(i), channels=channels, units=units)
        runs.append(run.part(cut + i, run.length) if cut else run)
    return Matrix(Actuator("SERVO"), tuple(runs))


@pytest.fixture(scope="module")
def saturated() -> tuple[Matrix, FitResult]:
    """A machine in saturation that moves at first, and its fit."""
    matrix = servo(9)
    return matrix, identify(matrix, SATURATED)


@pytest.mark.full
def test_a_machine_in_saturation_that_moves_at_first_is_found(saturated):
    """The linear model's first states lie hundreds of deviations off, from where no step led back: 65 to 97 % left."""
    matrix, fit = saturated
    assert {run.begins for run in matrix.runs} == {"moving"}
    assert max(fit.error["fit"], fit.error["verify"]) < 0.0044
    assert 1.0 / fit.parameters["command_limit.inverse_limit"].value == pytest.approx(0.14, rel=0.01)


@pytest.mark.parametrize("far", [-0.3, 0.3])
def test_first_states_go_on_only_while_less_is_left(saturated, far):
    """From a place that a straight step overshoots, at the machine's values, what is left falls to the noise."""
    matrix, _ = saturated
    preset = Identification(matrix, SATURATED).objective.preset
    runs = every_run(preset, matrix)
    found = {preset.parameter(name).in_equations: value for name, value in SERVO.items()}
    values = {p.in_equations: p.value for p in preset.parameters} | found
    runs.begin(values)
    for run in matrix.runs:
        runs.starts[run.id] = runs.starts[run.id] + far * (np.array(preset.chain.states) == "x")
    outputs = runs.outputs_at(values)
    assert max(np.std(runs.left(run, outputs[run.id])) / np.std(run.measured) for run in matrix.runs) < 0.0044


def test_of_two_guesses_the_one_that_leads_to_less_counts(saturated, monkeypatch):
    """From a place off the first, and the better one behind it."""
    matrix, _ = saturated
    preset = Identification(matrix, SATURATED).objective.preset
    found = {preset.parameter(name).in_equations: value for name, value in SERVO.items()}
    values = {p.in_equations: p.value for p in preset.parameters} | found
    guessed, place = SimulatedRuns._guesses, np.array(preset.chain.states) == "x"
    for first in (-0.45, -0.3, -0.25):
        monkeypatch.setattr(
            SimulatedRuns, "_guesses", lambda *of, off=first: [guessed(*of)[0] + off * place, guessed(*of)[0]]
        )
        runs = every_run(preset, matrix)
        outputs = runs.outputs_at(values)
        assert max(np.std(runs.left(run, outputs[run.id])) / np.std(run.measured) for run in matrix.runs) < 0.0044


def test_of_two_guesses_that_lead_as_far_the_one_without_an_offset_counts():
    """In saturation a position that is shifted changes nothing else; less of the record left comes first."""

    def end(left: float, offset: float) -> BestInitialState:
        blocks = np.array([[[1.0, 0.0], [0.0, left]]])
        return BestInitialState(
            np.zeros(1),
            NormalMatrices(np.zeros((1, 1)), np.zeros((1, 0)), 1.0, offset, blocks=blocks, remove=np.ones((2, 1))),
        )

    for ends, which in (
        ([end(0.01, 0.9), end(0.01 * (1 + 1e-9), -0.1)], 1),
        ([end(0.01, 0.9), end(0.02, 0.1)], 0),
        ([end(-1e-18, 0.0), end(0.02, 0.0)], 0),  # rounding of a record that nothing is left of
    ):
        assert better(ends) is ends[which]


def test_few_samples_a_second_show_that_a_machine_stood_before_its_command_jumped():
    """The third sample is its answer already."""
    assert {run.begins for run in servo(late=1, noise=0.0).runs} == {"at rest"}
    assert {run.begins for run in servo(late=1, noise=0.0005).runs} == {"at rest"}
    assert {run.begins for run in servo(5, late=1, noise=0.0).runs} == {"moving"}


def test_first_states_are_followed_where_what_they_promise_is_worth_it(saturated):
    """From a place off, where the model is not straight: what is left falls only where they are followed."""
    matrix, _ = saturated
    fitness = CandidateModels.of(matrix, SATURATED).fitness(("command_limit",))
    known = {p.in_equations: p.value for p in fitness.preset.parameters}
    found = {fitness.preset.parameter(name).in_equations: value for name, value in SERVO.items()}
    point = fitness.space.point({**known, **found, **fitness.space.fixed})

    def off(trusting: bool) -> SimulatedFitness:
        begun = replace(fitness.fresh(fitness.runs), trusting=trusting)
        begun.begin({name: float(value[0]) for name, value in begun.space.values(point[None]).items()})
        place = 0.3 * (np.array(begun.chain.states) == "x")
        return replace(begun, starts={run: start - place for run, start in begun.starts.items()})

    followed = off(True).exact(point).error
    assert followed < 0.0044
    assert off(True).exact(point, worth=lambda _promised: False).error > 2 * followed
    assert off(True)._better(point, 2 * followed) is None
    assert off(False)._better(point, 2 * followed) is not None


def test_a_motion_that_is_given_by_its_speed_is_guessed_to_go_about_the_middle():
    """A sine, from a phase of one radian."""
    speed = np.cos(0.1 * np.arange(400.0) + 1.0)
    assert begins_about_middle(speed) == pytest.approx(np.sin(1.0) / 0.1, rel=0.01)


def test_guesses_are_simulated_until_the_rest_of_the_record_cannot_change_their_order():
    """Two that lie 1e-9 apart come no nearer, and change what each leaves by no more than what the gap is."""
    rest = np.ones(100)
    together = np.array([[1.0, 1.0 + 1e-9]])
    assert order_stays(np.array([2.0, 1.0]), together, rest)
    assert order_stays(np.array([1.0, 1.0 + 4.2e-7]), together, rest)
    assert not order_stays(np.array([1.0, 1.0 + 3.8e-7]), together, rest)
    assert not order_stays(np.array([2.0, 1.0]), np.array([[1.0, 1.1]]), rest)


def test_the_same_guesses_and_those_that_ran_away_stay_in_their_order():
    same, rest = np.ones((1, 2)), np.ones(100)
    assert order_stays(np.array([1.0, 1.0]), same, rest)
    assert list(in_order(np.array([np.inf, 3.0, np.nan, 2.0]))) == [3, 1, 0, 2]
    assert order_stays(np.array([np.inf, np.nan]), np.full((1, 2), np.nan), rest)
    assert order_stays(np.array([1.0, np.inf]), np.array([[1.0, np.inf]]), rest)


def test_where_a_specimen_stands_is_not_told_by_a_force_of_nothing():
    """It may stand anywhere, where its speed alone was recorded: beside a stop or in the middle of its play."""
    motion = np.append(np.zeros(20), np.sin(0.3 * np.arange(50.0)))
    recorded = {"velocity": motion, "force": motion}
    for channels, begins in ((recorded, "moving"), (recorded | {"displacement": motion}, "at rest")):
        run = Run("r", "", 100.0, channels, output="force").driven_by("velocity")
        assert run.begins == begins


@pytest.mark.parametrize(("counts", "begins"), [(1, "at rest"), (5, "moving")])
def test_a_reading_that_stands_at_a_count_of_its_encoder_is_at_rest(counts, begins):
    """The first count of an encoder is as near to zero as it can tell; five of its counts are another place."""
    time = np.arange(2000) / 500.0
    encoder = np.round(40.0 * np.sin(2 * np.pi * np.maximum(time - 0.1, 0.0))) + counts
    assert beginning(encoder, np.sin(2 * np.pi * time), 500.0) == begins


@pytest.mark.parametrize(("drift", "begins"), [(0.0, "standing"), (0.04, "moving")])
def test_what_drifts_beyond_its_noise_does_not_stand(drift, begins):
    """A level under a command that is held for 18 samples, before it moves as it does later; seeds 67, 1 to 20.

    That it scatters about its means because it moves is no reason to take it for standing: of twenty at most two are.
    """
    found = []
    for seed in range(1, 21):
        rng = np.random.default_rng([67, seed])
        later = lfilter([1.0], [1.0, -1.9, 0.9025], rng.standard_normal(600))
        x = np.concatenate([drift * np.linspace(0, 1, 18) ** 2, later / later.std()])
        command = np.repeat(rng.uniform(1.0, 3.0, 103), 6)[:618]
        command[:18] = command[0]
        found.append(beginning(5.0 + x + 0.003 * rng.standard_normal(618), command, 100.0))
    assert found.count(begins) >= 18
