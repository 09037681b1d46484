"""A term as an effect of its own: the definition that a user could have written."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.term import CURVE, LIMIT, STATE, Signals, Term, ratio
from ident.effects.effect import Effect
from ident.rounding import TINY

STRENGTH = "s"


def added(term: Term, sign: float, sticks: bool = False) -> str:
    """The equation that adds a term, or takes it off; friction that sticks adds to the largest dry friction."""
    at, text = (LIMIT, term.limit) if sticks else (term.at, term.text)
    return f"{at} = {at} {'+' if sign > 0 else '-'} {STRENGTH} * ({text})"


def sticks(terms: Sequence[Term], strength: float) -> bool:
    """Whether terms are dry friction, which brakes.

    A friction that is less than the model's drives the mass, and is a force like any other.
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

    `strength` is its value in the regression, `typical` are samples of the signals, `units` are the chain's units.
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
    as_large = float(np.std(typical[first.at])) / max(size, TINY)
    reach = 0.0 if first.in_time else CRITERIA.discovery.strength_reach * as_large
    bound = max(reach, CRITERIA.discovery.strength_far * abs(strength))
    found: dict[str, Any] = {
        "name": name,
        "place": terms[-1].place,
        "equation": lines,
        "strength": {
            "symbol": STRENGTH,
            "unit": ratio(units[first.at], first.unit),
            "lower": 0.0 if brakes else -bound,
            "upper": bound,
        },
        "meaning": "proposed by search",
        "source": "proposed by search",
    }
    if first.curve is not None:
        knots, values, steep = list(first.curve.knots), list(first.curve.values), CRITERIA.discovery.curve_steep
        found["curve"] = {
            "symbol": CURVE,
            "of": first.curve.of,
            "knots": knots,
            "values": values,
            "unit": "1",
            "lower": -steep,
            "upper": steep,
        }
    state = next((term.state for term in terms if term.state), "")
    return (
        found | ({"shape": shapes} if shapes else {}) | ({"state": {"symbol": STATE, "rate": state}} if state else {})
    )


def searched_bounds(own: Mapping[str, Any], terms: Sequence[Term]) -> dict[str, tuple[float, float]]:
    """The bounds of the numbers that a refit moves in addition to the strength, by name."""
    free = [shape.symbol for term in terms for shape in term.shapes if shape.free]
    found = {f"{own['name']}.{symbol}": _bounds(own["shape"][symbol]) for symbol in free}
    for curve in (term.curve for term in terms if term.curve is not None):
        moved = (n for n in range(len(curve.knots)) if n != curve.held)
        found |= {f"{own['name']}.{CURVE}_{n + 1}": _bounds(own["curve"]) for n in moved}
    return found


def curves(own: Mapping[str, Any]) -> dict[str, str]:
    """The signal of an effect's curve, by the curve's symbol."""
    return {own["curve"]["symbol"]: own["curve"]["of"]} if "curve" in own else {}


def equation_text(own: Mapping[str, Any]) -> str:
    """The equations as text, the rate of a state of its own first: a curve h of P is written h(P)."""
    text = "; ".join(lines_of(own))
    for symbol, of in curves(own).items():
        text = re.sub(rf"\b{symbol}\b", f"{symbol}({of})", text)
    return text


def lines_of(own: Mapping[str, Any]) -> list[str]:
    """The equations of an effect, first the equation of its own state."""
    return [*([state_line(own["state"]["rate"])] if "state" in own else []), *own["equation"]]


def state_line(rate: str) -> str:
    """The equation of a state of its own."""
    return f"{STATE}' = {rate}"


def _bounds(of: Mapping[str, Any]) -> tuple[float, float]:
    return of["lower"], of["upper"]


def as_fitted(own: Mapping[str, Any], effect: Effect, values: Mapping[str, float]) -> dict[str, Any]:
    """The definition with the fitted values of its shapes, by the equations' names: in an added effect they are fixed.

    The bounds of the strength are widened until the fitted strength lies well within them.
    """
    far, of = CRITERIA.discovery.strength_far * abs(values[effect.added[0].in_equations]), own["strength"]
    found = {
        **own,
        "strength": {**of, "lower": min(of["lower"], -far) if of["lower"] else 0.0, "upper": max(of["upper"], far)},
    }
    at = {parameter.symbol: values[parameter.in_equations] for parameter in effect.added[1:]}
    if "shape" in own:
        found["shape"] = {symbol: {**of, "value": at[symbol]} for symbol, of in own["shape"].items()}
    if "curve" in own:
        count = len(own["curve"]["knots"])
        found["curve"] = {**own["curve"], "values": [at[f"{CURVE}_{n}"] for n in range(1, count + 1)]}
    return found
