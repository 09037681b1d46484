"""The drawing of a fit's chain: it names signals of its model, and offers what a fit of it would take."""

from __future__ import annotations

import pytest

from app.pages.chain_view import drawing
from ident.effects import CATALOGUE
from ident.fit.identification import check_settings
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.presets import PRESETS, preset

AT_LEAST = {
    "qian2014": 54,
    "first_order": 19,
    "two_tanks": 20,
    "drive": 29,
    "open_valve": 51,
    "pressure_drive": 38,
    "motor": 38,
    "sprung_motor": 38,
    "position_servo": 40,
    "speed_servo": 40,
    "moving_base": 29,
    "specimen": 18,
    "force_loop": 54,
    "kononykhin": 8,
    "strano": 49,
}
LOOPS = {
    "qian2014": {"v", "y"}, "first_order": set(), "drive": set(), "open_valve": {"v"}, "motor": set(),
    "pressure_drive": set(), "sprung_motor": set(), "position_servo": {"y"}, "speed_servo": {"y"},
    "two_tanks": set(), "specimen": set(),
    "moving_base": set(), "force_loop": {"v", "y"}, "kononykhin": set(), "strano": {"P", "v", "y"},
}  # fmt: skip


def fit(model: str, *effects: str) -> FitResult:
    settings = Settings(model=model, effects=effects).to_json()
    return FitResult(
        model=model,
        effects=effects,
        correlation={},
        method="ga",
        seed=0,
        evaluations=1,
        seconds=1.0,
        version="0",
        parameters={},
        determined=(),
        undetermined=(),
        error={},
        offset={},
        noise_floor={},
        runs=(),
        data_hash="0",
        settings=settings,
    )


@pytest.mark.parametrize("model", PRESETS)
def test_each_signal_drawn_is_one_that_a_place_hands_on(model):
    """The place publishes it and the next one reads it; back runs what the model feeds back."""
    drawn, stages = drawing(fit(model)), PRESETS[model].chain.stages
    for place, behind in zip(drawn.places, drawn.places[1:], strict=False):
        published = {quantity.name for stage in stages if stage.place == place.name for quantity in stage.publishes}
        lines = [line for stage in stages if stage.place == behind.name for line in stage.equations]
        assert place.signal in published & frozenset().union(*(line.names for line in lines))
    assert {line.signal for line in drawn.back} == LOOPS[model]


@pytest.mark.parametrize(("model", "bent"), [("qian2014", ()), ("kononykhin", ("spool", "flow", "load"))])
def test_a_place_is_called_linear_where_its_equations_are(model, bent):
    """A bench's play, speed characteristic and share of the speed are not; friction that is off does not count."""
    assert tuple(place.name for place in drawing(fit(model)).places if place.core == "nonlinear") == bent


def test_what_an_effect_feeds_back_is_drawn_with_it():
    """The flow depends on the load pressure where an effect makes it."""
    assert {line.signal for line in drawing(fit("qian2014", "pressure_flow")).back} == {"P", "v", "y"}


@pytest.mark.parametrize("model", PRESETS)
def test_every_effect_that_is_offered_is_one_that_a_fit_takes(model):
    """And the other way round."""
    offered = {one.name for place in drawing(fit(model)).places for one in place.off}
    assert len(offered) >= AT_LEAST[model]
    for name in offered:
        check_settings(Settings(model=model, effects=(name,)))
    assert offered == {effect.name for effect in CATALOGUE if takes(model, effect.name)}


def takes(model: str, effect: str) -> bool:
    """Whether the model can be made with an effect, its signals in an order."""
    try:
        return bool(preset(model, (effect,)).chain.signals)
    except ValueError:
        return False
