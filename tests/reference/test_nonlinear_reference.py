"""The reference with every effect is independent of the program, and exact enough to judge it."""

from __future__ import annotations

import ast
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ident.effects import EFFECTS
from tests.reference import measured_load_reference as loaded
from tests.reference import nonlinear_reference as reference
from tests.reference import plain_cases, plain_effects, plain_loads, plain_machine
from tests.reference import qian_reference as linear
from tests.reference.plain_cases import CASES
from tests.reference.plain_machine import KINKS
from tests.short_form import short_form

PLANT = linear.Plant()
RATE = 512.0  # Hz: few kinks of the command, so that the adaptive integrator is quick; the reference's step is its own
STEPS = round(reference.SUBSTEPS * linear.SAMPLE_RATE / RATE)  # sub-steps a sample: 1/65536 s, as everywhere
SAMPLES, LONG = 60, 512
RUNS = ((linear.Cell(0.98, 67.6e3, 150.0, 7.0), "linear"), (linear.Cell(0.0, 36.3e3, 300.0, 10.0), "zoh"))


@pytest.mark.parametrize(
    "module",
    [reference, loaded, plain_machine, plain_effects, plain_loads, plain_cases],
    ids=lambda m: m.__name__.split(".")[-1],
)
def test_the_references_import_nothing_of_the_program(module):
    """Neither the reference nor its judge; beside numpy, numba and scipy only each other and the linear reference."""
    tree = ast.parse(Path(module.__file__).read_text(encoding="utf-8"))
    imported = {alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names}
    imported |= {node.module or "." for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    known = {"numpy", "numba", "scipy", *sys.stdlib_module_names}
    beside = {name for name in imported if name.split(".")[0] not in known}
    own = {"tests.reference", "tests.reference.qian_reference"}
    if module is not reference:
        own |= {"tests.reference.plain_machine", "tests.reference.plain_effects"}
    assert beside <= own
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert not names & {"__import__", "exec", "eval", "importlib"}


@pytest.mark.parametrize("hold", ["linear", "zoh"])
@pytest.mark.parametrize("number", [0, 40, 83])
def test_without_effects_it_is_the_linear_reference(number, hold):
    """Two integrators of different order, 2e-8 of the displacement's standard deviation apart."""
    trial = linear.trials(damping=100.0)[number]
    command = linear.band_limited_noise(1024, trial.amplitude, np.random.default_rng(number))
    wanted = linear.simulate(PLANT, trial.cell, command, hold)
    got = reference.respond(PLANT, reference.effects(), trial.cell, command, hold).displacement
    assert np.max(np.abs(got - wanted)) < 2e-8 * np.std(wanted)


def test_every_effect_and_parameter_has_a_case():
    """The catalogue's names and letters, each with values that are not its off value."""
    assert {e.name: {p.symbol for p in e.parameters} for e in EFFECTS} == {
        name: set(case.values) for name, case in CASES.items()
    }
    assert all(next(iter(case.values.values()))[run] != 0 for case in CASES.values() for run in (0, 1))


@pytest.mark.parametrize("name", short_form(CASES, *[*CASES][::12]))
def test_each_effect_agrees_with_an_adaptive_integrator(name, full):
    """Displacement, force and pressure against SciPy's DOP853 and the equations written a second time.

    With a quarter of the step the reference comes closer by what its order promises: both go to the same limit.
    """
    kind, samples = CASES[name].kind, LONG if full else SAMPLES
    for run in (0, 1):
        wanted = adaptive(name, run, samples)
        usual, fine = (miss(fixed(name, run, samples, steps), wanted) for steps in (STEPS, 4 * STEPS))
        assert usual < kind.error
        assert fine < max(usual / kind.gain, kind.error / 100)


@pytest.mark.parametrize("name", short_form(CASES, *[*CASES][1::12]))
def test_the_agreement_is_not_blind(name):
    """With the strength 2 % off, it is missed by more than the tolerance in at least one of the outputs."""
    strength, case = next(iter(CASES[name].values)), CASES[name]
    off = {letter: (1.02 if letter == strength else 1.0) for letter in case.values}
    assert max(miss(fixed(name, run, SAMPLES, STEPS, off), adaptive(name, run, SAMPLES)) for run in (0, 1)) > (
        2 * case.kind.error
    )


class LateLead(plain_effects.CommandDelay, plain_effects.Lead):
    """What the lead makes of the jumps of a late command, its first one among them."""


@pytest.mark.parametrize("run", [0, 1], ids=[hold for _, hold in RUNS])
def test_a_lead_sees_the_jumps_of_a_late_command(run):
    """The two effects of the controller of which one changes what the other differentiates."""
    cell, hold = RUNS[run]
    given = command("command_delay", run, SAMPLES)
    wanted = plain_machine.respond(LateLead(PLANT, cell, {"T": 1.7e-3, "Td": 2e-3}), given, RATE, hold)
    hidden = reference.named({"command_delay.T": 1.7e-3, "lead.Td": 2e-3})
    usual, fine = (
        miss(np.array(reference.respond(PLANT, hidden, cell, given, hold, RATE, steps)), wanted)
        for steps in (STEPS, 4 * STEPS)
    )
    assert usual < 2 * KINKS.error  # a kick inside a sub-step goes to both of its ends
    assert fine < usual / KINKS.gain


def miss(got: np.ndarray, wanted: np.ndarray) -> float:
    """The largest of the three outputs' deviations, each over its own standard deviation."""
    return float(np.max(np.std(got - wanted, axis=1) / np.std(wanted, axis=1)))


def command(name: str, run: int, samples: int) -> np.ndarray:
    """The paper's noise at every eighth sample."""
    every = round(linear.SAMPLE_RATE / RATE)
    noise = linear.band_limited_noise(every * samples, CASES[name].rms, np.random.default_rng([7, run]))
    return noise[::every].copy()


def fixed(name: str, run: int, samples: int, steps: int, factors: dict[str, float] | None = None) -> np.ndarray:
    """The reference's outputs, (3, n)."""
    cell, hold = RUNS[run]
    values = {
        f"{name}.{letter}": float(pair[run]) * (factors or {}).get(letter, 1.0)  # an integer would be compiled anew
        for letter, pair in CASES[name].values.items()
    }
    hidden = reference.named(values)
    return np.array(reference.respond(PLANT, hidden, cell, command(name, run, samples), hold, RATE, steps))


@cache
def adaptive(name: str, run: int, samples: int) -> np.ndarray:
    """The plain machine's outputs, (3, n)."""
    cell, hold = RUNS[run]
    known = vars(plain_effects) | vars(plain_loads)
    machine = known["".join(part.title() for part in name.split("_"))]
    values = {letter: float(pair[run]) for letter, pair in CASES[name].values.items()}
    return plain_machine.respond(machine(PLANT, cell, values), command(name, run, samples), RATE, hold)
