"""Every effect of the catalogue against the independent reference, one harness for all."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

import numpy as np
import pytest

from ident.chain.conditions import conditions
from ident.effects import EFFECTS
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.matrix import Actuator
from ident.parameter import Parameter
from ident.presets import PRESETS, Preset, preset
from ident.run import Run, Specimen
from ident.simulation.intersample_command import ends
from ident.simulation.recursion import discretise, respond
from ident.simulation.simulate import responses
from ident.simulation.steps import steps_needed
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear
from tests.reference.plain_cases import CASES

PLANT = linear.Plant()
CELLS = (linear.Cell(0.98, 67.6e3, 150.0, 7.0), linear.Cell(0.0, 0.0, 0.0, 10.0), linear.Cell(2.67, 0.0, 0.0, 5.0))
SAMPLES = 1024
OFF, FEW = 1.01, 0.02  # a strength that is wrong, and what a weak effect changes of the short runs


def by_name(effect: Effect) -> str:
    """The id of a case."""
    return effect.name


def command(seed: int) -> np.ndarray:
    """A quarter of a second of the paper's noise at the middle amplitude."""
    return linear.band_limited_noise(SAMPLES, 1.27e-3, np.random.default_rng([2014, seed]))


def ours(
    model: Preset,
    values: Mapping[str, float],
    cell: linear.Cell,
    u: np.ndarray,
    hold: str,
    output: str = "displacement",
    steps: int | None = None,
) -> np.ndarray:
    """The program's output for a machine of Table 4 with some values changed."""
    specimen = Specimen(cell.mass, cell.stiffness, cell.damping)
    run = Run(
        "run",
        "",
        linear.SAMPLE_RATE,
        {"command": u, output: np.zeros_like(u)},
        specimen=specimen,
        gain=cell.gain,
        hold=hold,
        output=output,
    )
    known = {p.in_equations: p.value for p in model.parameters} | conditions(run, Actuator("", piston_area=PLANT.A))
    known |= {model.parameter(name).in_equations: value for name, value in values.items()}
    batch = {name: np.array([[value]]) for name, value in known.items()}
    count = steps or int(steps_needed(model.chain, np.array([-0.2]), hold, model.effects)[0])
    return responses(model.chain, [run], batch, count)[:, 0, 0]


def strength(effect: Effect) -> float:
    """The strength at which an effect is compared: its largest, where the machine still follows."""
    return effect.strength.upper * CASES[effect.name].share


@cache
def expected(name: str, symbol: str, value: float, number: int, hold: str) -> np.ndarray:
    """The reference's displacement."""
    return answered(reference.named({f"{name}.{symbol}": value}), number, hold)


@cache
def answered(hidden: reference.Effects, number: int, hold: str) -> np.ndarray:
    """The same by all that is hidden: with no strength every effect is the one machine without."""
    return reference.respond(PLANT, hidden, CELLS[number], command(number), hold).displacement


def deviations(effect: Effect, factor: float = 1.0) -> list[tuple[float, float]]:
    """For each cell and hold: (kernel against reference, what the effect does), over the output's deviation."""
    model, found = preset("qian2014", (effect.name,)), []
    for number, cell in enumerate(CELLS):
        for hold in ("linear", "zoh"):
            wanted = expected(effect.name, effect.strength.symbol, strength(effect), number, hold)
            without = expected(effect.name, effect.strength.symbol, 0.0, number, hold)
            got = ours(model, {effect.name: factor * strength(effect)}, cell, command(number), hold)
            size = np.std(wanted)
            found.append((float(np.std(got - wanted) / size), float(np.std(without - wanted) / size)))
    return found


def test_the_reference_knows_every_effect():
    """Each parameter of the catalogue is one of the reference's, with the same default."""
    of_catalogue = {f"{e.name}_{p.symbol}": p.value for e in EFFECTS for p in e.parameters}
    assert of_catalogue == reference.Effects()._asdict()


@pytest.mark.parametrize("effect", EFFECTS, ids=by_name)
def test_the_kernel_agrees_with_the_reference(effect):
    """With and without specimen, command straight or held; friction that sticks to 1e-3, everything else to 1e-4."""
    assert max(miss for miss, _ in deviations(effect)) < CASES[effect.name].close


@pytest.mark.parametrize("effect", EFFECTS, ids=by_name)
def test_one_percent_of_its_strength_is_seen(effect):
    """The comparison above is not blind: one coefficient of the kernel 1 % off makes it fail.

    More may be needed of those that change the short runs by less than 2 %, and of no others.
    """
    case = CASES[effect.name]
    assert (max(acts for _, acts in deviations(effect)) < FEW) is (case.seen > OFF)
    assert max(miss for miss, _ in deviations(effect, factor=case.seen)) > case.close


@pytest.mark.parametrize("samples", [0.3, 1.0, 1.0127, 1.9, 2.4])
def test_a_command_that_begins_with_a_jump_may_be_late_by_a_sample(samples):
    """The jump falls into the first steps of the simulation, or between them."""
    delay = samples / linear.SAMPLE_RATE
    for hold in ("linear", "zoh"):
        wanted = expected("command_delay", "T", delay, 2, hold)
        steps = 1 if hold == "linear" else 8
        got = ours(
            preset("qian2014", ("command_delay",)), {"command_delay": delay}, CELLS[2], command(2), hold, steps=steps
        )
        assert np.std(got - wanted) < 1e-4 * np.std(wanted)


