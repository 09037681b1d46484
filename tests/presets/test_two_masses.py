"""Two masses with a spring between them, as stages and as effects, against the physics as SciPy integrates it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.reference.coupled_masses import Coupled

RATE, COUNT, NOISE = 100.0, 400, 0.005
LIGHT = {"population": 24.0, "generations": 8.0, "elite": 4.0}
SEEN = ("elastic_load", "elastic_coupling")
"""By what is recorded: the drive, or the load."""


def drawn(seed: int, dry: float = 0.0) -> Coupled:
    """Masses of 1 kg together, the resonance at 2 to 6 Hz, damped by 3 to 20 %; dry friction at the drive."""
    rng = np.random.default_rng([531, seed])
    load, omega, ratio = rng.uniform(0.3, 0.7), rng.uniform(12.0, 40.0), rng.uniform(0.03, 0.2)
    both = load * (1.0 - load)
    return Coupled(1.0 - load, load, both * omega**2, 2.0 * ratio * omega * both, rng.uniform(3.0, 8.0), dry_drive=dry)


def run(parts: Coupled, seed: int, seen: int, use: str) -> Run:
    """Held steps of a voltage, 10 N for each volt, and the speed of the drive (0) or of the load (1)."""
    rng = np.random.default_rng([532, seed])
    u, t = np.repeat(rng.uniform(-3.0, 3.0, COUNT // 8), 8), np.arange(COUNT) / RATE
    speed = parts.moved(lambda now: 10.0 * u[min(int(now * RATE + 1e-9), COUNT - 1)], t)[seen]
    speed = speed + NOISE * speed.std() * rng.standard_normal(COUNT)
    return Run(
        use,
        "",
        RATE,
        {"command": u, "velocity": speed},
        {"command": "V", "velocity": "rad/s"},
        hold="zoh",
        use=use,
        output="velocity",
    )


@cache
def matrix(seed: int, seen: int, dry: float = 0.0) -> Matrix:
    parts = drawn(seed, dry)
    return Matrix(Actuator("TWO"), (run(parts, 2 * seed, seen, "fit"), run(parts, 2 * seed + 1, seen, "verify")))


@pytest.mark.parametrize(("seen", "load"), [*enumerate(("two_masses", "two_masses_at_load"))])
def test_a_machine_of_two_masses_has_the_masses_ratio_spring_and_dampers_of_the_record(seen, load):
    """Nobody knows a force: all of them are ratios to one mass. None of it needs an effect."""
    parts = drawn(1)
    found = identify(matrix(1, seen), Settings(model=f"machine:load={load},sensor=velocity", options=LIGHT, seed=1))
    assert found.error["verify"] < 2.0 * NOISE
    of = {name: value / found.values["m0"] for name, value in found.values.items()}
    wanted = {"m1": parts.load, "kj": parts.stiffness, "cj": parts.between, "c0": parts.of_drive, "Kt": 10.0}
    for name, value in wanted.items():
        assert of[name] == pytest.approx(value / parts.drive, rel=0.15), name


@pytest.mark.parametrize("dry", [0.0, 6.0])
@pytest.mark.parametrize(("seen", "wanted"), [*enumerate(SEEN)])
def test_a_spring_between_drive_and_load_is_named_by_what_was_recorded(seen, wanted, dry, monkeypatch, full):
    """What is seen of the drive has an antiresonance, what is seen of the load has none."""
    if not full and (dry or seen):
        pytest.skip("the long form: friction as well, and the load's motion, of which other effects have to be told")
    few = (*SEEN, "coulomb_friction", "command_delay", "dead_zone")
    rank_only(monkeypatch, few)
    parts, records = drawn(2, dry), matrix(2, seen, dry)
    found = diagnose(records, identify(records, Settings(model="motor", options=LIGHT)), propose=False)
    assert set(found.verdict.effects) == {wanted, *(("coulomb_friction",) if dry else ())}
    last = found.ladder[-1]
    assert last.error["verify"] < 2.0 * NOISE
    assert last.parameters[f"{wanted}.share"].value == pytest.approx(parts.load, rel=0.1)
    alone = np.sqrt(parts.stiffness / parts.load)
    assert last.parameters[f"{wanted}.frequency"].value == pytest.approx(alone, rel=0.05)


@pytest.mark.parametrize("seed", [2, 7])
def test_what_is_behind_a_spring_is_begun_where_it_moves_along(seed):
    """A counter without direction, a record that begins in motion, and values that nobody has to search for."""
    parts = drawn(seed, 2.0)

    def counted(one: Run, first: int) -> Run:
        seen = {"command": one.channels["command"], "velocity": np.abs(one.channels["velocity"])}
        return replace(one, channels={name: samples[first:] for name, samples in seen.items()})

    runs = (counted(run(parts, 2 * seed, 1, "fit"), 0), counted(run(parts, 2 * seed + 1, 1, "verify"), 150))
    alone = float(np.sqrt(parts.stiffness / parts.load))
    known = {"m0": 1.0, "Kt": 10.0, "c0": parts.of_drive, "coulomb_friction.force": 2.0}
    known |= {"elastic_coupling.share": parts.load, "elastic_coupling.frequency": alone}
    known["elastic_coupling.damping"] = 0.5 * parts.between / (parts.load * alone)
    effects = ("coulomb_friction", "elastic_coupling", "rectified_sensor")
    found = identify(Matrix(Actuator("TWO"), runs), Settings(model="motor", effects=effects, fixed=known))
    assert found.error["verify"] < 3.0 * NOISE
