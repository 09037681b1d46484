"""The catalogue of effects, in the order in which they act within their place."""

from ident.effect import Effect
from ident.errors import Unusable

EFFECTS: tuple[Effect, ...] = ()


def effect(name: str) -> Effect:
    """The effect called `name`; raises Unusable with the names there are."""
    for known in EFFECTS:
        if known.name == name:
            return known
    names = ", ".join(known.name for known in EFFECTS)
    remedy = f"choose from {names}" if names else "leave it out: this version knows the linear chain only"
    raise Unusable("unknown-effect", f"no effect {name!r}", "effects", remedy)
