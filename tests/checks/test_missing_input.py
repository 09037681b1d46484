"""An input that is not in the record is recognised by what the output does while the recorded inputs rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import scipy

from ident.checks.check import check
from ident.checks.missing_input import missing_inputs
from ident.matrix import Actuator, Matrix
from ident.run import Run

RATE, CYCLE, CYCLES = 20.0, 300, 8
RAISED = np.tile(np.r_[np.zeros(40), np.ones(30), np.zeros(CYCLE - 70)], CYCLES)
"""The lever that raises: once a cycle, for 1.5 s."""


def lowering(after: int) -> np.ndarray:
    """The lever that lowers, so many samples after the other was let go, each time a little later."""
    lever = np.zeros(CYCLE * CYCLES)
    for cycle in range(CYCLES):
        begin = cycle * CYCLE + 70 + after + 10 * cycle
        lever[begin : begin + 30] = -1.0
    return lever


def record(speed: np.ndarray, **channels: np.ndarray) -> Run:
    """A boom that moves at a speed, with a sensor's noise."""
    angle = np.cumsum(speed) / RATE + np.random.default_rng(0).normal(0.0, 0.003, len(speed))
    units = dict.fromkeys(channels, "1") | {"displacement": "rad"}
    return Run("loader", "loader.csv", RATE, {**channels, "displacement": angle}, units)


def test_a_boom_that_is_lowered_by_a_lever_that_is_not_recorded_misses_an_input():
    run = record(RAISED + lowering(after=60), command=RAISED)
    found = missing_inputs(run)
    assert len(found) == CYCLES
    assert found[0].start == pytest.approx(130 / RATE, abs=0.5)
    findings = [one for one in check(Matrix(Actuator("LD"), (run,))) if one.code == "missing-input"]
    assert [one.severity for one in findings] == ["doubt"]
    assert f"{CYCLES} times" in findings[0].text


def test_what_the_recorded_inputs_explain_misses_none():
    both = RAISED + lowering(after=60)
    assert missing_inputs(record(both, command=both)) == ()
    assert missing_inputs(record(both, command=RAISED, load_disturbance=lowering(after=60))) == ()


def test_an_answer_that_comes_late_misses_no_input():
    command = np.where(np.roll(RAISED, 130) > 0, -1.0, RAISED)
    assert missing_inputs(record(np.roll(command, 60), command=command)) == ()


def test_a_boom_that_sinks_whenever_its_lever_rests_misses_no_input():
    sinks = np.where(RAISED > 0, 1.0, -30.0 / (CYCLE - 30))
    assert missing_inputs(record(sinks, command=RAISED)) == ()


