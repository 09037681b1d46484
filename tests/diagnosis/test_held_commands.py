"""Of a command that is held in steps a strength in seconds goes as far as half a step, and says where it ended."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.held_command import held_command_sentence
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose
from tests.conftest import of_few_effects

RATE, HELD, LAG = 100.0, 50, 4.0


def late(delay: int, noise: float = 0.01) -> Matrix:
    """ω[k+1] = ω[k] + (1 − e^(−1/LAG)) (30 u[k − delay] − ω[k]) of held commands, and noise."""
    runs = []
    for number in range(2):
        random = np.random.default_rng([3, number])
        u = np.repeat(np.append(0.0, random.uniform(-1.5, 1.5, 24)), HELD)
        w, share = np.zeros(len(u)), -np.expm1(-1 / LAG)
        for k in range(len(u) - 1):
            w[k + 1] = w[k] + share * (30.0 * (u[k - delay] if k >= delay else 0.0) - w[k])
        w += noise * w.std() * random.standard_normal(len(w))
        channels, units = {"command": u, "velocity": w}, {"command": "V", "velocity": "rad/s"}
        runs.append(Run(f"r{number}", "", RATE, channels, units, hold="zoh", output="velocity"))
    return Matrix(Actuator("LATE"), tuple(runs))


@pytest.fixture
def with_delay(full: bool) -> Iterator[None]:
    """In the short form the delay is ranked among few effects."""
    with of_few_effects(full, "command_delay"):
        yield


def test_a_command_is_held_between_its_changes():
    (run, _) = late(1).runs
    assert run.dwell == HELD / RATE
    moved = Run("m", "", RATE, {"command": np.sin(np.arange(300.0)), "displacement": np.arange(300.0)})
    assert moved.dwell == 1 / RATE
    assert moved.driven_by("displacement").part(0, 2).dwell == 1 / RATE
    still = replace(moved, channels={**moved.channels, "command": np.ones(300)})
    assert still.dwell == 0.0


@pytest.mark.usefixtures("with_delay")
def test_a_delay_of_a_part_of_a_step_is_found():
    """Three times the inverse of the highest frequency of a step's power, which falls by 1/f² alone, were less."""
    found = diagnose(late(5), settings=Settings(model="motor"), most=1, propose=False)
    assert found.verdict.effects == ("command_delay",)
    assert found.verdict.at_bound == ()
    delay = found.ladder[-1].parameters["command_delay.delay"]
    assert delay.value == pytest.approx(5 / RATE, abs=0.1 / RATE)
    assert found.ladder[-1].error["fit"] == pytest.approx(0.01, rel=0.05)


@pytest.mark.full
@pytest.mark.usefixtures("with_delay")
def test_a_delay_of_more_than_half_a_step_is_searched_beyond_the_range_of_its_search():
    """The usual range ends at half of the time for which a command is held: 0.25 s."""
    matrix = late(27, noise=0.3)
    assert CandidateModels.of(matrix, Settings(model="motor")).floor is None
    found = diagnose(matrix, settings=Settings(model="motor"), most=1, propose=False)
    assert found.verdict.effects == ("command_delay",)
    assert found.ladder[-1].parameters["command_delay.delay"].value == pytest.approx(0.27, rel=0.01)
    assert not found.verdict.at_bound
    assert type(found).from_json(found.to_json()).verdict == found.verdict


def jittering(seed: int = 1) -> Matrix:
    """A motor of 0.3 s without any delay; a converter holds a new value at each sample, which no file states."""
    random, rate, lag = np.random.default_rng(seed), 50.0, 0.3
    u, keep = random.standard_normal(600), np.exp(-1 / rate / lag)
    w = np.zeros(len(u))
    for k in range(len(u) - 1):
        w[k + 1] = keep * w[k] + (1.0 - keep) * 30.0 * u[k]
    w += 0.005 * w.std() * random.standard_normal(len(w))
    units = {"command": "V", "velocity": "rad/s"}
    run = Run("r", "", rate, {"command": u, "velocity": w}, units, output="velocity")
    return Matrix(Actuator("HELD"), (run,))


@pytest.mark.usefixtures("with_delay")
def test_a_delay_that_a_held_command_has_is_said_to_be_one():
    found = diagnose(jittering(), settings=Settings(model="motor"), most=1, propose=False)
    assert found.verdict.effects == ("command_delay",)
    assert "ms is half of a sample interval" in found.verdict.text
    assert "state hold: zoh" in found.verdict.text


@pytest.mark.parametrize(
    ("delay", "hold", "said"),
    [(0.58, "linear", 1), (0.42, "linear", 1), (0.62, "linear", 0), (0.38, "linear", 0), (0.5, "zoh", 0)],
)
def test_a_delay_of_half_a_sample_may_be_a_command_that_was_held(delay, hold, said):
    run = SimpleNamespace(hold=hold, sample_rate=10.0, time_unit="s")
    fitted = SimpleNamespace(values={"command_delay__delay": delay / 10.0}, fitness=SimpleNamespace(runs=(run,)))
    assert len(list(held_command_sentence(fitted))) == said
