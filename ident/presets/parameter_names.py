"""The names of parameters, whatever the model."""

from functools import cache

from ident.effects import CATALOGUE
from ident.presets import PRESETS


@cache
def parameter_names() -> tuple[str, ...]:
    """The names of every parameter of a preset and of an effect of the catalogue, each once."""
    of_models = (parameter.name for model in PRESETS.values() for parameter in model.parameters)
    return tuple(dict.fromkeys((*of_models, *(parameter.name for effect in CATALOGUE for parameter in effect.added))))