def test_an_oscillation_that_grows_from_rest_misses_no_input():
    t = np.arange(CYCLE * CYCLES)
    since = (t % CYCLE - 100 - 15 * (t // CYCLE)) / RATE
    envelope = np.where(since > 6.0, 0.0, np.minimum(np.exp(3.0 * (since - 2.0)), 0.5))
    swings = envelope * np.sin(8.0 * t / RATE)
    assert missing_inputs(record(RATE * np.diff(RAISED + swings, prepend=0.0), command=RAISED)) == ()


def pulses(rng: np.random.Generator, samples: int) -> np.ndarray:
    """A lever that is moved either way for 1 to 3 s, and rests for 2 to 9 s."""
    lever, at = np.zeros(samples), 40
    while at < samples:
        held, rest = (int(RATE * rng.uniform(*of)) for of in ((1.0, 3.0), (2.0, 9.0)))
        lever[at : at + held] = rng.uniform(0.4, 1.0) * rng.choice([-1.0, 1.0])
        at += held + rest
    return lever


def test_a_place_that_wanders_and_creeps_hides_no_missing_input():
    """Seed 65: a speed with a lag and a bias, integrated for 200 s; the second lever is recorded or not."""
    said = {True: 0, False: 0}
    for seed in range(20):
        rng = np.random.default_rng([65, seed])
        first, second = pulses(rng, 4000), pulses(rng, 4000)
        a = np.exp(-1.0 / RATE / rng.uniform(0.02, 0.2))
        speed = scipy.signal.lfilter([0.0, 1.0 - a], [1.0, -a], first + second) + rng.uniform(-0.04, 0.04)
        said[True] += bool(missing_inputs(record(speed, command=first)))
        said[False] += bool(missing_inputs(record(speed, command=first, load_disturbance=second)))
    assert said[True] >= 19
    assert said[False] == 0


def drawn(seed: int, second: float) -> Run:
    """A place that leaks 10 to 20 % of its way in 1 s, with a bias, 150 s; the second lever, of this share."""
    rng = np.random.default_rng([66, seed])
    lag, leak, bias = rng.uniform(0.02, 0.2), rng.uniform(0.1, 0.2), rng.uniform(-0.1, 0.1)
    first, other = pulses(rng, 3000), pulses(rng, 3000)
    a, kept = np.exp(-1.0 / RATE / lag), np.exp(-leak / RATE)
    speed = scipy.signal.lfilter([0.0, 1.0 - a], [1.0, -a], first + second * other + bias)
    place = scipy.signal.lfilter([1.0 / RATE], [1.0, -kept], speed)
    noise = 0.005 * place.std() * rng.standard_normal(len(place))
    return Run("leaks", "", RATE, {"command": first, "displacement": place + noise}, {"displacement": "m"})


def test_a_place_that_leaks_and_is_driven_in_short_turns_hides_no_missing_input():
    """Seed 66: it creeps at up to half of its speed, another speed at each place."""
    assert sum(bool(missing_inputs(drawn(seed, 0.8))) for seed in range(10)) >= 9
    assert not any(missing_inputs(drawn(seed, 0.0)) for seed in range(10))


@pytest.mark.parametrize("damping", [0.05, 0.2, 0.4])
def test_a_swing_that_stands_for_a_moment_at_each_turn_misses_no_input(damping):
    """Its last values say how it goes on, whenever it is that it was let go."""
    lever = pulses(np.random.default_rng(67), 2400)
    own, fast = np.exp((-damping + 1j * np.sqrt(1 - damping**2)) * 4.0 / RATE), 0.2
    swings = scipy.signal.lfilter([abs(1 - own) ** 2], [1.0, -2 * own.real, abs(own) ** 2], lever)
    swings = scipy.signal.lfilter([fast], [1.0, fast - 1.0], swings)
    swings = swings + 0.003 * np.random.default_rng(68).standard_normal(len(swings))
    assert missing_inputs(Run("swings", "", RATE, {"command": lever, "displacement": swings})) == ()


def test_a_thermometer_that_reads_in_wider_steps_when_hot_misses_no_input():
    """A heater under held powers; a converter of 10 bits reads the voltage of a thermistor, steps of 0.1 to 0.5 K."""
    power, t = np.repeat([0.25, 0.85, 0.5, 0.15, 1.0, 0.0], 1350), np.zeros(8100)
    for k in range(1, len(t)):
        t[k] = t[k - 1] + (60.0 * power[k - 1] - t[k - 1]) / 265.0
    kelvin = 298.0 + t
    share = np.round(1023.0 / (1.0 + np.exp(3950.0 * (1.0 / kelvin - 1.0 / 298.0)))) / 1023.0
    read = 1.0 / (1.0 / 298.0 + np.log(1.0 / share - 1.0) / 3950.0) - 298.0
    steps = np.diff(np.unique(read))
    assert steps[-1] > 3.0 * steps[0]
    assert missing_inputs(Run("heater", "", 0.5, {"command": power, "displacement": read}, hold="zoh")) == ()


def drifting(seed: int) -> Run:
    """A loop that follows twelve steps within a second and holds each for 20 s, where its place drifts by itself."""
    rng = np.random.default_rng([82, seed])
    command = np.repeat(rng.uniform(-1.0, 1.0, 12), int(20 * RATE))
    answer = scipy.signal.cont2discrete(([9.0], [1.0, 3.0, 9.0]), 1 / RATE)
    drift = scipy.signal.lfilter([1.0], [1.0, -1.96, 0.9605], rng.standard_normal(len(command)))
    place = scipy.signal.lfilter(answer[0][0], answer[1], command) + 0.04 * drift / drift.std()
    units = {"command": "rad", "displacement": "rad"}
    return Run("loop", "loop.csv", RATE, {"command": command, "displacement": place}, units, hold="zoh")


@pytest.mark.parametrize("seed", range(6))
def test_a_drift_about_where_a_command_holds_an_output_misses_no_input(seed):
    """Nine tenths of its motions are the drift, which is far slower than the answers to the command."""
    assert missing_inputs(drifting(seed)) == ()


@dataclass(frozen=True)
class Slide:
    """A mass of 1 kg under a controller, with dry friction that is larger at rest: it sticks, and slips (own truth).

    x'' = kp e + ki ∫e dt − kd x' − friction + push, e = target − x; semi-implicit Euler, 1 ms; recorded at 50 Hz.
    """

    kp: float
    ki: tuple[float, float]
    kd: float
    at_rest: tuple[float, float]
    sliding: float

    def record(self, seed: int, disturbed: bool = False) -> Run:
        rng, h, at, legs = np.random.default_rng(seed), 1e-3, 0.0, []
        for _ in range(10):
            to = at + rng.choice([-1, 1]) * rng.uniform(0.4, 1)
            moving, still = int(rng.uniform(1000, 2500)), int(8000 * rng.uniform(0.6, 1.4))
            legs += [np.linspace(at, to, moving), np.full(still, to)]
            at = to
        target = np.concatenate(legs)
        ki, most = rng.uniform(*self.ki), rng.uniform(*self.at_rest)
        push = np.zeros(len(target))
        for after in range(4000, len(target) - 2000, 7000) if disturbed else ():
            begin = after + int(rng.integers(0, 3000))
            push[begin : begin + 700] = rng.choice([-1, 1]) * (most + 10)
        x = v = summed = 0.0
        out = np.empty(len(target))
        for i in range(len(target)):
            e = target[i] - x
            summed += e * h
            force = self.kp * e + ki * summed - self.kd * v + push[i]
            if v or abs(force) > most:
                then = v + h * (force - self.sliding * most * (np.sign(v) or np.sign(force)))
                v = 0.0 if v and then * v <= 0 and abs(force) <= most else then
            x += h * v
            out[i] = x
        y = out[::20] + rng.normal(0, 1e-3, len(out[::20]))
        return Run("a", "a.csv", 50.0, {"command": target[::20], "displacement": y}, dict.fromkeys(CLOSED, "m"))


CLOSED = ("command", "displacement")
STIFF = Slide(kp=60.0, ki=(20.0, 40.0), kd=6.0, at_rest=(8.0, 14.0), sliding=0.7)
SOFT = Slide(kp=15.0, ki=(5.0, 10.0), kd=4.0, at_rest=(5.0, 8.0), sliding=0.75)


@pytest.mark.parametrize(("slide", "seed"), [(STIFF, 2), (STIFF, 7), (SOFT, 2), (SOFT, 9)])
def test_a_loop_that_hunts_misses_no_input(slide, seed):
    """It sticks away from its command, and slips towards it seconds later, as the integral of its controller says."""
    assert missing_inputs(slide.record(seed)) == ()


@pytest.mark.parametrize("seed", range(3))
def test_a_loop_that_is_pushed_away_from_its_command_misses_an_input(seed):
    slide = Slide(kp=30.0, ki=(4.0, 8.0), kd=8.0, at_rest=(0.5, 1.0), sliding=0.6)
    assert len(missing_inputs(slide.record(seed, disturbed=True))) >= 5


@pytest.mark.parametrize("noise", [0.0, 0.02, 0.3])
@pytest.mark.parametrize("late", [0, 1, 5])
def test_what_follows_its_command_at_once_does_not_set_out_before_it(noise: float, late: int) -> None:
    """A quick loop of speed: ten levels of 2 s each, there within a few samples, in the order of two seeds."""
    for seed in (1, 2):
        rng = np.random.default_rng(seed)
        levels = np.repeat(rng.permutation([14.0, 1.0, 0.5, 0.0, -0.5, -1.0, -1.6, 14.0, -14.0, 3.0]), 400)
        speed = np.concatenate([np.full(late, levels[0]), levels])[: len(levels)]
        speed = speed + noise * rng.standard_normal(len(speed))
        channels, units = {"command": levels, "velocity": speed}, {"command": "rad/s", "velocity": "rad/s"}
        assert not missing_inputs(Run("quick", "", 200.0, channels, units, hold="zoh", output="velocity"))


@pytest.mark.parametrize("seed", range(3))
def test_a_speed_that_dips_once_a_turn_misses_no_input_at_the_tops_of_a_sweep(seed: int) -> None:
    """A motor with a time constant of 5 ms and an eccentric coupling, under a swept sine of 12 V up to 3 Hz."""
    rng, rate = np.random.default_rng(seed), 2000.0
    time = np.arange(0.0, 10.0, 1 / rate)
    volts = 12.0 * scipy.signal.chirp(time, 0.2, 10.0, 3.0, phi=-90)
    fall = np.exp(-1.0 / (0.005 * rate))
    speed = scipy.signal.lfilter([17.0 * (1.0 - fall)], [1.0, -fall], volts)  # rad/s
    turn = (np.cumsum(speed) / rate + rng.uniform(0.0, 6.0) + np.pi) % (2.0 * np.pi) - np.pi
    measured = speed - 10.0 * np.sign(speed) * np.exp(-((turn / 0.3) ** 2)) + 0.3 * rng.standard_normal(len(time))
    channels, units = {"command": volts, "velocity": measured}, {"command": "V", "velocity": "rad/s"}
    assert not missing_inputs(Run("sweep", "", rate, channels, units, output="velocity"))
