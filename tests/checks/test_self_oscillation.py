"""Oscillations that a loop makes by itself, against loops of a reference: limit_cycle_reference.py."""

from __future__ import annotations

import numpy as np
import pytest

from ident.checks.check import check
from ident.checks.self_oscillation import self_oscillation
from ident.matrix import Actuator, Matrix
from ident.run import Run
from tests.checks import limit_cycle_reference as reference

LIGHT = {"m": 18.9, "c": 50.0, "Cl": 1e-12}
"""A cylinder with little damping, whose oil column runs into a limit cycle of 48 Hz."""
RATE = 512.0


def run_of(command, displacement, name="run") -> Run:
    units = {"command": "m", "displacement": "m"}
    return Run(name, "", RATE, {"command": command, "displacement": displacement}, units)


def peak(signal) -> float:
    """The frequency of the largest line above 20 Hz, from the transform padded to sixteen times the length."""
    n = 16 * len(signal)
    power = np.abs(np.fft.rfft(signal * np.hanning(len(signal)), n))
    power[: int(20 * n / RATE)] = 0.0
    return float(np.argmax(power) * RATE / n)


def test_three_gains_past_a_limit_cycle_are_recognised():
    """Gains 6, 12 and 24 of a valve that opens only so far: `check` says 48 Hz of each, as an error."""
    gains, rng = np.array([6.0, 12.0, 24.0]), np.random.default_rng(56)
    command = reference.noise(rng, 2048, RATE, 2e-4)
    shown = reference.simulate(LIGHT, gains, command, RATE, opening=1e-2)
    runs = tuple(run_of(command, y, f"Kp {gain:g}") for gain, y in zip(gains, shown.T, strict=True))
    for run in runs:
        found = self_oscillation(run)
        assert found.frequency == pytest.approx(peak(run.measured), rel=0.02)
        assert found.frequency == pytest.approx(48.0, rel=0.02)
        assert found.growth == 0
    said = [one for one in check(Matrix(Actuator("A"), runs)) if one.code == "self-oscillation"]
    assert {one.run for one in said} == {run.id for run in runs}
    assert {one.severity for one in said} == {"fault"}


def test_an_output_that_stands_does_not_oscillate():
    """A servo that has arrived, in counts of its encoder: what is left beside its mean are last digits."""
    target, count = 10000.0 * (np.arange(512) > 100), np.zeros(512)
    for k in range(1, 512):
        count[k] = np.round(count[k - 1] + 0.2 * (target[k - 1] - count[k - 1]))
    assert np.ptp(count[256:]) == 0
    for name, signal in (("arrived", count), ("never moved", np.full(512, 0.1))):
        assert self_oscillation(run_of(target, signal, name)) is None


def test_a_mode_that_grows_has_its_frequency_and_growth():
    """Those of the pole of the loop, whose valve opens as far as it is asked to."""
    command = reference.noise(np.random.default_rng(57), 1024, RATE, 1e-4)
    shown = reference.simulate(LIGHT, np.array([5.0]), command, RATE)[:, 0]
    found, pole = self_oscillation(run_of(command, shown)), max(reference.poles(LIGHT, 5.0), key=lambda s: s.real)
    assert found.frequency == pytest.approx(abs(pole.imag) / (2 * np.pi), rel=0.02)
    assert found.growth == pytest.approx(pole.real, rel=0.05)


def test_nothing_is_said_of_stable_loops(full):
    """Seed 58: every fourth has less than 3 dB; noise, sines, squares and saws; valves that saturate."""
    rng, count, n = np.random.default_rng(58), 200 if full else 12, 4096 if full else 2048
    loops = [stable(rng, 4 if number % 4 else 0.2) for number in range(count)]
    commands = np.array([command(rng, n, number) for number in range(count)]).T
    gains = np.array([gain for _, gain in loops])
    values = {name: np.array([of[name] for of, _ in loops]) for name in reference.TABLE_4}
    opening = gains * rng.choice([5e-4, 1e-2], count)
    shown = reference.simulate(values, gains, commands, RATE, opening)
    shown += 0.01 * shown.std(axis=0) * rng.standard_normal(shown.shape)
    found = [self_oscillation(run_of(u, y)) for u, y in zip(commands.T, shown.T, strict=True)]
    assert found == [None] * count


