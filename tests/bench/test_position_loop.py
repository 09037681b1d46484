"""Margins of a position loop by describing functions, against the reference's simulation of the same actuator."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
import pytest

from ident.bench.describing_function import first_harmonic
from ident.bench.model import Model
from ident.bench.position_loop import Regulator, margins, open_loop, position_loop
from ident.bench.speed_table import SpeedTable
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.workflows import identify
from tests.bench.sets import as_matrix
from tests.reference.kononykhin_reference import STROKE, Truth, _advance, full_set, scattered

NODES = tuple(np.linspace(0.02, 1.0, 50))
PERIOD = 1500  # samples
SMOOTH = Truth(dPfr=0.05, asymmetry=0.0)


def model_of(truth: Truth) -> Model:
    """The model with the values of a truth, in rated currents and SI."""
    forward, back = (tuple(1e-3 * truth.speed(side * 100 * np.array(NODES))) for side in (1.0, -1.0))
    return Model(
        truth.T,
        truth.B / 100,
        truth.I0 / 100,
        1e8 * truth.kp,
        1e6 * truth.dPfr,
        SpeedTable(forward, back, NODES),
        1e6 * truth.Ps,
        {"command_delay__delay": truth.delay},
    )


class Actuator:
    """The reference's actuator a sample at a time, its current late by the truth's delay."""

    def __init__(self, truth: Truth, step: float, current: float) -> None:
        self.truth, self.step = truth, step
        self.state = np.array([current, truth.I0, STROKE / 2, 0.0, current, 0.0])
        self.currents = deque([current] * (round(truth.delay / step) + 2), maxlen=round(truth.delay / step) + 2)

    def move(self, current: float) -> float:
        """The position (m) a step later, the current (rated currents) going there in a straight line."""
        of = self.truth
        self.currents.append(100 * current)
        _advance(
            self.state,
            self.currents[0],
            self.currents[1],
            self.step,
            of.T,
            of.B,
            of.I0,
            of.kp,
            of.dPfr,
            of.Ps,
            of.G,
            of.asymmetry,
            4 * of.nonlinearity,
            0.0,
            0.0,
            0.0,
            4,
        )
        return float(1e-3 * self.state[2])


def sine(model: Model, amplitude: float, frequency: float) -> tuple[np.ndarray, float]:
    """A period of the current that is of this amplitude at the play, about the mean at which the piston stays."""
    of = first_harmonic(model, amplitude)
    before = amplitude * abs(1 + 2j * math.pi * frequency * model.T)
    return of.bias + before * np.sin(2 * np.pi * np.arange(PERIOD) / PERIOD), before


@pytest.mark.parametrize("truth", [SMOOTH, Truth(asymmetry=0.1, I0=0.7), Truth(delay=5e-3)])
@pytest.mark.parametrize("multiple", [1.5, 3.0, 10.0])
def test_the_first_harmonic_is_that_of_the_reference(truth: Truth, multiple: float) -> None:
    """Of the position under a sine of the current, to 0.1 dB and 0.5°."""
    model, frequency = model_of(truth), 5.0
    amplitude = multiple * model.dead_space
    current, before = sine(model, amplitude, frequency)
    actuator = Actuator(truth, 1 / (frequency * PERIOD), 100 * current[0])
    position = np.array([actuator.move(one) for _ in range(8) for one in current])
    last, shift = position[-PERIOD:], position[-1] - position[-1 - PERIOD]
    angle = 2 * np.pi * (np.arange(PERIOD) + 1) / PERIOD
    seen = 2j * np.mean((last - shift * np.arange(PERIOD) / PERIOD) * np.exp(-1j * angle)) / before
    level, phase = open_loop(model, Regulator(1.0), first_harmonic(model, amplitude), np.array([2 * np.pi * frequency]))
    ratio = seen / (np.exp(level[0]) * np.exp(1j * phase[0]))
    assert abs(20 * np.log10(abs(ratio))) < 0.1
    assert abs(np.degrees(np.angle(ratio))) < 0.5


@pytest.mark.parametrize("delay", [0.0, 2e-3, 5e-3])
@pytest.mark.parametrize("multiple", [3.0, 10.0])
def test_the_loop_oscillates_at_the_gain_and_the_frequency_of_the_margin(delay: float, multiple: float) -> None:
    """Begun with that oscillation it dies out with 1 dB less of gain and grows with 1 dB more; the frequency to 5 %.

    The frequency is that of its first periods: with another amplitude it is another.
    """
    truth = SMOOTH._replace(delay=delay)
    model = model_of(truth)
    found = margins(model, Regulator(30.0), multiple * model.B)
    assert found.oscillation_gain is not None
    assert found.oscillation_frequency is not None
    assert found.gain_margin == pytest.approx(20 * math.log10(found.oscillation_gain / 30.0))
    grown, periods = [], []
    for decibel in (-1.0, 0.0, 1.0):
        gain = found.oscillation_gain * 10 ** (decibel / 20)
        current, _ = sine(model, found.amplitude, found.oscillation_frequency)
        actuator = Actuator(truth, 1 / (found.oscillation_frequency * PERIOD), 100 * current[0])
        forced = np.array([actuator.move(one) for _ in range(6) for one in current])
        middle, bias = float(np.mean(forced[-PERIOD:])), first_harmonic(model, found.amplitude).bias
        free, position = [], forced[-1]
        for _ in range(5 * PERIOD):
            position = actuator.move(bias + gain * (middle - position))
            free.append(position - middle)
        grown.append(np.ptp(free[-PERIOD:]) / np.ptp(free[2 * PERIOD : 3 * PERIOD]))
        rises = np.flatnonzero((np.array(free)[:-1] < 0) & (np.array(free)[1:] >= 0))
        periods.append(rises[1] - rises[0])
    assert grown[0] < 1.0 < grown[2]
    assert periods[1] == pytest.approx(PERIOD, rel=0.05)


def test_without_a_delay_and_a_play_no_gain_makes_it_oscillate() -> None:
    """A lag and an integration turn by less than 180°: that is said, not a large number."""
    model = model_of(SMOOTH._replace(B=1e-9, dPfr=1e-9))
    found = margins(model, Regulator(30.0), 0.1)
    assert found.gain_margin is None
    assert found.oscillation_frequency is None
    assert found.phase_margin is not None
    assert "no gain makes the loop oscillate" in found.text
    assert margins(model, Regulator(30.0, sample_time=1e-3), 0.1).gain_margin is not None


def test_within_the_dead_space_the_actuator_stands() -> None:
    model = model_of(Truth())
    found = margins(model, Regulator(30.0), 0.99 * model.dead_space)
    assert found.stands
    assert "stands" in found.text
    assert not margins(model, Regulator(30.0), 1.01 * model.dead_space).stands


@pytest.mark.parametrize("regulator", [Regulator(4.0, sample_time=4e-3), Regulator(4.0, 50.0, sample_time=4e-3)])
def test_a_sampled_regulator_answers_a_sine_with_its_first_harmonic(regulator: Regulator) -> None:
    """What it holds over many periods that are no whole number of samples long, worked out sample by sample."""
    w, fine = 2 * math.pi * 7.3, 16
    time = np.arange(20_000) * regulator.sample_time
    error = np.exp(1j * w * time)
    held = regulator.kp * error + regulator.ki * regulator.sample_time * np.cumsum(error)
    held = held - np.mean(held - regulator.kp * error) * (regulator.ki > 0)  # the sum's constant is of its beginning
    at = (np.arange(fine) + 0.5) * regulator.sample_time / fine
    seen = np.mean(held[:, None] * np.exp(-1j * w * (time[:, None] + at)))
    size, phase = regulator.response(np.array([w]))
    assert abs(seen) == pytest.approx(size[0], rel=2e-3)
    assert np.angle(seen) == pytest.approx(phase[0], abs=2e-3)


def test_a_limit_takes_of_the_gain_what_a_clipped_sine_loses() -> None:
    """A sine of twice the limit: its first harmonic behind the limit by a mean over the period."""
    model, limit = model_of(SMOOTH), 0.05
    angle = 2 * np.pi * (np.arange(100_000) + 0.5) / 100_000
    behind = 2 * np.mean(np.clip(2 * limit * np.sin(angle), -limit, limit) * np.sin(angle))
    w = np.array([2 * np.pi])
    amplitude = behind / abs(1 + 1j * w[0] * model.T)
    free, limited = (
        open_loop(model, Regulator(1.0, limit=one), first_harmonic(model, amplitude), w)[0][0] for one in (None, limit)
    )
    assert math.exp(limited - free) == pytest.approx(behind / (2 * limit), rel=1e-3)
    assert np.isnan(open_loop(model, Regulator(1.0, limit=limit), first_harmonic(model, 0.1), w)[0][0])


@pytest.mark.parametrize("wrong", [{"kp": 0.0}, {"kp": 1.0, "ki": -1.0}, {"kp": math.inf}, {"kp": 1.0, "limit": 0.0}])
def test_what_is_no_regulator_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(Unusable, match="regulator"):
        Regulator(**wrong)


def test_a_fit_tells_the_margins_of_the_machine_that_was_measured(full) -> None:
    """Of three actuators that the reference measured, their margins to 0.3 dB, the phase of the loop to 2°."""
    if not full:
        pytest.skip("half a minute: run with --full")
    for seed in (31, 32, 33):
        truth = scattered(seed)
        fit = identify(as_matrix(truth, full_set(truth, seed)), Settings(model="kononykhin"))
        true = model_of(truth)
        for multiple in (1.5, 3.0, 10.0):
            amplitude = multiple * true.dead_space
            regulator = Regulator(100.0, sample_time=2e-3)
            found, exact = position_loop(fit, regulator, [amplitude]).amplitudes[0], margins(true, regulator, amplitude)
            assert found.gain_margin == pytest.approx(exact.gain_margin, abs=0.3)
            assert found.phase_margin == pytest.approx(exact.phase_margin, abs=2.0)
