"""The catalogue of effects, in the order in which they act within their place."""

from ident.effect import Effect

EFFECTS: tuple[Effect, ...] = ()