@pytest.mark.parametrize("form", ["sine", "step"])
def test_twenty_periods_show_a_limit_cycle_about_which_the_command_is_silent(form):
    """Seed 59: a gain past stability under a slow command; the frequency is that of the largest line."""
    rng, n = np.random.default_rng(59), 360
    t = np.arange(n) / RATE
    u = 1e-3 * (np.sin(2 * np.pi * 2.0 * t) if form == "sine" else (t > 0.02))
    shown = reference.simulate(LIGHT, np.array([14.0]), u, RATE, opening=1e-2)[:, 0]
    shown += 0.01 * shown.std() * rng.standard_normal(n)
    run = run_of(u, shown)
    assert self_oscillation(run).frequency == pytest.approx(peak(run.measured[n // 2 :]), rel=0.02)
    calm = reference.simulate(LIGHT, np.array([1.0]), u, RATE, opening=1e-2)[:, 0]
    assert self_oscillation(run_of(u, calm + 0.01 * calm.std() * rng.standard_normal(n))) is None


def test_a_multiple_of_a_periodic_command_is_driven_and_what_lies_between_two_is_not():
    """Seed 60: orders 2 to 39 of 4 to 40 periods; all but one in fifty of each are told right."""
    rng, wrong = np.random.default_rng(60), {0.0: 0, 0.08: 0}
    for _ in range(40):
        periods, order = rng.uniform(4.0, 40.0), int(rng.integers(2, 40))
        n = int(max(600, periods * order * rng.uniform(6.0, 12.0)))
        turn, noise = 2 * np.pi * periods * np.arange(n) / n, 10 ** rng.uniform(-3.0, -1.5) * rng.standard_normal(n)
        for off in wrong:
            shown = 0.3 * np.sin(turn - 0.3) + np.sin((order + off) * turn + 1.0) + noise
            said = self_oscillation(run_of(np.sin(turn), shown)) is not None
            wrong[off] += said != (off > 0)
    assert max(wrong.values()) <= 1


def test_an_oscillation_is_seen_beside_a_slow_motion_three_times_as_large():
    """Seed 61: 40 cycles on four cycles of a sine; a tenth of the motion is a ripple, of which nothing is said."""
    rng, turn = np.random.default_rng(61), 2 * np.pi * np.arange(600) / 600
    slow, quick, noise = np.sin(4.3 * turn), np.sin(40.7 * turn), 0.005 * rng.standard_normal(600)
    found = self_oscillation(run_of(slow, slow + quick / 3 + noise))
    assert found.frequency == pytest.approx(40.7 * RATE / 600, rel=0.002)
    assert self_oscillation(run_of(slow, slow + quick / 10 + noise)) is None


def stable(rng, least):
    """A loop, many with little damping, and its gain, `least` to 3 or 12 dB below that which loses stability."""
    spread = {name: rng.uniform(0.6, 1.4) for name in reference.TABLE_4} | {"c": 10 ** rng.uniform(-2, 0)}
    of = {name: value * spread[name] for name, value in reference.TABLE_4.items()}
    of["m"], of["Cl"] = of["m"] * rng.choice([1.0, 4.0]), of["Cl"] * 10 ** rng.uniform(-1, 0)
    low, high = 1e-3, 1e3
    for _ in range(40):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if reference.poles(of, middle).real.max() < 0 else (low, middle)
    return of, low * 10 ** (-rng.uniform(least, 3.0 if least < 3 else 12.0) / 20)


def command(rng, n, number):
    """Noise every second time; else a sine, a square or a saw, 1 mm."""
    turns = rng.uniform(0.5, 20.0) * np.arange(n) / RATE
    if number % 2 == 0:
        return reference.noise(rng, n, RATE, 1e-3)
    form = rng.choice(3)
    return 1e-3 * (np.sin(2 * np.pi * turns), np.sign(np.sin(2 * np.pi * turns / 5)), 2 * (turns / 5 % 1) - 1)[form]
