"""A model is a list of stages: they bring parameters and ranges, and it may state others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.comparison.compare import modelled
from ident.effects import CATALOGUE, effect
from ident.errors import Unusable
from ident.fit.settings import Settings
from ident.parameter import Parameter
from ident.presets import PRESETS, Preset, preset
from ident.presets.effect_scales import scale_of
from ident.presets.search_plan import SearchPlan
from ident.stages import (
    COMPRESSIBLE,
    FIRST_ORDER_VALVE,
    IDEAL_SENSOR,
    LINEAR_FLOW,
    MASS_SPRING_DAMPER,
    PROPORTIONAL,
    RIGID_SPOOL,
    SQUARE_ROOT_FLOW,
    Quantity,
    Scale,
)
from ident.stages.stage import stage
from ident.workflows import identify
from tests.blind.machines import matrix_of
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

NOISE = 0.005
STOCK = (
    PROPORTIONAL,
    FIRST_ORDER_VALVE,
    RIGID_SPOOL,
    LINEAR_FLOW,
    COMPRESSIBLE,
    MASS_SPRING_DAMPER,
    IDEAL_SENSOR,
)


def put_together(*stages, **stated) -> Preset:
    """A preset of stages, with nothing stated but what is given."""
    return Preset("stock", "Stock", "none", Chain(stages or STOCK, {"displacement": "y"}), **stated)


def searched(scale: Scale) -> dict[str, SearchPlan]:
    """What a preset states whose search rescales one parameter."""
    return {"search": SearchPlan(rescaled=(scale,))}


@pytest.fixture(scope="module")
def data():
    """Four runs of the paper's machine from the reference."""
    records = reference.measure_all(reference.named({}), linear.trials()[::24], seconds=1.0, noise=NOISE, seed=3)
    return matrix_of(records, linear.Plant())


@pytest.mark.parametrize("flow", [LINEAR_FLOW, SQUARE_ROOT_FLOW])
def test_stages_alone_are_a_model_that_moves(flow, data):
    """Put together without a word more it is linearised and simulated at the values that the stages bring."""
    model = put_together(*(flow if one is LINEAR_FLOW else one for one in STOCK))
    assert [p.name for p in model.parameters] == ["tau", "Z0", "Ka", "Cl", "m0", "c0"]
    values = {parameter.in_equations: parameter.value for parameter in model.parameters}
    run = data.runs[0]
    assert np.isfinite(model.chain.linearise(conditions(run, data.actuator) | values).system).all()
    moved = modelled(model, values, replace(data, runs=(run,)))[run.id]
    assert np.isfinite(moved).all()
    assert np.ptp(moved) > 0


def test_stages_alone_are_searched_over_the_ranges_that_they_bring(data, monkeypatch):
    """They are measured by the runs: the machine is found without a bound that was stated for it."""
    monkeypatch.setitem(PRESETS, "stock", put_together())
    found = identify(data, Settings(model="stock", seed=2, options={"population": 100, "generations": 20, "elite": 4}))
    assert found.error["fit"] < 1.05 * NOISE
    assert found.values["Z0"] == pytest.approx(2.592e-6, rel=0.02)


def test_what_a_preset_states_takes_the_place_of_what_its_stages_bring():
    other = Parameter("Ka", "K", "m^3/Pa", 1e-14, 1e-12, 1e-13, "as the paper has it", "paper")
    model = put_together(
        stated=(other,), listed=("m0",), search=SearchPlan(order=("c0",), rescaled=(Scale("Z0", "A**2", 1.0, 2.0),))
    )
    assert [p.name for p in model.parameters] == ["m0", "Ka", "tau", "Z0", "Cl", "c0"]
    assert model.parameter("Ka") == other
    scales = {scale.name: scale for scale in model.scales}
    assert scales["Z0"].text == "A**2"
    assert list(scales) == ["m0", "c0", "Ka", "tau", "Z0", "Cl"]  # c0 is measured by m0


def test_scales_that_a_preset_measures_in_a_circle_are_refused():
    """The stages measure c0 by m0."""
    with pytest.raises(Unusable, match="m0 → c0 → m0: each is measured by the next"):
        put_together(search=SearchPlan(rescaled=(Scale("m0", "c0 / W", 0.1, 10.0),)))