def _read(effect: Effect) -> frozenset[str]:
    return frozenset().union(*(equation.names for equation in effect.equations))


@pytest.mark.parametrize("output", ["displacement", "load_pressure", "force"])
def test_all_effects_off_is_the_chain_without_them(output, full):
    """The kernel of the whole catalogue, every strength 0, is the chain's own kernel to 1e-12.

    But for effects that act on the rate of the valve's lag or let it act on what it follows: with them steps resolve
    it, which is else advanced exactly, so that the difference is theirs, here of a few to a time constant. In the
    short form pressure and force are those of the effects at their own places: another kernel of the whole catalogue
    would take longest of all to compile.
    """
    places = {"load_pressure": ("pressure",), "force": ("load",)}.get(output, ())
    on = [effect for effect in EFFECTS if full or not places or effect.place in places]
    every = preset("qian2014", tuple(effect.name for effect in on))
    still = preset("qian2014", tuple(effect.name for effect in on if not {"dq", "q1"} & _read(effect)))
    for number, cell in enumerate(CELLS):
        plain = ours(PRESETS["qian2014"], {}, cell, command(number), "linear", output, steps=1)
        for whole, most in ((still, 1e-12), (every, 1e-6)):
            got = ours(whole, {}, cell, command(number), "linear", output, steps=1)
            assert np.std(got - plain) <= most * np.std(plain)


@pytest.mark.parametrize("hold", ["linear", "zoh"])
def test_all_effects_off_is_the_linear_chain(hold):
    """With eight steps a sample it is the exact linear response to 1e-9; with one, to 1e-6."""
    whole = preset("qian2014", tuple(effect.name for effect in EFFECTS))
    chain = PRESETS["qian2014"].chain
    for number, cell in enumerate(CELLS):
        values = {p.name: np.array([p.value]) for p in PRESETS["qian2014"].parameters}
        specimen = {"mL": cell.mass, "k": cell.stiffness, "cL": cell.damping, "Kp": cell.gain, "A": PLANT.A}
        model = chain.linearise(values | {name: np.array([value]) for name, value in specimen.items()})
        exact = respond(discretise(model, linear.SAMPLE_RATE, hold), ends(command(number)))[0]
        for steps, limit in ((8, 1e-9), (1, 1e-6)):
            assert np.std(ours(whole, {}, cell, command(number), hold, steps=steps) - exact) < limit * np.std(exact)


def test_force_and_pressure_agree_with_the_reference():
    """The other outputs, with effects of several places on at once."""
    hidden = {"dead_zone.h": 2e-4, "pressure_flow.r": 2e-7, "cubic_stiffness.k3": 5e10, "sensor_lag.T": 1e-3}
    model = preset("qian2014", tuple(name.partition(".")[0] for name in hidden))
    shown = reference.respond(PLANT, reference.named(hidden), CELLS[0], command(0), "linear")
    for output in ("displacement", "force", "load_pressure"):
        got = ours(model, hidden, CELLS[0], command(0), "linear", output, steps=2)
        wanted = getattr(shown, output)
        assert np.std(got - wanted) < 1e-4 * np.std(wanted)


def test_friction_sticks():
    """A friction force above every driving force holds the rod: it does not creep."""
    u = 1e-6 * command(0) / 1.27e-3
    got = ours(preset("qian2014", ("coulomb_friction",)), {"coulomb_friction": 200.0}, CELLS[1], u, "linear")
    free = ours(PRESETS["qian2014"], {}, CELLS[1], u, "linear")
    assert np.abs(got).max() < 5e-3 * np.abs(free).max()


def test_an_effect_that_finds_nothing_to_act_on_is_refused():
    """A model without a load has no friction; the refusal says so."""
    with pytest.raises(Exception, match="nothing that it could act on"):
        preset("first_order", ("coulomb_friction",))


def test_an_effect_that_redefines_a_state_is_refused_and_told_what_it_may_redefine():
    """The pressure has its rate from the model: what limits it acts on a signal that the rate reads."""
    share = Parameter("share", "s", "1", 0.0, 1.0, 0.0, "share")
    limit = Effect("limit", "pressure", "a limit", share, ("P = P * (1 - s)",))
    with pytest.raises(Unusable, match=r"P is a state.*a signal that the rate of P reads"):
        _ = PRESETS["qian2014"].with_effects((limit,)).chain.signals


def test_a_new_effect_is_one_definition():
    """What a user would add is simulated as it is written, without touching anything else."""
    sag = Effect(
        name="sag",
        place="spool",
        meaning="gain falls with the square of the opening",
        strength=Parameter("depth", "d", "1/m^2", 0.0, 1e3, 0.0, "relative fall for each square metre"),
        texts=("w = w * (1 - d * w**2)",),
    )
    model = PRESETS["qian2014"].with_effects((sag,))
    off = ours(model, {"sag": 0.0}, CELLS[0], command(0), "linear")
    on = ours(model, {"sag": 500.0}, CELLS[0], command(0), "linear")
    plain = ours(PRESETS["qian2014"], {}, CELLS[0], command(0), "linear")
    assert np.std(off - plain) <= 1e-12 * np.std(plain) < 1e-4 * np.std(on - plain)
