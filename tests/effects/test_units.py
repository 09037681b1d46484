"""What an effect acts on is of the unit that its strength is made for, in every model that takes it."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from ident.chain.chain import FORCE, INPUT, INPUT_RATE
from ident.chain.conditions import CONDITIONS
from ident.custom.definition import read_effect
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.equations.grammar import TIME
from ident.errors import Unusable
from ident.presets import PRESETS, Preset
from ident.presets.drive import UNDER_CONTROL
from tests.effects import dimensions

MODELS = {**PRESETS, "drive under control": UNDER_CONTROL}
COMMAND = {"current": "1", "drive_force": "N", "command": "m", "velocity": "m/s"}
_RATED = frozenset({("e", "m"), ("dq", "m/s"), ("q", "m"), ("w", "m")})
_OF_VALVE = frozenset({("q", "1")})
OTHER_UNIT = {
    "first_order": _OF_VALVE,
    "two_tanks": _OF_VALVE,
    "force_loop": _OF_VALVE,
    "qian2014": _OF_VALVE,
    "open_valve": _OF_VALVE,
    "motor": _OF_VALVE,
    "sprung_motor": _OF_VALVE,
    "pressure_drive": _OF_VALVE,
    "position_servo": _OF_VALVE,
    "speed_servo": _OF_VALVE,
    "kononykhin": _RATED,
    "strano": _OF_VALVE,
    "drive under control": frozenset({("e", "m")}),
}
"""Signals of a model, with the unit in which effects redefine them elsewhere: they are rated currents, drive signals
or newtons."""
NULL_BIAS: Effect = next(effect for effect in CATALOGUE if effect.name == "null_bias")
EACH = pytest.mark.parametrize("name", MODELS)


def published(model: Preset) -> dict[str, str]:
    """The signals and states of a model with their units."""
    return {quantity.name: quantity.unit for stage in model.chain.stages for quantity in stage.publishes}


def units(model: Preset) -> dict[str, dimensions.Dimension]:
    """Everything that an equation may read there."""
    command = "m/s^2" if "m/s^2" in model.data.command_units else COMMAND[model.data.driven_by]
    inputs = {INPUT: command, INPUT_RATE: "1/s" if command == "1" else f"{command}/s", FORCE: "N", TIME: "s"}
    known = {**inputs, **{q.name: q.unit for q in CONDITIONS.values()}, **published(model)}
    return {
        name: dimensions.of(re.sub(r"\bV\b", "m", unit))  # a metre stands for a volt of the drive signal
        for name, unit in (known | {p.in_equations: p.unit for p in model.parameters}).items()
    }


@EACH
def test_every_model_keeps_its_units(name):
    """Each equation of a stage is of the unit that the stage gives to what it defines."""
    model = MODELS[name]
    dimensions.check((line for stage in model.chain.stages for line in stage.equations), units(model))


def test_an_effect_names_the_unit_of_each_signal_that_it_redefines():
    """Of all signals of all models, neither more nor less."""
    signals = set().union(*(published(model) for model in MODELS.values()))
    targets = {effect.name: {equation.target for equation in effect.equations} & signals for effect in CATALOGUE}
    assert {effect.name: set(effect.units) for effect in CATALOGUE} == targets


@EACH
def test_a_model_takes_an_effect_where_its_signals_have_the_effects_units(name):
    """The equations keep their units in every model that takes it; one with other units says which."""
    model, refused = MODELS[name], {}
    for effect in CATALOGUE:
        try:
            model.with_effects((effect,))
        except Unusable as refusal:
            refused[effect.name] = refusal
        else:
            own = {p.symbol: dimensions.of(p.unit) for p in effect.parameters}
            dimensions.check(effect.equations, units(model) | own)
    assert {refusal.code for refusal in refused.values()} <= {"effect-does-not-fit"}
    for_units = {one for one, refusal in refused.items() if "it redefines" in refusal.what}
    in_other_units = {effect.name for effect in CATALOGUE if OTHER_UNIT.get(name, set()) & {*effect.units.items()}}
    assert for_units <= in_other_units <= refused.keys()


def test_units_that_are_mixed_are_seen():
    """The check above is not blind: a strength of another unit, and a signal that stands for another."""
    known = units(PRESETS["qian2014"])
    for text, unit in (("w = w + b", "m/s"), ("w = w / (1 + b * w)", "m"), ("R = R + b * v * abs(v)", "N*s/m")):
        effect = replace(NULL_BIAS, texts=(text,), strength=replace(NULL_BIAS.strength, unit=unit))
        with pytest.raises(dimensions.Mixed):
            dimensions.check(effect.equations, known | {"b": dimensions.of(unit)})


def test_the_refusal_names_signal_and_units():
    """In rated currents a signal is a plain number."""
    with pytest.raises(Unusable, match="it redefines w in m, which is a plain number here"):
        PRESETS["kononykhin"].with_effects((NULL_BIAS,))
    with pytest.raises(Unusable, match="it redefines w in N, which is in m here"):
        PRESETS["qian2014"].with_effects((replace(NULL_BIAS, units={"w": "N"}),))


def test_an_effect_of_the_user_is_of_the_model_that_it_was_written_for():
    """The same text for metres and for rated currents; neither model takes the other's."""
    text = {
        "name": "bias",
        "place": "spool",
        "equation": "w = w + b",
        "strength": {"symbol": "b", "unit": "1", "lower": 0, "upper": 1},
    }
    of = {name: read_effect(text, model=name) for name in ("qian2014", "kononykhin")}
    assert {name: dict(effect.units) for name, effect in of.items()} == {
        "qian2014": {"w": "m"},
        "kononykhin": {"w": "1"},
    }
    for name, other in (("qian2014", "kononykhin"), ("kononykhin", "qian2014")):
        assert PRESETS[name].with_effects((of[name],)).effects == (of[name],)
        with pytest.raises(Unusable, match="it redefines w"):
            PRESETS[name].with_effects((of[other],))
