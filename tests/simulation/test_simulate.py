"""Runs and vectors side by side: each reads its own command, as late as its own delay, and its own measured force."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ident.chain.conditions import conditions
from ident.fit import simulated_runs
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import Space
from ident.matrix import Actuator, Matrix
from ident.preprocessing import prepare
from ident.presets import Preset, preset
from ident.run import Run
from ident.simulation.kernel import Kernel
from ident.simulation.simulate import Simulation
from tests.reference import measured_load_reference as reference
from tests.reference import qian_reference as linear

PLANT = linear.Plant()
ACTUATOR = Actuator("A", piston_area=PLANT.A)
SAMPLES, REST, FENCE = 96, 8, 4096
GAINS = (7.0, 5.0, 10.0, 6.0)


@pytest.fixture(scope="module", autouse=True)
def _fenced() -> Iterator[None]:
    """No value stands before or behind the inputs that a kernel is handed: what it reads there shows in its output."""

    def fenced(record: np.ndarray) -> np.ndarray:
        return np.pad(record, FENCE, constant_values=np.nan)[FENCE:-FENCE]

    def advance(kernel: Kernel):
        run = compiled(kernel)
        return lambda b, commands, forces, *rest: run(b, fenced(commands), fenced(forces), *rest)

    compiled = Kernel.advance.func
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Kernel, "advance", property(advance))
        yield


@cache
def model(*effects: str) -> Preset:
    """The actuator against a measured force."""
    matrix = Matrix(ACTUATOR, (loaded(0, "linear"),))
    return prepare(preset("qian2014", effects), matrix, "force")[0]


@cache
def loaded(number: int, hold: str) -> Run:
    """A run from rest with its own command, gain and force; what it measured is that of a command 1 ms late."""
    rng = np.random.default_rng([15, number])
    moves = np.arange(SAMPLES) >= REST
    command = moves * linear.band_limited_noise(SAMPLES, 1.27e-3, rng)
    force = moves * linear.band_limited_noise(SAMPLES, 300.0, rng)
    measured = reference.respond(PLANT, GAINS[number], command, force, 1e-3, hold)
    channels = {"command": command, "force": force, "displacement": measured}
    return Run(f"run {number}", "", linear.SAMPLE_RATE, channels, gain=GAINS[number], hold=hold)


@dataclass(frozen=True)
class Batch:
    """Runs that are simulated at once, each with every delay (s)."""

    model: Preset
    runs: tuple[Run, ...]
    delays: Sequence[float]
    steps: int

    def outputs(self, length: int = SAMPLES) -> np.ndarray:
        """(samples, runs, delays), in blocks of a length."""
        known = [conditions(run, ACTUATOR) for run in self.runs]
        values = {name: np.array([entry[name] for entry in known])[:, None] for name in known[0]}
        values |= {p.in_equations: np.array([[p.value]]) for p in self.model.parameters}
        if self.model.effects:
            values["command_delay__delay"] = np.array([self.delays])
        blocks = Simulation(self.model.chain, self.runs, values, self.steps).outputs(length)
        return np.concatenate([rows for rows, _, _ in blocks])


@settings(max_examples=20, derandomize=True, deadline=None)
@given(
    holds=st.lists(st.sampled_from(("linear", "zoh")), min_size=1, max_size=4),
    delays=st.lists(st.floats(0.0, 5e-3), min_size=1, max_size=4) | st.none(),
    steps=st.sampled_from((1, 2, 4)),
    length=st.sampled_from((SAMPLES, 31)),
)
@example(holds=["linear"] * 3, delays=[3e-3], steps=1, length=SAMPLES)
@example(holds=["zoh"] * 3, delays=None, steps=2, length=SAMPLES)
def test_runs_with_a_measured_force_are_what_each_is_alone_and_what_the_reference_says(holds, delays, steps, length):
    """Any runs and delays side by side, whatever the blocks, or a model without any delay."""
    used = model("command_delay") if delays else model()
    batch = Batch(used, tuple(map(loaded, range(len(holds)), holds)), delays or [0.0], steps)
    together = batch.outputs(length)
    for i, run in enumerate(batch.runs):
        for j, delay in enumerate(batch.delays):
            alone = replace(batch, runs=(run,), delays=[delay]).outputs()[:, 0, 0]
            wanted = reference.respond(PLANT, run.Kp, run.command, run.channels["force"], delay, run.hold)
            assert np.abs(together[:, i, j] - alone).max() <= 1e-10 * np.std(wanted)
            assert np.std(alone - wanted) < 1e-3 / steps * np.std(wanted)


@pytest.mark.parametrize("cores", [1, 2, 5])
def test_the_error_of_runs_with_a_measured_force_does_not_hang_on_the_number_of_cores(monkeypatch, cores):
    """The right delay leaves nothing of any run; a wrong one leaves what it leaves of each run alone."""
    monkeypatch.setattr(simulated_runs, "cores", lambda: cores)
    runs = tuple(loaded(number, "zoh") for number in range(4))
    used = model("command_delay")
    values = {p.in_equations: p.value for p in used.parameters}

    def errors(*chosen: Run) -> np.ndarray:
        fitness = SimulatedFitness(used, Matrix(ACTUATOR, chosen), chosen, 500.0, Space((), tuple(values), values, {}))
        batch = {name: np.full(2, value) for name, value in values.items()}
        return fitness._errors(batch | {"command_delay__delay": np.array([1e-3, 3e-3])}, 2, 4)

    together, alone = errors(*runs), np.mean([errors(run) for run in runs], axis=0)
    assert together == pytest.approx(alone, rel=1e-9, abs=1e-10)
    assert together[0] < 1e-3
    assert together[1] > 0.1
