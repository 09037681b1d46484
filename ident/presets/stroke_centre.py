"""Effects that act to both sides of a middle, such as stops at both ends of a stroke: put about that of a machine."""

from __future__ import annotations

from dataclasses import replace

from ident.effects.effect import Effect
from ident.parameter import Starts


def about_stroke_centre(effect: Effect, middle: float) -> Effect:
    """The effect with its middle there, where it has one that nobody stated."""
    if effect.own or not middle:
        return effect
    reach = 2.0 * abs(middle)
    shape = tuple(
        replace(one, value=middle, lower=min(one.lower, -reach), upper=max(one.upper, reach))
        if one.start is Starts.STROKE_MIDDLE
        else one
        for one in effect.shape
    )
    return replace(effect, shape=shape)
