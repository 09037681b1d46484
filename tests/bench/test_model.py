"""The model itself: one text of equations, one fast simulation, and a table that both know."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from ident.bench.model import FAST, Model
from ident.bench.speed_table import FRACTIONS, SpeedTable
from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.equations.equation import Equation
from ident.equations.interpolation import interpolated
from ident.equations.mathml import mathml
from ident.errors import Unusable
from ident.matrix import Actuator
from ident.presets import PRESETS, preset
from ident.presets.kononykhin import KONONYKHIN
from ident.run import Run, Specimen
from ident.simulation.simulate import responses
from ident.stages import IDEAL_SENSOR, Quantity
from ident.stages.bench import node_names
from ident.stages.stage import stage
from tests.bench.sets import true_model
from tests.reference import kononykhin_reference as reference

MIDDLE = {p.name: p.value for p in KONONYKHIN.parameters}
TIME = np.arange(6000) / 1000
SLOW = 0.01 * np.sin(2 * np.pi * 0.5 * TIME) + 0.01 * np.sin(2 * np.pi * 1.3 * TIME)
STRENGTHS = {
    "command_delay__delay": 0.02,
    "second_lag__time_constant": 0.02,
    "stiction__pressure": 3e6,
    "spring_load__rate": 5e9,
    "spring_load__centre": 1e-4,
}
CURRENT = 0.1 * np.sin(2 * np.pi * 0.5 * TIME) + 0.3 * np.sin(2 * np.pi * 1.3 * TIME)


def by_chain(values, current, output="displacement", actuator=None, **labels) -> np.ndarray:
    """The preset through the compiled kernel of the chain."""
    channels = {"command": current, output: np.zeros_like(current)}
    run = Run("r", "", 1000.0, channels, output=output, **labels)
    known = conditions(run, actuator or Actuator("A", supply_pressure=21e6)) | values
    symbols = {name: np.array([[known[name]]]) for name in KONONYKHIN.chain.symbols}
    return responses(KONONYKHIN.chain, [run], symbols, steps=4)[:, 0, 0]


def by_bench(values) -> Model:
    """The same through the bench's own simulation."""
    table = SpeedTable.straight(1.0).with_values(values)
    return Model(values["T"], values["B"], values["I0"], values["kp"], values["dPfr"], table, 21e6)


@pytest.mark.parametrize("shift", [0.0, 0.013])
def test_the_fast_simulation_is_that_of_the_equations(shift):
    """Position within 1e-5 of its deviation; the pressure, which no integration enters, within 1e-6."""
    values = {**MIDDLE, "I0": shift}
    answer = by_bench(values).answer(CURRENT, 1000.0, steps=4)
    position = by_chain(values, CURRENT)
    assert np.std(position - answer.position) < 1e-5 * np.std(position)
    pressure = by_chain(values, CURRENT, "load_pressure")
    assert np.sqrt(np.mean((pressure - answer.pressure)[1:] ** 2)) < 1e-6 * np.std(pressure)


@pytest.mark.parametrize("name", [effect.name for effect in FAST])
def test_the_fast_simulation_of_an_effect_is_that_of_its_equations(name):
    """Position and pressure within a hundredth of what the effect changes."""
    strengths = {p.in_equations: p.value for effect in FAST for p in effect.added}
    strengths |= {n: value for n, value in STRENGTHS.items() if n.startswith(name)}
    plain, chain = by_bench(MIDDLE), preset("kononykhin", tuple(effect.name for effect in FAST)).chain
    fast = replace(plain, strengths=strengths)
    slow = replace(fast, chain=chain)
    without, found, expected = (model.answer(SLOW, 1000.0) for model in (plain, fast, slow))
    for of in ("position", "pressure"):
        a, b, off = getattr(found, of), getattr(expected, of), getattr(without, of)
        assert np.std(a - b) < 0.01 * np.std(a - off), of


def test_the_fast_simulation_is_that_of_the_reference():
    """Every record of a full set, within 0.2 % of its deviation."""
    truth = reference.scattered(11)
    model = true_model(truth)
    for record in reference.full_set(truth, 11):
        start = 1e-3 * record.true_position[0]
        found = model.answer(record.current / 100, reference.RATE, start=start).position
        assert np.std(1e3 * found - record.true_position) < 2e-3 * np.std(record.true_position), record.id


def test_current_is_counted_in_rated_currents():
    """40 mA of 40 mA rated do what 100 % do."""
    same = by_chain(MIDDLE, 0.04 * CURRENT, rated_current=0.04)
    assert same == pytest.approx(by_chain(MIDDLE, CURRENT), rel=1e-9, abs=1e-12)


