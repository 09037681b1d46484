"""Machines whose drive has hysteresis, from a reference of its own: it is named, and play is not taken for it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.short_form import short_form

RATE, LAG, NOISE = 100.0, 0.05, 0.01
FEW = ("drive_hysteresis", "second_capacity", "command_delay", "sensor_lag", "backlash", "dead_zone", "gain_asymmetry")


def preisach(command: np.ndarray) -> np.ndarray:
    """A piezo by the model of Preisach: relays of all widths up to 4 V, those of small widths more often.

    Half of its way comes with the voltage, and half with the relays, each of which stays at one of two values.
    """
    grid = np.linspace(-4.0, 4.0, 41)
    up, down = np.meshgrid(grid, grid)
    weight = np.where(up >= down, np.exp(-(up - down) / 2.0), 0.0)
    state, way = np.full(up.shape, -1.0), []
    for u in command:
        state = np.where(u >= up, 1.0, np.where(u <= down, -1.0, state))
        way.append(np.sum(weight * state))
    relays = np.array(way)
    return 0.5 * command + 0.5 * np.std(command) * (relays - relays.mean()) / np.std(relays)


def played(command: np.ndarray) -> np.ndarray:
    """What moves behind a play of 0.5 V to each side."""
    place, way = 0.0, []
    for u in command:
        place = min(max(place, u - 0.5), u + 0.5)
        way.append(place)
    return np.array(way)


def record(drive, seed: int) -> Run:
    """Ramps between drawn voltages, 0.4 to 1.2 s each, behind a lag of 50 ms, with noise of 1 %."""
    rng = np.random.default_rng([17, seed])
    knots = np.concatenate([[0.0], np.cumsum(rng.uniform(0.4, 1.2, 40))])
    levels = np.concatenate([[0.0], rng.uniform(-3.5, 3.5, 40)])
    t = np.arange(int(knots[-1] * RATE)) / RATE
    command = np.interp(t, knots, levels)
    driven, y = drive(command), np.zeros(len(t))
    for k in range(1, len(t)):
        y[k] = driven[k] + (y[k - 1] - driven[k - 1]) * np.exp(-1.0 / RATE / LAG)
    y += NOISE * np.std(y) * rng.standard_normal(len(t))
    units, use = {"command": "V", "displacement": "1"}, "verify" if seed % 2 else "fit"
    return Run(f"run-{seed}", "", RATE, {"command": command, "displacement": y}, units, use=use)


@pytest.mark.parametrize("seed", short_form([0, 2, 4], 0))
def test_the_hysteresis_of_a_piezo_is_named(monkeypatch, seed):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("PIEZO"), (record(preisach, seed), record(preisach, seed + 1)))
    found = diagnose(records, identify(records, model="first_order"), propose=False)
    assert found.verdict.effects[0] == "drive_hysteresis"
    assert found.ladder[1].error["verify"] < 0.5 * found.ladder[0].error["verify"]


@pytest.mark.parametrize("seed", short_form([0, 2, 4], 0))
def test_play_is_not_taken_for_it(monkeypatch, seed):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("PLAY"), (record(played, seed), record(played, seed + 1)))
    found = diagnose(records, identify(records, model="first_order"), propose=False)
    assert found.verdict.effects == ("backlash",)
    assert found.ladder[-1].error["verify"] < 1.3 * NOISE
