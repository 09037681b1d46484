"""A name in, a model out: each a paper's choice of stages, with its citation."""

from collections.abc import Sequence
from functools import cache, lru_cache
from importlib import import_module

from ident.effects import CATALOGUE, effect
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.presets.description import is_machine
from ident.presets.machine import machine
from ident.presets.preset import Preset
from ident.words.nearest import did_you_mean

_FILES = (
    "qian2014",
    "first_order",
    "drive",
    "open_valve",
    "pressure_drive",
    "motor",
    "sprung_motor",
    "position_servo",
    "speed_servo",
    "two_tanks",
    "moving_base",
    "specimen",
    "force_loop",
    "kononykhin",
    "strano",
)
"""Each with the preset of its name."""
_PRESETS: tuple[Preset, ...] = tuple(getattr(import_module(f"ident.presets.{file}"), file.upper()) for file in _FILES)
PRESETS = {preset.name: preset for preset in _PRESETS}


def preset(name: str, effects: Sequence[str] = (), custom: Sequence[Effect] = ()) -> Preset:
    """The preset called `name` with these effects, of the catalogue or among `custom`; those come last.

    A machine put together from stages has its description for a name. Raises Unusable with the nearest name, or
    where two stages do not go together.
    """
    if name not in PRESETS and not is_machine(name):
        raise Unusable("unknown-model", f"no model {name!r}", "model", did_you_mean(name, PRESETS))
    return _with_effects(name, frozenset(effects), tuple(custom))


@lru_cache(maxsize=256)
def _with_effects(name: str, effects: frozenset[str], custom: tuple[Effect, ...]) -> Preset:
    own = {known.name for known in custom}
    if len(own) < len(custom):
        raise Unusable("name-taken", "two effects have the same name", "custom effects", "rename one of them")
    for wanted in sorted(effects - own):
        effect(wanted, own)
    bare = machine(name) if is_machine(name) else PRESETS[name]
    return bare.with_effects(tuple(known for known in (*CATALOGUE, *custom) if known.name in effects))


@cache
def parameter_names() -> tuple[str, ...]:
    """The names of every parameter of a preset and of an effect of the catalogue, each once."""
    of_models = (parameter.name for model in PRESETS.values() for parameter in model.parameters)
    return tuple(dict.fromkeys((*of_models, *(parameter.name for known in CATALOGUE for parameter in known.added))))


__all__ = ["PRESETS", "Preset", "parameter_names", "preset"]