def test_a_load_takes_its_share_of_the_speed():
    """A spring of 1 MN/m on 500 mm² holds the link where kp (I − B − I0) A = k x + ΔPfr A."""
    actuator = Actuator("A", piston_area=5e-4, supply_pressure=21e6)
    held = by_chain(MIDDLE, np.full(20000, 0.03), actuator=actuator, specimen=Specimen(stiffness=1e6))
    expected = (MIDDLE["kp"] * (0.03 - MIDDLE["B"]) - MIDDLE["dPfr"]) * 5e-4 / 1e6
    assert held[-1] == pytest.approx(expected, rel=0.01)


def test_the_actuator_stands_within_the_dead_space_and_moves_beyond_it():
    model = by_bench(MIDDLE)
    assert model.dead_space == pytest.approx(MIDDLE["B"] + MIDDLE["dPfr"] / MIDDLE["kp"])
    for share, moves in ((0.98, False), (1.05, True)):
        current = share * model.dead_space * np.minimum(TIME, 1.0)
        assert bool(model.answer(current, 1000.0).position[-1] > 1e-6) is moves


def test_the_held_current_between_samples_is_obeyed():
    """The same record held is late by half a sample: 0.5 ms at 1 kHz."""
    model = by_bench(MIDDLE)
    late = np.interp(TIME - 5e-4, TIME, CURRENT)
    held, shifted = model.answer(CURRENT, 1000.0, "zoh").position, model.answer(late, 1000.0).position
    assert np.std(held - shifted) < 2e-4 * np.std(held)


# Tables ----------------------------------------------------------------------------------------------------------


NODES, VALUES = np.array([-2.0, -1.0, 0.0, 0.5, 2.0]), np.array([-3.0, -1.0, 0.0, 2.0, 2.5])
PAIRS = [number for pair in zip(NODES, VALUES, strict=True) for number in pair]


def test_tables_are_those_of_scipy_and_numpy():
    x = np.linspace(-2, 2, 401)
    assert interpolated("monotone", x, *PAIRS) == pytest.approx(PchipInterpolator(NODES, VALUES)(x), abs=1e-12)
    assert interpolated("lines", x, *PAIRS) == pytest.approx(np.interp(x, NODES, VALUES), abs=1e-12)


@pytest.mark.parametrize("kind", ["lines", "monotone"])
def test_the_kernel_and_the_evaluator_read_the_same_table(kind):
    """An integrator behind a table, whose values are parameters, over and beyond the table's ends."""
    listed = ", ".join(f"{node:g}, y{i}" for i, node in enumerate(NODES))
    load = stage(
        "load",
        tuple(Quantity(name, "1", "test") for name in ("v", "x", "X")),
        (f"v = {kind}(u, {listed})", "a table"),
        ("x' = v", "its integral"),
        ("X = x", "what is read"),
    )
    chain = Chain((load, IDEAL_SENSOR), {"displacement": "y"})
    u = np.linspace(-3, 3, 2001)
    run = Run("r", "", 100.0, {"command": u, "displacement": np.zeros_like(u)})
    values = {f"y{i}": np.array([[value]]) for i, value in enumerate(VALUES)}
    got = responses(chain, [run], values)[:, 0, 0]
    speed = interpolated(kind, u, *PAIRS)
    expected = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))]) / 100.0
    assert got == pytest.approx(expected, abs=2e-4)


def test_a_table_needs_pairs():
    with pytest.raises(Unusable, match="pairs"):
        Equation("v = lines(x, 0, 1, 2)")
    assert "<mtable>" in mathml("v = monotone(x, 0, 0, 1, V1)")


def test_lines_and_cubics_meet_at_the_nodes():
    """The two kinds of the bench's table differ between the nodes only, and are odd where the sides are."""
    speeds = tuple(np.sqrt(FRACTIONS))
    cubic = SpeedTable(speeds, tuple(-v for v in speeds))
    straight = replace(cubic, kind="lines")
    nodes, between = np.array(FRACTIONS), np.array([0.07, 0.4, 0.9])
    assert cubic.speed(nodes) == pytest.approx(straight.speed(nodes))
    assert np.all(cubic.speed(between) != straight.speed(between))
    assert cubic.speed(-between) == pytest.approx(-cubic.speed(between))
    assert straight.speed(between) == pytest.approx(np.interp(between, [0, *FRACTIONS], [0, *speeds]))


def test_the_model_is_listed_with_its_citation_and_takes_no_foreign_effect():
    assert PRESETS["kononykhin"].parameter("V_p5").unit == "m/s"
    assert {*node_names()} < set(KONONYKHIN.chain.symbols)
    assert not KONONYKHIN.is_linear
    with pytest.raises(Unusable):
        preset("kononykhin", ("coulomb_friction",))
