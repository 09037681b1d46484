"""Several models of the same runs in one simulation: each answers as it does alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.effects import CATALOGUE
from ident.fit.side_by_side import outputs_at_each
from ident.fit.simulated_runs import every_run
from ident.matrix import Actuator, Matrix
from ident.presets import preset
from ident.run import Run
from ident.simulation.simulate import Simulation
from tests.short_form import short_form

EFFECTS = tuple(effect for effect in CATALOGUE if effect.name in ("dead_zone", "specimen_hysteresis"))
SERVO = {"Z0/A^2": 9.004, "tau": 0.03, "m0": 1.0, "c0": 6.829, "Ka/A^2": 2.6e-6, "Cl/A^2": 1.805e-5}
MODEL = preset("qian2014").with_effects(EFFECTS)


def matrix(begins: str, count: int) -> Matrix:
    """Runs of a loop: what they measured is noise, as any record will do."""
    rng, runs = np.random.default_rng(3), []
    for number in range(count):
        channels = {name: np.cumsum(rng.standard_normal(300)) for name in ("command", "displacement")}
        runs.append(Run(f"r{number}", "", 50.0, channels, dict.fromkeys(channels, "m"), assumed_beginning=begins))
    return Matrix(Actuator("S"), tuple(runs))


def points(count: int) -> list[dict[str, float]]:
    """Values that ask for different steps and have different powers."""
    drawn = []
    for number in range(count):
        of = SERVO | {"tau": 0.03 / (1 + number % 3), "Ka/A^2": (1e-4, 2.6e-6)[number // 2 % 2]}
        machine = {MODEL.parameter(name).in_equations: value for name, value in of.items()}
        effects = {
            "dead_zone__half_width": 0.05 * (number % 3),
            "specimen_hysteresis__force": 3.0,
            "specimen_hysteresis__yield_displacement": 0.3,
            "specimen_hysteresis__exponent": (1.0, 3.0, 2.5, 1.5)[number % 4],
        }
        usual = {p.in_equations: p.value for p in MODEL.parameters}
        drawn.append(usual | machine | effects)
    return drawn


@pytest.mark.parametrize("count", short_form([1, 3], 3))
@pytest.mark.parametrize("begins", ["at rest", "standing", "moving"])
def test_side_by_side_each_answers_to_the_bit_as_it_does_alone(begins, count):
    """Whatever it begins with, however many steps it asks for, and whatever power stands in its code."""
    of, asked = matrix(begins, count), points(11)
    alone = [every_run(MODEL, of).outputs_at(values) for values in asked]
    together = list(outputs_at_each(every_run(MODEL, of), asked))
    assert len({run for found in together for run in found}) == count
    for one, other in zip(alone, together, strict=True):
        assert all(np.array_equal(one[run], other[run]) for run in one)
    assert not np.array_equal(together[0]["r0"], together[1]["r0"])


@pytest.mark.parametrize("count", short_form([1, 3], 3))
def test_first_states_settle_side_by_side_to_the_bit_as_they_do_alone(count):
    """From those that are known of another model, in as many rounds as each takes, with a model that is unstable."""
    noise, asked = matrix("moving", count), points(11)
    made = every_run(MODEL, noise).outputs_at(asked[0])
    measured = [replace(run, channels={**run.channels, "displacement": made[run.id]}) for run in noise.runs]
    of = every_run(MODEL, replace(noise, runs=tuple(measured)))
    of.settle(asked[8])
    known = {run: start.copy() for run, start in of.starts.items()}
    models = [replace(of, starts=dict(of.starts)) for _ in asked]
    alone = [model.outputs_at(values) for model, values in zip(models, asked, strict=True)]
    assert any(not np.array_equal(model.starts["r0"], known["r0"]) for model in models)
    for one, other in zip(alone, outputs_at_each(of, asked), strict=True):
        assert all(np.array_equal(one[run], other[run], equal_nan=True) for run in one)
    assert all(np.array_equal(of.starts[run], known[run]) for run in known)


def test_models_that_are_alike_are_simulated_at_once(monkeypatch):
    """A model alone leaves seven of eight lanes empty."""
    simulated, outputs = [], Simulation.outputs

    def counting(simulation, *asked):
        simulated.append(simulation.shape[1])
        return outputs(simulation, *asked)

    asked = [{**points(1)[0], "c0": 6.0 + 0.1 * number} for number in range(8)]
    runs = every_run(MODEL, matrix("at rest", 1))
    monkeypatch.setattr(Simulation, "outputs", counting)
    assert len(list(outputs_at_each(runs, asked))) == 8
    assert simulated == [8]


def test_first_states_of_models_that_are_alike_settle_at_once(monkeypatch):
    """Each round is one simulation of all of them, with each first state moved; and then one of their outputs."""
    simulated, outputs = [], Simulation.outputs

    def counting(simulation, *asked):
        simulated.append(simulation.shape[1])
        return outputs(simulation, *asked)

    asked = [{**points(1)[0], "c0": 6.0 + 0.01 * number} for number in range(4)]
    runs = every_run(MODEL, matrix("moving", 1))
    runs.settle(asked[0])
    monkeypatch.setattr(Simulation, "outputs", counting)
    assert len(list(outputs_at_each(runs, asked))) == 4
    *rounds, last = simulated
    lanes = 1 + len(runs.chain.begun)
    assert last == 4
    assert rounds[0] == 4 * lanes
    assert all(of % lanes == 0 for of in rounds)
