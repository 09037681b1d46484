"""A term as an effect of its own: the definition that a user could have written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ident.diagnosis.proposals.terms import LIMIT, Signals, Term, ratio

_REACH = 4.0  # times what makes a term as large as the signal that it adds to: bounds of a strength
_FAR = 10.0  # times what a regression makes of a strength
STRENGTH = "s"


def added(term: Term, sign: float, sticks: bool = False) -> str:
    """The equation that adds a term, or takes it off; friction that sticks adds to what dry friction takes at most."""
    at, text = (LIMIT, term.limit) if sticks else (term.at, term.text)
    return f"{at} = {at} {'+' if sign > 0 else '-'} {STRENGTH} * ({text})"


def sticks(terms: Sequence[Term], strength: float) -> bool:
    """Whether terms are dry friction, which brakes.

    What drives where it should brake, as friction that is less than the model's does, is a force like any other.
    """
    return len(terms) == 1 and bool(terms[0].limit) and strength > 0


def definition(
    name: str,
    terms: Sequence[Term],
    signs: Sequence[float],
    strength: float,
    typical: Signals,
    units: Mapping[str, str],
) -> dict[str, Any]:
    """The definition of an effect with one strength for one term or for several, each with its sign.

    `strength` is about what it will be, `typical` are samples of the signals, `units` as the chain has them.
    """
    first, brakes = terms[0], sticks(terms, strength)
    lines: list[str] = []
    shapes: dict[str, Any] = {}
    for term, sign in zip(terms, signs, strict=True):
        lines += term.memory
        lines.append(added(term, sign, brakes))
        for shape in term.shapes:
            low, high = shape.bounds
            shapes[shape.symbol] = {"unit": shape.unit, "lower": low, "upper": high, "value": shape.value}
    shown = first.samples(typical, 1.0) if first.worked_out is None else typical[first.of[0]]
    size = float(np.sqrt(np.mean(shown**2)))
    bound = max(_REACH * float(np.std(typical[first.at])) / max(size, 1e-300), _FAR * abs(strength))
    found: dict[str, Any] = {
        "name": name, "place": terms[-1].place, "equation": lines,
        "strength": {"symbol": STRENGTH, "unit": ratio(units[first.at], first.unit), "lower": 0.0 if brakes else -bound,
                     "upper": bound},
        "meaning": "proposed by search", "source": "proposed by search",
    }  # fmt: skip
    return found | ({"shape": shapes} if shapes else {})
