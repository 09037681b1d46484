"""The candidates that a regression over terms offers for refits: single terms, and two places with one strength."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.interpretation import interpretation
from ident.diagnosis.discovery.regression import Regression
from ident.diagnosis.discovery.term import Shape, Term, ratio
from ident.diagnosis.discovery.term_to_effect import added, state_line, sticks
from ident.stages import PLACES
from ident.units.quantity import known_powers, shape

_DRIVE = ("controller", "valve", "spool", "flow")  # one input of the machine: of two terms there one is enough


@dataclass(frozen=True)
class TermCandidate:
    """Terms with one strength and a sign each, their result in the regression, and the terms `alike` to the data."""

    terms: tuple[Term, ...]
    signs: tuple[float, ...]
    strength: float
    share: float
    alike: tuple[tuple[Term, ...], ...] = ()

    @property
    def equation(self) -> str:
        """The equations that add the terms."""
        brakes = sticks(self.terms, self.strength)
        states = [state_line(term.state) for term in self.terms if term.state]
        return "; ".join([*states, *(added(t, sign, brakes) for t, sign in zip(self.terms, self.signs, strict=True))])

    def begins_as(self, other: TermCandidate) -> bool:
        """Whether a refit of another leads to the same optimum: one equation, with its shapes at about the same
        values."""
        if self.equation != other.equation or self._knots != other._knots:
            return False
        both = zip(self._shapes, other._shapes, strict=True)
        return all(
            abs(one.value - another.value) <= CRITERIA.discovery.same_shape * float(np.ptp(one.bounds))
            for one, another in both
        )

    @property
    def plain(self) -> bool:
        """Whether it is an equation alone, without shapes and curves."""
        return not self._shapes and not self._knots

    @property
    def _shapes(self) -> list[Shape]:
        return [shape for term in self.terms for shape in term.shapes]

    @property
    def _knots(self) -> list[float]:
        return [knot for term in self.terms if term.curve for knot in term.curve.knots]

    @property
    def simplicity(self) -> tuple[object, ...]:
        """The order of candidates that are as good, the simplest first."""
        text = "".join(term.text for term in self.terms)
        shapes = sum(term.fitted for term in self.terms)
        return len(self.terms), shapes, not interpretation(self.terms), len(text), text


def term_candidates(regression: Regression, units: Mapping[str, str]) -> tuple[tuple[TermCandidate, ...], int]:
    """The terms and pairs with the largest predicted gain, and the number that was compared."""
    classes = regression.classes()
    singles = [
        _single(regression, group) for group in (*classes[: CRITERIA.discovery.classes], *_shaped(regression, classes))
    ]
    pairs, count = _pairs(regression, units)
    return (*singles, *pairs), regression.looked_at + count


def _shaped(regression: Regression, classes: Sequence[Sequence[int]]) -> list[Sequence[int]]:
    """The best class of every kind with shapes that is not tried yet: a refit moves its shapes."""
    seen = {regression.terms[i].kind for group in classes[: CRITERIA.discovery.classes] for i in group}
    more: list[Sequence[int]] = []
    for group in classes[CRITERIA.discovery.classes :]:
        term = regression.terms[group[0]]
        if regression.gains[group[0]] < CRITERIA.discovery.may_win * regression.gains[classes[0][0]]:
            break
        if term.free_shapes and term.kind not in seen:
            seen.add(term.kind)
            more.append(group)
    return more


def _single(regression: Regression, group: Sequence[int]) -> TermCandidate:
    """The plainest term of a class."""
    terms = [regression.terms[i] for i in group]
    best = min(
        range(len(group)), key=lambda i: (not interpretation([terms[i]]), terms[i].free_shapes, len(terms[i].text))
    )
    at = group[best]
    strength, share = float(regression.with_residual[at] / regression.products[at, at]), float(regression.gains[at])
    others = tuple((term,) for i, term in enumerate(terms) if i != best)
    return TermCandidate((terms[best],), (1.0,), strength, share, others)


def _pairs(regression: Regression, units: Mapping[str, str]) -> tuple[list[TermCandidate], int]:
    """Two places with one strength: terms whose strengths have one unit, one where the drive is and one elsewhere.

    The pairs with the largest predicted gain are returned, no two of them alike, and the number of all pairs.
    """
    power = np.diag(regression.products)
    dimensions = np.unique([repr(_dimension(term, units)) for term in regression.terms], return_inverse=True)[1]
    plain = np.array([not term.shapes and not term.in_time and power[i] > 0 for i, term in enumerate(regression.terms)])
    driven = np.array([term.place in _DRIVE for term in regression.terms])
    rows, columns = np.flatnonzero(plain & driven), np.flatnonzero(plain & ~driven)
    of_rows, of_columns = np.nonzero(dimensions[rows, None] == dimensions[columns])
    i, j = np.tile(rows[of_rows], 2), np.tile(columns[of_columns], 2)
    signs = np.repeat([1.0, -1.0], len(of_rows))
    both = power[i] + power[j] + 2 * signs * regression.products[i, j]
    sound = both > (1.0 - CRITERIA.discovery.same_class) * (power[i] + power[j])  # else the two are one class
    with_residual = regression.with_residual[i] + signs * regression.with_residual[j]
    share = regression.share(np.where(sound, with_residual**2 / np.where(sound, both, 1.0), 0.0))

    def alike(k: int, other: int) -> bool:
        (a, b, s), (c, d, t) = ((i[n], j[n], signs[n]) for n in (k, other))
        product = regression.products
        common = product[a, c] + t * product[a, d] + s * product[b, c] + s * t * product[b, d]
        return bool(abs(common) > CRITERIA.discovery.same_class * np.sqrt(both[k] * both[other]))

    taken: list[int] = []
    least = CRITERIA.discovery.may_win * share.max(initial=0.0)
    for k in map(int, np.argsort(-share, kind="stable")):
        if len(taken) == CRITERIA.discovery.of_a_kind or not share[k] > least:
            break
        if not any(alike(k, other) for other in taken):
            taken.append(k)
    return [_pair(regression, (i[k], j[k]), signs[k], with_residual[k] / both[k], share[k]) for k in taken], len(i)


def _pair(regression: Regression, of: tuple[int, int], sign: float, strength: float, share: float) -> TermCandidate:
    """Two terms, the second with a sign, in the order of their places."""
    both = ((regression.terms[of[0]], 1.0), (regression.terms[of[1]], float(sign)))
    terms, signs = zip(*sorted(both, key=lambda one: PLACES.index(one[0].place)), strict=True)
    return TermCandidate(terms, tuple(signs[0] * one for one in signs), float(signs[0] * strength), float(share))


def _dimension(term: Term, units: Mapping[str, str]) -> object:
    """The dimension of a term's strength."""
    unit = ratio(units[term.at], term.unit)
    return shape(known_powers(unit, term.text), term.text)