@pytest.mark.parametrize(
    ("stages", "stated", "what"),
    [
        (STOCK[:-2] + STOCK[-1:], {}, "no stage brings X, v, read at pressure, sensor"),
        (
            STOCK,
            searched(Scale("Ka", "A**2 / k0", 0.1, 10.0)),
            "no stage brings k0, read by a scale",
        ),
        (STOCK, {"listed": ("Z9",)}, "no stage brings Z9, which it states"),
        (STOCK, searched(Scale("Z9", "1", 0.1, 10.0)), "no stage brings Z9, which it states"),
    ],
)
def test_what_no_stage_brings_is_refused(stages, stated, what):
    with pytest.raises(Unusable, match=what):
        put_together(*stages, **stated)


def test_two_stages_that_mean_different_parameters_by_one_name_are_refused():
    lagging = Parameter("tau", "τ", "s", 1e-3, 1.0, 0.1, "time constant of another lag")
    lag = stage(
        "spool",
        (Quantity("w", "m", "opening"),),
        ("w' = (q - w) / tau", "a second lag"),
        parameters=(lagging,),
        scales=(Scale.by_bounds(lagging),),
    )
    with pytest.raises(Unusable, match="its stages mean different parameters by tau"):
        put_together(*(lag if one is RIGID_SPOOL else one for one in STOCK))


@pytest.mark.parametrize("name", PRESETS)
def test_a_search_can_follow_its_order(name):
    """Each range is measured by what stands before it, so that values follow from the axes one by one."""
    placed: set[str] = set()
    own = {scale.name for scale in PRESETS[name].scales}
    for scale in PRESETS[name].scales:
        assert scale.equation.names & own <= placed
        placed.add(scale.name)
    assert placed == {parameter.in_equations for parameter in PRESETS[name].parameters}


LOOP = "machine:controller=p,load=mass_spring_damper,sensor=displacement"


@pytest.mark.parametrize("model", ["drive", "motor", LOOP, "machine:load=mass_spring_damper,sensor=velocity"])
def test_dry_friction_is_measured_by_what_drives_a_machine(model):
    """By the fitted damping it could never take the place of that: its bound fell with it."""
    friction = next(effect for effect in CATALOGUE if effect.name == "coulomb_friction")
    scales = preset(model).with_effects((friction,)).scales
    (scale,) = (scale for scale in scales if scale.name == "coulomb_friction__force")
    assert not scale.equation.names & {"c0", "m0"}
    assert scale.equation.names & {"M", "U"}


def test_a_play_in_a_loop_may_be_wider_than_the_drive_signals_deviation():
    """A sine of that deviation still comes through, at its peaks."""
    play = next(effect for effect in CATALOGUE if effect.name == "backlash")
    (scale,) = (s for s in preset(LOOP).with_effects((play,)).scales if s.name == "backlash__half_width")
    assert 1.0 < scale.upper * float(scale.equation.value({"Kp": 2.0, "U": 1.0})) / 2.0 < np.sqrt(2)


@pytest.mark.parametrize(
    ("unit", "measured", "searched"),
    [
        ("N*s^2/m^2", "(1)/V**2", 10.0),
        ("N*s^3/m^3", "(1)/V**3", 10.0),
        ("N/m^2", "(1)/L**2", 1.0),
        ("N/m^4", "(1)/L**4", 1.0),
        ("m^3/(s*Pa^3)", "A*V/((1)/A)**3", 1.0),
    ],
)
def test_a_force_or_a_flow_for_a_power_of_what_it_follows_is_searched_by_its_size(unit, measured, searched):
    """Whatever the power: a strength of a unit that no effect had before needs no line of a table."""
    strength = Parameter("coefficient", "c", unit, 0.0, 1.0, 0.0, "a force")
    damping = replace(effect("quadratic_damping"), strength=strength, texts=("R = R + c * v",))
    found = scale_of(damping, strength, {"D": "1", "F": "1", "Z": "1", "T": "1"})
    assert (found.text, found.upper) == (measured, searched)
