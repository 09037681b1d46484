"""Sound records of many kinds raise no doubt and no warning of NumPy; wrong records of the same kinds do."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

from ident.checks.check import check
from ident.checks.local_response import local_response
from ident.checks.response import respond
from ident.matrix import Actuator, Matrix
from ident.run import Run

from .sound_records import (
    KINDS,
    Draw,
    band,
    lag,
    levels,
    measured,
    noisy,
    one_step,
    random_noise,
    ringing,
    slow_sine,
    staircase,
    sweep,
    swing,
)


def doubts(*runs: Run) -> set[tuple[str | None, str]]:
    """Run and code of every doubt and fault."""
    return {(found.run, found.code) for found in check(Matrix(Actuator("X"), runs)) if found.severity != "note"}


@pytest.mark.parametrize("draw", KINDS, ids=lambda draw: draw.__name__)
def test_sound_records_raise_no_doubt_and_no_warning(draw: Draw, full: bool) -> None:
    """A thousand in all; in the short form thirty-two."""
    for number in range(KINDS[draw] * 10 if full else KINDS[draw] // 3):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            found = check(measured(draw, [list(KINDS).index(draw), number]))
        assert [each for each in found if each.severity != "note"] == [], number


def test_there_are_a_hundred_of_them() -> None:
    assert sum(KINDS.values()) == 100


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(
    "seen", [lambda y: y, np.abs, lambda y: np.round(50 * y) / 50], ids=["", "rectified", "coarse"]
)
def test_steps_that_are_answered_within_two_samples_are_doubted(seed: int, seen) -> None:
    """A lag of a sample, and a swing of four samples a cycle that is damped well."""
    rng = np.random.default_rng(seed)
    u = np.abs(levels(rng, 1500, 30)) + 0.5
    for clean in (lag(u, 100.0, 0.008), swing(u, 100.0, 25.0, 0.8)):
        channels = {"command": u, "velocity": seen(noisy(rng, clean, 0.005))}
        run = Run("r", "", 100.0, channels, {"command": "V", "velocity": "rad/s"}, output="velocity", hold="zoh")
        assert ("r", "sample-rate") in doubts(run)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("samples", [2.2, 4.0, 8.0])
def test_noise_with_too_few_samples_a_cycle_is_doubted(seed: int, samples: float) -> None:
    """About zero or about a level a hundred times as large, up to a command that fills the spectrum."""
    rng = np.random.default_rng(seed)
    u = band(rng, 4000, 100.0, 100.0 / samples)
    for level in (0.0, 100.0):
        channels = {"command": u + level, "velocity": noisy(rng, lag(u, 100.0, 0.03), 0.03) + level}
        run = Run("r", "", 100.0, channels, {"command": "V", "velocity": "rad/s"}, output="velocity")
        assert ("r", "sample-rate") in doubts(run)


@pytest.mark.parametrize(
    "draw", [ringing, slow_sine, one_step, staircase, random_noise, sweep], ids=lambda d: d.__name__
)
def test_an_output_that_is_the_command_once_more_is_doubted(draw: Draw) -> None:
    """The command's column taken for both, as it is, turned, or in another unit and with another zero."""
    (run, _) = measured(draw, [20, 1]).runs
    for gain, zero in ((1.0, 0.0), (-1.0, 0.0), (25.4, 3.0)):
        copy = replace(run, channels={"command": run.command, run.output: gain * run.command + zero})
        assert (run.id, "copied") in doubts(copy)


@pytest.mark.parametrize("seed", range(4))
def test_a_channel_whose_delay_is_not_that_of_its_sisters_is_doubted(seed: int) -> None:
    """Of four sound runs one lacks the three samples by which the output of the others is late."""
    rng, rate, runs = np.random.default_rng(seed), 1000.0, []
    for number, late in enumerate((3, 3, 3, 0)):
        u = band(rng, 6000, rate, 80.0)
        x = noisy(rng, swing(u, rate, 30.0, 0.7), 0.003)
        channels = {"command": u[10:], "displacement": x[10 - late : 6000 - late]}
        runs.append(Run(f"r{number}", "", rate, channels, {"command": "V", "displacement": "m"}))
    assert ("r3", "skew") in doubts(*runs)


@pytest.mark.parametrize("unit", ["m", "V"])
def test_a_white_command_is_no_rest_where_the_output_follows_or_is_of_its_size(unit: str) -> None:
    rng = np.random.default_rng(8)
    u = rng.standard_normal(4000)
    units = {"command": unit, "displacement": "m"}
    follows = Run("follows", "", 100.0, {"command": u, "displacement": lag(u, 100.0, 0.03)}, units)
    assert respond(follows) is not None
    other = replace(follows, id="other", channels={"command": u, "displacement": rng.standard_normal(4000)})
    assert (("other", "unrelated") in doubts(other)) is (unit == "m")


