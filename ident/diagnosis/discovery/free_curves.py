"""A free curve where no formula is known yet: the missing term at a place against one signal, drawn through knots.

A curve through k knots is k columns of the regression over terms: hats, 1 at their own knot and 0 at the others. With
A and b their products with each other and with the residual, a place and a signal explain together

    bᵀ A⁺ b / |r|²

of it, by the values A⁺ b at the knots. ``at + s h(a)`` adds a curve of a signal a, ``at + s b h(a)`` adds a signal b
with a gain that is a curve of a; for dry friction of the moving mass b is the sign of its speed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.regression import Regression
from ident.diagnosis.discovery.term import Curve, Term
from ident.diagnosis.discovery.term_candidate import TermCandidate
from ident.diagnosis.discovery.term_library import TermLibrary
from ident.rounding import TINY
from ident.units.grammar import powers_of

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FreeCurve:
    """The signal of a curve, its knots, and the term that has the curve."""

    of: str
    knots: tuple[float, ...]
    term: Term

    def hats(self) -> list[Term]:
        """The columns of the curve in the regression, one for each knot."""
        values = np.eye(len(self.knots))
        return [self.drawn(row) for row in values.tolist()]

    def drawn(self, values: Sequence[float], held: int = 0) -> Term:
        """The term with these values at the knots."""
        return replace(self.term, curve=Curve(self.of, self.knots, tuple(values), held))


def free_curves(library: TermLibrary) -> list[FreeCurve]:
    """Every curve for the places of a chain."""
    return list(_all(library))


def _all(library: TermLibrary) -> Iterator[FreeCurve]:
    for at, place in library.places.items():
        for of in library.signals[at]:
            x = library.typical[of]
            knots = _knots(x)
            if len(knots) < CRITERIA.discovery.fewest_knots:
                continue
            for by, text in _multiplied(place, at, of, library.signals[at]):
                unit = powers_of(library.units[by]) or {} if by and text != "sgn(v) * h" else {}
                named = (by, of) if by else (of,)
                yield FreeCurve(of, knots, Term(place, at, text, "free curve", named, dict(unit)))


def _multiplied(place: str, at: str, of: str, signals: Sequence[str]) -> Iterator[tuple[str, str]]:
    """The signal that a curve multiplies, "" for none, and the term's text."""
    yield "", "h"
    if at != of and at in signals:
        yield at, f"{at} * h"
    if place == "load" and of != "v" and "v" in signals:
        yield "v", "sgn(v) * h"


def _knots(x: Array) -> tuple[float, ...]:
    return tuple(np.unique(np.quantile(x, CRITERIA.discovery.knots)).tolist())


def offered(regression: Regression, curves: Sequence[FreeCurve]) -> tuple[TermCandidate, ...]:
    """The curves that explain most, no two of them alike; the terms of the regression are the hats of all curves."""
    ends = np.cumsum([len(curve.knots) for curve in curves])
    values = [
        _values(regression, np.arange(end - len(curve.knots), end)) for curve, end in zip(curves, ends, strict=True)
    ]
    gains = regression.share(np.array([float(regression.with_residual[at] @ value) for at, value in values]))
    taken: list[int] = []
    for k in map(int, np.argsort(-gains, kind="stable")):
        if (
            len(taken) < CRITERIA.discovery.of_a_kind
            and gains[k] > 0
            and not any(_cosine(regression, values[k], values[i]) > CRITERIA.discovery.same_class for i in taken)
        ):
            taken.append(k)
    return tuple(_candidate(regression, curves[k], *values[k], float(gains[k])) for k in taken)


def _values(regression: Regression, at: NDArray[np.intp]) -> tuple[NDArray[np.intp], Array]:
    """The indices of a curve's hats, and the values at its knots that explain most."""
    products = regression.products[np.ix_(at, at)]
    return at, np.linalg.pinv(products, rcond=CRITERIA.evidence.dependent, hermitian=True) @ regression.with_residual[
        at
    ]


def _cosine(
    regression: Regression, one: tuple[NDArray[np.intp], Array], other: tuple[NDArray[np.intp], Array]
) -> float:
    (i, a), (j, b) = one, other
    powers = [float(v @ regression.products[np.ix_(k, k)] @ v) for k, v in (one, other)]
    return abs(float(a @ regression.products[np.ix_(i, j)] @ b)) / max(float(np.sqrt(powers[0] * powers[1])), TINY)


def _candidate(
    regression: Regression, curve: FreeCurve, at: NDArray[np.intp], values: Array, share: float
) -> TermCandidate:
    """A curve that is 1 at the knot where its value explains most: the strength is that value."""
    held = int(np.argmax(values**2 * np.diag(regression.products)[at]))
    strength = float(values[held])
    return TermCandidate((curve.drawn((values / strength).tolist(), held),), (1.0,), strength, share)
