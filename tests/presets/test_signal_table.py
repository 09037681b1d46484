"""The table of a model's signals is what its stages and the library of effects say."""

from __future__ import annotations

import pytest

from ident.effects import CATALOGUE
from ident.presets import PRESETS
from ident.presets.signal_table import signal_table


@pytest.mark.parametrize("name", PRESETS)
def test_every_signal_of_a_model_stands_in_its_table_once(name):
    model = PRESETS[name]
    assert {one.name: one.unit for one in signal_table(model)} == dict(model.chain.units)
    assert len(signal_table(model)) == len(model.chain.units)


@pytest.mark.parametrize("name", PRESETS)
def test_an_effect_changes_what_arises_at_its_place_or_before_it(name):
    """As the table says of every signal; each effect that a model takes changes one at least."""
    places = {effect.name: effect.place for effect in CATALOGUE}
    changed = {effect for one in signal_table(PRESETS[name]) for effect in one.changed_by}
    for one in signal_table(PRESETS[name]):
        assert {places[effect] for effect in one.changed_by} <= set(one.changed_at)
    assert changed == {effect.name for effect in CATALOGUE if PRESETS[name].takes(effect)}


def test_a_signal_says_where_it_arises_and_what_it_is():
    found = {one.name: one for one in signal_table(PRESETS["qian2014"])}
    flow = found["Q"]
    assert (flow.unit, flow.place, flow.equation) == ("m^3/s", "flow", "Q = Z0 / A * w")
    assert flow.changed_at == ("flow", "pressure", "load", "sensor")
    assert "pressure_flow" in flow.changed_by
    assert (found["xL"].symbol, found["y_fb"].symbol, found["q1"].symbol) == ("x_L", "y_fb", "q_1")
