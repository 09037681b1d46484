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


def test_the_ripple_of_what_turns_is_driven_round_and_no_oscillation():
    swings = record(0.1 * np.sin(2 * np.pi * 12.3 * T))
    turns = replace(swings, output="velocity", channels={**swings.channels, "velocity": swings.measured})
    assert self_oscillation(swings) is not None
    assert self_oscillation(turns) is None