def test_one_step_that_is_answered_slowly_is_not_called_unrelated() -> None:
    """Two lags of 0.35 s in a record of 4 s; the same record turned round has nothing to do with its command."""
    rng, t = np.random.default_rng(3), np.arange(1000) / 250.0
    step = np.where(t >= 1.0, 0.2, 0.0)
    answer = lag(lag(step, 250.0, 0.35), 250.0, 0.35)
    run = Run(
        "slow",
        "",
        250.0,
        {"command": step, "displacement": answer},
        dict.fromkeys(("command", "displacement"), "m"),
    )
    assert ("slow", "unrelated") not in doubts(run)
    moved = band(rng, 1000, 250.0, 20.0)
    other = replace(run, channels={"command": moved, "displacement": band(rng, 1000, 250.0, 20.0)})
    assert ("slow", "unrelated") in doubts(other)


def test_a_response_is_told_only_where_the_command_has_power() -> None:
    rng, t = np.random.default_rng(9), np.arange(4000) / 100.0
    y = rng.standard_normal(4000)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert local_response(np.full(4000, 0.1), y, 100.0, 40.0) is None
        two = local_response(np.sin(2 * np.pi * 5 * t) + np.sin(2 * np.pi * 20 * t), y, 100.0, 40.0)
        empty = local_response(np.where(np.arange(4000) < 2000, 1e-200, 0.0), 1e200 * y, 100.0, 40.0)
    assert two is not None
    assert all(min(abs(f - 5), abs(f - 20)) < 0.5 for f in two.frequency)
    assert empty is None or np.isfinite(empty.gain).all()


@pytest.mark.parametrize("seen", [lambda y: y, np.abs], ids=["", "rectified"])
def test_an_answer_that_swings_back_is_not_taken_for_one_that_has_ended(seen) -> None:
    """A cycle of 12 samples is after 2 where it is after 10: more than 80 % of that, and on its way."""
    u = np.repeat(np.random.default_rng(2).permutation(np.arange(1.0, 16.0)), 200)
    y = seen(swing(u, 100.0, 100.0 / 12, 0.03))
    steps = np.flatnonzero(np.diff(u))
    whole, early = (y[steps + later] - y[steps] for later in (11, 3))
    assert np.median(early / whole) > 0.8
    run = Run("r", "", 100.0, {"command": u, "velocity": y}, {"command": "V", "velocity": "rad/s"}, output="velocity")
    assert ("r", "sample-rate") not in doubts(replace(run, hold="zoh"))


def test_a_rest_that_a_step_ends_is_no_stuck_sensor() -> None:
    """Coarse counts stand until the step and jump then by more than later, when they flicker by one."""
    u = np.where(np.arange(2000) < 100, 0.0, 3.0)
    y = (np.round(60 * lag(u, 200.0, 0.05) / 3) + ((np.arange(2000) > 140) & (np.arange(2000) % 7 == 0))) / 60
    run = Run("r", "", 200.0, {"command": u, "velocity": y}, {"command": "V", "velocity": "rad/s"}, output="velocity")
    assert ("r", "flat") not in doubts(run)
    stuck = np.sin(np.arange(2000) / 30.0)
    held = np.where((np.arange(2000) > 500) & (np.arange(2000) < 600), stuck[500], stuck)
    assert ("r", "flat") in doubts(replace(run, channels={"command": stuck, "velocity": held}))


@pytest.mark.parametrize("noise", [0.0, 1e-4])
def test_an_output_on_its_way_to_a_command_at_rest_has_no_offset(noise: float) -> None:
    rng = np.random.default_rng(5)
    u = 0.1 + noise * rng.standard_normal(2000)
    x = 0.1 + np.exp(-np.arange(2000) / 1000.0) + 1e-3 * rng.standard_normal(2000)
    run = Run("r", "", 100.0, {"command": u, "displacement": x}, {"command": "m", "displacement": "m"})
    assert ("r", "offset") not in doubts(run)
    moving = u + 0.1 * np.sin(np.arange(2000) / 50.0)
    assert ("r", "offset") not in doubts(replace(run, channels={"command": moving, "displacement": x}))
    stands_off = replace(run, channels={"command": moving, "displacement": moving + 0.43})
    assert ("r", "offset") in doubts(stands_off)


def test_a_loop_that_is_behind_its_steps_has_no_offset_and_one_that_stands_off_them_has() -> None:
    """A lag of 0.4 s after a step in 4 s is behind by a tenth of the step in the mean."""
    step = np.where(np.arange(1000) >= 250, 0.2, 0.0)
    answer = lag(step, 250.0, 0.4)
    units = dict.fromkeys(("command", "displacement"), "m")
    run = Run("r", "", 250.0, {"command": step, "displacement": answer}, units)
    for zero, expected in ((0.0, False), (0.02, True)):
        off = replace(run, channels={"command": step, "displacement": answer + zero})
        assert any(one.code == "offset" for one in check(Matrix(Actuator("X"), (off,)))) is expected
