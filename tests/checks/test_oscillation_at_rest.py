"""A machine that swings by itself while its inputs rest is recognised, with its frequency and its growth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.checks.self_oscillation import self_oscillating, self_oscillation
from ident.run import Run

RATE = 500.0
T = np.arange(3000) / RATE
STEP = np.where(T < 0.5, 0.0, 1.0)


def record(swings: np.ndarray, command: np.ndarray = STEP, **stated: float) -> Run:
    """The command followed at once, with what swings after the step, and noise."""
    y = STEP + np.where(T < 0.5, 0.0, swings) + np.random.default_rng(0).normal(0.0, 0.005, len(T))
    return Run(
        "loop", "", RATE, {"command": command, "displacement": y}, {"command": "m", "displacement": "m"}, **stated
    )


@pytest.mark.parametrize("growth", [0.0, 0.6])
def test_what_swings_by_itself_has_its_frequency_within_2_percent_and_its_growth(growth):
    run = record(0.02 * np.exp(growth * T) * np.sin(2 * np.pi * 12.3 * T), gain=7.0)
    found = self_oscillation(run)
    assert found.frequency == pytest.approx(12.3, rel=0.02)
    assert found.growth == pytest.approx(growth, abs=0.05)
    assert "Reduce the gain" in next(self_oscillating(run)).text
    assert found.to_json()["frequency"] == found.frequency


@pytest.mark.parametrize(
    ("swings", "command"),
    [
        (0.1 * np.exp(-0.4 * T) * np.sin(2 * np.pi * 12.3 * T), STEP),  # rings down
        (0.1 * np.sin(2 * np.pi * 12.3 * T), STEP + 0.1 * np.sin(2 * np.pi * 12.3 * T)),  # follows
        (0.02 * np.sin(2 * np.pi * 50.0 * T), STEP),  # picked up from the mains
        (np.random.default_rng(1).normal(0.0, 0.3, len(T)), STEP),  # noise
        (0.0 * T, STEP),
    ],
)
def test_what_an_input_or_the_mains_explain_and_what_dies_down_is_none(swings, command):
    assert self_oscillation(record(swings, command)) is None


def stepped(damping: float) -> Run:
    """Eight steps of other heights, 0.75 s each, of which each is answered by 4.5 periods of 6 Hz that begin anew."""
    rng, since = np.random.default_rng(2), T % 0.75
    command = np.repeat(rng.uniform(-1.5, 1.5, 8), 375)
    swings = 0.2 * np.exp(-damping * 2 * np.pi * 6.0 * since) * np.sin(2 * np.pi * 6.0 * since + command)
    y = command + swings + rng.normal(0.0, 0.003, len(T))
    units = {"command": "m", "displacement": "m"}
    return Run("steps", "", RATE, {"command": command, "displacement": y}, units)


def test_several_rests_show_an_oscillation_of_which_none_has_ten_periods():
    found = self_oscillation(stepped(0.0))
    assert found.frequency == pytest.approx(6.0, rel=0.02)
    assert found.growth == 0


@pytest.mark.parametrize("damping", [0.004, 0.03, 0.2])
def test_what_dies_down_in_each_of_several_rests_is_none(damping):
    assert self_oscillation(stepped(damping)) is None


@pytest.mark.parametrize("seed", [1, 5, 8, 9])
def test_noise_of_a_narrow_band_in_several_rests_is_no_oscillation(seed):
    """Three periods of it in each rest lie near to a straight line of phase, by chance."""
    rng = np.random.default_rng([3, seed])
    command = np.repeat(rng.uniform(-1.5, 1.5, 5), 100)
    noise = np.convolve(rng.standard_normal(len(command) + 7), np.ones(8) / 8, mode="valid")
    units = {"command": "m", "displacement": "m"}
    run = Run("steps", "", 20.0, {"command": command, "displacement": command + noise}, units)
    assert self_oscillation(run) is None


def test_the_ripple_of_what_turns_is_driven_round_and_no_oscillation():
    swings = record(0.1 * np.sin(2 * np.pi * 12.3 * T))
    turns = replace(swings, output="velocity", channels={**swings.channels, "velocity": swings.measured})
    assert self_oscillation(swings) is not None
    assert self_oscillation(turns) is None
