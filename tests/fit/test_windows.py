"""A machine that integrates disturbances is fitted over windows; the data come from recursions of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.fit.levenberg_marquardt import Way
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.settings import Settings
from ident.fit.windows import unforeseen
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import compare, diagnose, identify
from tests.short_form import short_form

RATE, GAIN, LAG = 20.0, 0.05, 0.15
MOTOR = Settings(model="motor", options={"population": 24.0, "generations": 6.0, "elite": 3.0})
"""A small search: of three parameters it needs no more."""


def cylinder(
    seed: int,
    wander: float,
    dead: float = 0.0,
    seconds: float = 120.0,
    uses: tuple[str, ...] = ("fit", "verify"),
    skew: float = 0.0,
) -> Matrix:
    """LAG q̇ + q = GAIN u, x[k+1] = x[k] + q dt + wander: exact for held commands. The noise is 0.2 mm.

    By `skew` the gain is larger one way and smaller the other.
    """
    runs = []
    for number, use in enumerate(uses):
        random = np.random.default_rng([seed, number])
        u = np.repeat(random.uniform(-1, 1, int(seconds / 1.5)), int(1.5 * RATE))
        u[:40] = 0.0
        driven = np.sign(u) * np.maximum(np.abs(u) - dead, 0.0) * (1 + skew * np.sign(u))
        decay, x, q, place = np.exp(-1 / RATE / LAG), np.zeros(len(u)), 0.0, 0.0
        for k in range(len(u) - 1):
            target = GAIN * driven[k]
            place += target / RATE + (q - target) * LAG * (1 - decay) + wander * random.standard_normal()
            q = target + (q - target) * decay
            x[k + 1] = place
        x += 2e-4 * random.standard_normal(len(u))
        channels, units = {"command": u, "displacement": x}, {"command": "V", "displacement": "m"}
        runs.append(Run(use, "", RATE, channels, units, hold="zoh", use=use))
    return Matrix(Actuator("CYLINDER"), tuple(runs))


def gain(fit) -> float:
    return fit.values["Kt"] / fit.values["c0"]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_what_an_integrator_sums_up_does_not_move_its_gain(seed):
    """Over whole runs the gain is where the disturbances took the record; its own error does not know of them."""
    matrix = cylinder(seed, wander=1e-3)
    fit = identify(matrix, MOTOR)
    assert gain(fit) == pytest.approx(GAIN, rel=0.08)  # four standard errors
    assert fit.window is not None
    assert 0.5 < fit.window.horizon < 3.0
    assert fit.window.error["fit"] < 0.5 * fit.error["fit"]
    assert fit.window.error["verify"] < 0.5 * fit.error["verify"]


@pytest.mark.parametrize("dead", short_form([0.15, 0.6], 0.6))
def test_a_fit_with_an_effect_is_made_over_the_windows_of_the_fit_without(dead):
    """One objective from the search to the result, and that of a diagnosis; a dead zone may take most of the command.

    In V of a command of 1 V at most: half of its deviation was the widest that a search allowed.
    """
    matrix = cylinder(6, wander=1e-3, dead=dead)
    plain = identify(matrix, MOTOR)
    fit = identify(matrix, replace(MOTOR, effects=("dead_zone",)))
    assert fit.window is not None
    assert plain.window is not None
    assert fit.window.horizon == plain.window.horizon
    found = fit.parameters["dead_zone.half_width"]
    assert found.value == pytest.approx(dead, abs=0.04)
    assert found.upper == pytest.approx(0.9 * max(np.abs(matrix.runs[0].command)))
    assert fit.window.error["fit"] == pytest.approx(min(fit.evolution[-1].errors), rel=0.05)
    assert fit.window.error["fit"] <= min(fit.evolution[-1].errors)


def test_a_fit_with_an_effect_is_made_over_whole_runs_where_it_needed_windows_only_without():
    """What another gain each way adds up to looked like disturbances; with it whole runs are followed to the noise."""
    matrix = cylinder(7, wander=0.0, skew=0.3)
    plain = identify(matrix, MOTOR)
    assert plain.window is not None
    assert plain.error["fit"] > 0.3
    fit = identify(matrix, replace(MOTOR, effects=("gain_asymmetry",)))
    assert fit.window is None
    assert fit.error["fit"] < 1.5 * 2e-4 / np.std(matrix.runs[0].measured)


def test_the_free_run_is_reported_with_its_interval():
    """What a machine sums up hangs on its gain for as long as the run takes."""
    fit = identify(cylinder(5, wander=1e-3), MOTOR)
    assert fit.window is not None
    (found,) = [entry for entry in fit.determined if entry.expression == "Kt / c0"]
    beside = []  # free runs whose gain is as far off as its standard error lets it be
    for deviations in (-1.96, 0.0, 1.96):
        values = fit.values | {"Kt": fit.values["Kt"] * (1 + deviations * found.std_error / found.value)}
        beside.append(identify(cylinder(5, wander=1e-3), Settings(model="motor", fixed=values)).error)
    for use in ("fit", "verify"):
        low, high = fit.window.free_run[use]
        errors = [error[use] for error in beside]
        assert low < 1.001 * errors[1] < 1.002 * high
        assert 0.7 * np.ptp(errors) < high - low < 2.0 * np.ptp(errors)
    assert type(fit).from_json(fit.to_json()).window == fit.window


def test_a_free_run_begins_where_the_record_was_measured():
    """Over windows only a bent sensor tells a first position: were that free, its curve could be any."""
    runs = []
    for run in cylinder(7, wander=1e-3).runs:
        bent, first = run.measured * (1 + 0.6 * run.measured), 300  # from the middle of a motion on
        runs.append(replace(run, channels={"command": run.command[first:], "displacement": bent[first:]}))
    matrix = Matrix(Actuator("BENT"), tuple(runs))
    right_at_zero = {"sensor_curve.end": 1e-6}  # and nowhere else
    fit = identify(matrix, replace(MOTOR, effects=("sensor_curve",), fixed=right_at_zero))
    assert fit.window is not None
    curvature = fit.parameters["sensor_curve.curvature"]
    assert curvature.std_error is not None
    assert curvature.std_error < 0.1
    assert curvature.value == pytest.approx(0.6, abs=3 * curvature.std_error)
    for compared in compare(matrix, fit).runs:
        assert compared.modelled[0] == pytest.approx(compared.run.measured[0], abs=2e-3)  # ten times the noise
        assert compared.rmse == pytest.approx(fit.rmse[compared.run.use], rel=1e-3)


def test_a_free_run_that_goes_astray_has_no_interval(monkeypatch):
    monkeypatch.setattr(NormalMatrices, "errors_beside", lambda _, steps: np.full(len(steps), np.nan))
    fit = identify(cylinder(5, wander=1e-3), MOTOR)
    assert fit.window is not None
    assert fit.window.free_run == {}


def test_without_disturbances_the_whole_run_is_fitted():
    fit = identify(cylinder(4, wander=0.0), MOTOR)
    assert fit.window is None
    assert gain(fit) == pytest.approx(GAIN, rel=2e-3)
    assert "window" not in fit.to_json()


@pytest.mark.parametrize("seed", [1, 2])
def test_windows_over_which_a_record_but_goes_on_are_none(seed):
    """A speed that wanders, whatever is commanded: over 0.8 s any model looked right to some per cent."""
    runs = []
    for number, use in enumerate(("fit", "verify")):
        random = np.random.default_rng([seed, number])
        u = np.repeat(random.uniform(-1, 1, 80), 30)
        decay = np.exp(-1.0 / RATE / 2.0)
        speed = scipy.signal.lfilter([1.0], [1.0, -decay], 1e-2 * random.standard_normal(len(u)))
        x = np.cumsum(speed) / RATE + 1e-4 * random.standard_normal(len(u))
        channels, units = {"command": u, "displacement": x - x[0]}, {"command": "V", "displacement": "m"}
        runs.append(Run(use, "", RATE, channels, units, hold="zoh", use=use))
    fit = identify(Matrix(Actuator("ANY"), tuple(runs)), MOTOR)
    assert fit.window is None
    assert fit.error["fit"] > 0.8


def test_the_error_over_windows_is_counted_from_where_each_was_measured():
    matrix = cylinder(5, wander=1e-3)
    fit = identify(matrix, MOTOR)
    family = CandidateModels.of(matrix, MOTOR, horizon=fit.window.horizon)
    start = {family.preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    refit = family.refit((), start)
    assert refit.error == pytest.approx(fit.window.error["fit"], rel=1e-3)
    assert refit.fitness.errors(refit.point[None])[0] == pytest.approx(refit.error, rel=1e-6)
    (run,) = family.runs
    e = run.measured - refit.fitness.outputs(refit.point)[run.id]
    n = round(fit.window.horizon * RATE)
    parts = np.concatenate([e[k : k + n] - e[k] for k in range(0, len(e), n)])
    assert np.sqrt(np.mean(parts**2)) / run.measured.std() == pytest.approx(refit.error, rel=1e-6)


@pytest.mark.parametrize("seed", [1, 2])
def test_no_window_begins_in_the_free_run_of_one_fold_and_ends_in_that_of_another(seed):
    """A cart moves between two limits, and each window starts with a speed of its own. Three parameters that are fitted
    to 2,000 samples predict other data as well as these.

    The free runs of two folds end metres apart. A window across two folds saw their distance as a jump.
    """
    random, rate, x, v, push = np.random.default_rng(seed), 100.0, np.zeros(2000), 0.0, 1.0
    u = np.zeros(len(x))
    for k in range(len(x) - 1):
        push = -push if push * x[k] > 0.1 else push
        u[k] = push
        x[k + 1] = x[k] + v / rate + 0.25 * u[k] / rate**2
        v += 0.5 * (u[k] - v) / rate + 3e-3 * random.standard_normal()
    x += 2e-4 * random.standard_normal(len(x))
    channels, units = {"command": u, "displacement": x}, {"command": "V", "displacement": "m"}
    matrix = Matrix(Actuator("CART"), (Run("r", "", rate, channels, units, hold="zoh"),))
    refit = CandidateModels.of(matrix, MOTOR, (), 0.3, 0.05).refit((), {"m0": 1.0, "c0": 0.5, "Kt": 0.5})
    assert refit.held_out.error < 1.05 * refit.error


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_a_dead_zone_is_found_below_the_disturbances():
    """In whole runs it takes nothing off an error of tens of per cent. Friction of a load without mass is the same."""
    found = diagnose(cylinder(6, wander=1e-3, dead=0.2), settings=MOTOR, most=1)
    assert found.horizon is not None
    best = found.candidates[0]
    assert "dead_zone" in {best.effect, *best.group}
    assert found.ladder[-1].nats > 2 * EVIDENCE_CRITERIA.least_gain
    width = next(c for c in found.candidates if c.effect == "dead_zone").parameters["dead_zone.half_width"]
    assert width.value == pytest.approx(0.2, abs=0.03)


def test_white_noise_on_a_wandering_level_is_foreseen_but_for_its_innovations():
    """The local level's steady gain: K² / (1 − K) = q / r; the innovations' variance is r / (1 − K)."""
    random = np.random.default_rng(7)
    noise, wander = random.standard_normal(20_000), 0.3 * random.standard_normal(20_000)
    ratio = 0.09
    k = (-ratio + np.sqrt(ratio**2 + 4 * ratio)) / 2
    assert unforeseen(noise + np.cumsum(wander)) == pytest.approx(1 / (1 - k), rel=0.03)
    assert unforeseen(noise) == pytest.approx(1.0, rel=0.03)
    assert unforeseen(np.cumsum(wander)) == pytest.approx(0.09, rel=0.03)


def test_runs_of_two_lengths_and_rates_have_windows_of_one_time():
    matrix = cylinder(8, wander=1e-3)
    first = matrix.runs[0]
    short = replace(first.part(0, 1500), id="short")
    fit = identify(replace(matrix, runs=(first, short)), MOTOR)
    assert gain(fit) == pytest.approx(GAIN, rel=0.08)


def test_the_noise_floor_over_windows_has_the_noise_with_which_each_begins():
    """White noise is √2 times as large, counted from where it was at the beginning: that is the error of the truth."""
    t = np.arange(4000) / RATE
    u = sum(np.sin(2 * np.pi * f * t + f) for f in (0.05, 0.13, 0.31))
    decay, x, q, place = np.exp(-1 / RATE / LAG), np.zeros(len(u)), 0.0, 0.0
    for k in range(len(u) - 1):
        target = GAIN * u[k]
        place += target / RATE + (q - target) * LAG * (1 - decay)
        q = target + (q - target) * decay
        x[k + 1] = place
    x += 2e-4 * np.random.default_rng(1).standard_normal(len(x))
    channels, units = {"command": u, "displacement": x}, {"command": "V", "displacement": "m"}
    matrix = Matrix(Actuator("CYLINDER"), (Run("r", "", RATE, channels, units, hold="zoh"),))
    family = CandidateModels.of(matrix, MOTOR, horizon=1.0)
    assert family.floor is not None
    refit = family.refit((), {"m0": 1.0, "c0": 1 / LAG, "Kt": GAIN / LAG})
    assert refit.error == pytest.approx(family.floor, rel=0.03)
    assert family.at_floor(refit)
    whole = CandidateModels.of(matrix, MOTOR)
    assert whole.floor == pytest.approx(2e-4 / np.std(x), rel=0.05)
    assert whole.at_floor(whole.refit((), refit.values))


def test_a_first_position_that_no_window_sees_stays_in_the_record_and_the_objective_is_smooth():
    """Its share was one of rounding: kilometres within a few steps, of whose rounding the objective then was made."""
    matrix = cylinder(1, wander=1e-3)
    runs = tuple(run.part(75, run.length) for run in matrix.runs)
    assert {run.begins for run in runs} == {"moving"}
    family = CandidateModels.of(replace(matrix, runs=runs), Settings(model="open_valve"), horizon=1.0)
    fitness = family.fitness(())
    point = fitness.space.point({"m0": 1.0, "tau": 0.05, "c0": 8.0, "Ka": 1e-3, "Cl": 1e-3, "Z0": GAIN, "A": 1.0})
    for _ in range(8):
        fitness.optimum(point, Way(most=0))
    place = fitness.chain.states.index("x")
    assert all(abs(fitness.start(run)[place]) < 10 * np.abs(run.measured).max() for run in fitness.runs)
    here, step = fitness.exact(point), 1e-5
    for axis in range(len(point)):
        moved = np.eye(len(point))[axis] * step
        errors = [fitness.exact(point + side * moved, sensitivities=False).error for side in (1.0, -1.0)]
        assert (errors[0] - errors[1]) / (2 * step) == pytest.approx(here.gradient[axis], rel=1e-2, abs=1e-6)


def test_a_command_held_at_nothing_but_for_rounding_is_held():
    """Counted from its neutral a held command is rounding, of which every sample is another."""
    run = cylinder(2, wander=0.0).runs[0]
    u = run.command + 1e-15 * np.random.default_rng(0).standard_normal(run.length)
    shaken = replace(run, channels={**run.channels, "command": u})
    assert run.stands
    assert shaken.stands == run.stands
    assert shaken.dwell == run.dwell
    assert shaken.begins == run.begins
    assert replace(shaken, channels={**run.channels, "command": 1.0 + 1e-15 * u}).stepped


def moving_motor(use: str, seed: int) -> Run:
    """0.1 v' + v = u, x' = v at 20 Hz, exact for held commands; its record begins in motion, at 3 m; noise of 1 mm."""
    rng = np.random.default_rng([31, seed])
    u, x, v = np.repeat(rng.uniform(-1, 1, 60), 20), np.zeros(1200), 0.8
    x[0], held = 3.0, np.exp(-1 / RATE / 0.1)
    for k in range(len(u) - 1):
        x[k + 1] = x[k] + u[k] / RATE + 0.1 * (1 - held) * (v - u[k])
        v = u[k] + held * (v - u[k])
    channels = {"command": u, "displacement": x + 1e-3 * rng.standard_normal(len(u))}
    return Run(use, "", RATE, channels, {"command": "V", "displacement": "rad"}, hold="zoh", use=use)


def test_what_a_first_position_does_as_well_as_an_offset_is_the_first_position():
    """They move the whole record alike, and only their sum is known: a share of each would be taken for an offset."""
    matrix = Matrix(Actuator("M"), (moving_motor("fit", 1), moving_motor("verify", 2)))
    fit = identify(matrix, replace(MOTOR, effects=("coulomb_friction",)))
    assert fit.window is None
    assert fit.error["fit"] < 1e-3
    assert max(fit.error_with_mean.values()) < 1e-3


def turning_rotor(use: str, seed: int, offset: float = 0.0) -> Run:
    """0.1 v' + v = u at 50 Hz, cut out of its motion, exact for held commands; noise of 0.1 s, a tenth of the speed."""
    rng, held = np.random.default_rng([32, seed]), np.exp(-1 / 50 / 0.1)
    u = np.repeat(rng.uniform(-1, 1, 120), 10)
    v = scipy.signal.lfilter([0, 1 - held], [1, -held], u)
    noise = scipy.signal.lfilter([np.sqrt(1 - held**2)], [1, -held], rng.standard_normal(len(u)))
    channels = {"drive_force": u[200:], "velocity": (v + 0.1 * v.std() * noise + offset)[200:]}
    return Run(use, "", 50, channels, {"drive_force": "N", "velocity": "m/s"}, output="velocity", hold="zoh", use=use)


@pytest.mark.parametrize(("offset", "found", "error"), [(0.0, 0.0, 0.0985), (3.0, 2.52, 0.0968)])
def test_an_offset_that_first_states_do_nearly_as_well_is_none_unless_it_is_determined(offset, found, error):
    """A spring that is next to none lets go of a first position so slowly that it moves the whole record, too.

    Without an offset, one of twice the deviation of the speed was found, and the error with the mean was 200 %.
    """
    matrix = Matrix(Actuator("M"), (turning_rotor("fit", 1, offset),))
    fitness = CandidateModels.of(matrix, Settings(model="drive"), horizon=None).fitness(())
    (run,) = fitness.exact(fitness.space.point({"m0": 0.1, "c0": 1.0, "k0": 0.003})).runs
    assert run.error == pytest.approx(error, abs=2e-4)
    assert run.offset * matrix.runs[0].measured.std() == pytest.approx(found, abs=0.02)
