"""Lanes that have come to the same state are simulated once, and give the digits that each gives alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.chain.conditions import conditions
from ident.matrix import Actuator
from ident.presets import preset
from ident.run import Run, Specimen
from ident.simulation import simulate
from ident.simulation.simulate import Simulation

ACTUATOR = Actuator("A", piston_area=1.1e-3)
SAMPLES = 20_000
PRESET = preset("qian2014")


def moving(vectors: int, gain: float = 6.0) -> Simulation:
    """A record with so many vectors, of which the first half differ in a parameter, the others in the first state."""
    command = 1e-3 * np.cumsum(np.random.default_rng(0).standard_normal(SAMPLES)) / np.sqrt(SAMPLES)
    channels = {"command": command, "displacement": command}
    run = Run("a", "", 1024.0, channels, specimen=Specimen(1.0, 0.0, 0.0), gain=gain)
    values = {name: np.array([[value]]) for name, value in conditions(run, ACTUATOR).items()}
    values |= {p.in_equations: np.full((1, vectors), p.value) for p in PRESET.parameters}
    values["tau"] = values["tau"] * np.where(np.arange(vectors) < vectors // 2, 1.0 + 1e-3 * np.arange(vectors), 1.0)
    start = np.zeros((1, vectors, len(PRESET.chain.states)))
    start[0, vectors // 2 :, -1] = 1e-6 * np.arange(vectors - vectors // 2)
    return Simulation(PRESET.chain, (run,), values, 2, start)


def outputs(of: Simulation) -> np.ndarray:
    """(samples, vectors)."""
    return np.concatenate([rows[:, 0] for rows, _, _ in of.outputs(512)])


def alone(of: Simulation, vector: int) -> np.ndarray:
    """The outputs of one vector that is simulated by itself."""
    values = {name: value if value.shape[1] == 1 else value[:, [vector]] for name, value in of.values.items()}
    assert of.start is not None
    return outputs(replace(of, values=values, start=of.start[:, [vector]]))[:, 0]


@pytest.mark.parametrize("vectors", [12, 24, 40])
def test_each_vector_is_what_it_is_alone_to_the_last_bit(vectors):
    """In kernels of sixteen lanes as in those of eight, and after lanes have come together, too."""
    together = moving(vectors)
    found = outputs(together)
    assert np.std(found[:, 0]) > 0
    assert np.array_equal(found, np.column_stack([alone(together, vector) for vector in range(vectors)]))


def test_vectors_that_differ_in_their_first_states_alone_are_simulated_once_when_these_have_died_out(monkeypatch):
    """Twenty of forty: a lane for all of them is left beside the twenty that differ in a parameter."""
    used: list[int] = []
    advance = simulate.advance_groups

    def counted(code, wide, groups, *given):
        used.append(wide * (groups[1] - groups[0]))
        advance(code, wide, groups, *given)

    monkeypatch.setattr(simulate, "advance_groups", counted)
    monkeypatch.setattr(simulate, "cores", lambda: 1)
    outputs(moving(40))
    assert used[0] == 48
    assert used[-1] == 32


@pytest.mark.parametrize(("samples", "wide"), [(1_000, 8), (SAMPLES, 16)])
def test_a_kernel_of_sixteen_lanes_is_compiled_for_what_takes_many_steps(monkeypatch, samples, wide):
    """A short simulation is over before it would be compiled."""
    used: list[int] = []
    monkeypatch.setattr(simulate, "advance_groups", lambda _code, wide, *_given: used.append(wide))
    of = moving(24)
    outputs(replace(of, runs=(of.runs[0].part(0, samples),)))
    assert used[0] == wide


def test_vectors_of_a_machine_that_forgets_no_first_state_stay_apart():
    """A cylinder in open loop keeps where it began."""
    chain = preset("open_valve").chain
    of = moving(24)
    values = {name: value for name, value in of.values.items() if name in chain.symbols}
    values |= {p.in_equations: np.full((1, 24), p.value) for p in preset("open_valve").parameters}
    start = np.zeros((1, 24, len(chain.states)))
    start[0, :, chain.states.index("x")] = 1e-6 * np.arange(24)
    found = outputs(Simulation(chain, of.runs, values, 2, start))
    assert np.all(np.diff(found[-1]) > 0.5e-6)
