"""The models by name: each a paper's choice of stages, with its citation."""

from ident.errors import Unusable
from ident.presets.first_order import FIRST_ORDER
from ident.presets.preset import Preset, Scale
from ident.presets.qian2014 import QIAN2014

PRESETS: dict[str, Preset] = {preset.name: preset for preset in (QIAN2014, FIRST_ORDER)}


def preset(name: str) -> Preset:
    """The preset called `name`; raises Unusable with the names there are."""
    if name not in PRESETS:
        raise Unusable("unknown-model", f"no model {name!r}", "model", f"choose from {', '.join(PRESETS)}")
    return PRESETS[name]


__all__ = ["PRESETS", "Preset", "Scale", "preset"]
