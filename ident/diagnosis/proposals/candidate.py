"""What a regression over terms offers to be tried: single terms, and two places with one strength."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ident.diagnosis.proposals.meanings import meaning
from ident.diagnosis.proposals.own import added
from ident.diagnosis.proposals.regression import Regression
from ident.diagnosis.proposals.terms import Term, ratio
from ident.stages import PLACES
from ident.units.quantity import known_powers, shape

_TRIED, _PAIRS, _PAIRED = 6, 3, 12  # single terms and pairs that are refitted, and terms that are paired with all
_MAY_WIN = 0.5  # times the best one's promise, which a shape that is not yet where it belongs may keep
_DRIVE = ("controller", "valve", "spool", "flow")  # one input of the machine: of two terms there one is enough


@dataclass(frozen=True)
class Candidate:
    """Terms with one strength, a sign each, and what the regression makes of them; `alike` cannot be told from them."""

    terms: tuple[Term, ...]
    signs: tuple[float, ...]
    strength: float
    share: float
    alike: tuple[tuple[Term, ...], ...] = ()

    @property
    def equation(self) -> str:
        """What is added where."""
        return "; ".join(map(added, self.terms, self.signs))

    @property
    def starts(self) -> tuple[float, ...]:
        """Where the shapes of its terms begin."""
        return tuple(shape.value for term in self.terms for shape in term.shapes)

    @property
    def simplicity(self) -> tuple[object, ...]:
        """What of two that are as good comes first."""
        text = "".join(term.text for term in self.terms)
        shapes = sum(term.free_shapes for term in self.terms)
        return len(self.terms), shapes, not meaning(self.terms), len(text), text


def offered(found: Regression, units: Mapping[str, str]) -> tuple[tuple[Candidate, ...], int]:
    """The terms and pairs that promise most, and how many were looked at."""
    classes = _apart(found)
    singles = [_single(found, group) for group in (*classes[:_TRIED], *_shaped(found, classes))]
    pairs = _pairs(found, [group[0] for group in classes[:_PAIRED]], units)
    return (*singles, *pairs), (1 + _PAIRED) * len(found.terms)


def _apart(found: Regression) -> list[list[int]]:
    """The best class of every form: those that differ by where their shapes begin come to the same in a refit."""
    best: dict[object, list[int]] = {}
    for group in found.classes():
        term = found.terms[group[0]]
        best.setdefault((term.at, term.kind, term.of) if term.free_shapes else group[0], group)
    return list(best.values())


def _shaped(found: Regression, classes: Sequence[Sequence[int]]) -> list[Sequence[int]]:
    """Of every kind with shapes that is not yet among those tried, the best class: a refit moves its shapes."""
    seen = {found.terms[i].kind for group in classes[:_TRIED] for i in group}
    more: list[Sequence[int]] = []
    for group in classes[_TRIED:]:
        term = found.terms[group[0]]
        if found.gains[group[0]] < _MAY_WIN * found.gains[classes[0][0]]:
            break
        if term.free_shapes and term.kind not in seen:
            seen.add(term.kind)
            more.append(group)
    return more


def _single(found: Regression, group: Sequence[int]) -> Candidate:
    """The plainest term of a class."""
    terms = [found.terms[i] for i in group]
    best = min(range(len(group)), key=lambda i: (not meaning([terms[i]]), terms[i].free_shapes, len(terms[i].text)))
    at = group[best]
    strength, share = float(found.with_residual[at] / found.products[at, at]), float(found.gains[at])
    others = tuple((term,) for i, term in enumerate(terms) if i != best)
    return Candidate((terms[best],), (1.0,), strength, share, others)


def _pairs(found: Regression, leading: Sequence[int], units: Mapping[str, str]) -> list[Candidate]:
    """Two places with one strength: terms whose strengths have one unit, one where the drive is and one elsewhere."""
    power, dimensions = np.diag(found.products), [_dimension(term, units) for term in found.terms]
    plain = np.array([not term.shapes and power[i] > 0 for i, term in enumerate(found.terms)])
    driven = np.array([term.place in _DRIVE for term in found.terms])
    best: dict[tuple[int, int], tuple[float, float, float]] = {}
    for i in leading:
        alike = np.array([dimensions[i] == other for other in dimensions])
        others = np.flatnonzero(plain[i] & plain & (driven != driven[i]) & alike)
        for j in map(int, others):
            for sign in (1.0, -1.0):
                both = power[i] + power[j] + 2 * sign * found.products[i, j]
                with_residual = found.with_residual[i] + sign * found.with_residual[j]
                if both > 0:
                    share, strength = float(with_residual**2 / both / found.left), float(with_residual / both)
                    key = (min(i, j), max(i, j))
                    best[key] = max(best.get(key, (0.0, 0.0, 0.0)), (share, strength * (1 if i < j else sign), sign))
    chosen = sorted(best.items(), key=lambda one: -one[1][0])[:_PAIRS]
    listed = []
    for (i, j), (share, strength, sign) in chosen:
        both_terms = [(found.terms[i], 1.0), (found.terms[j], sign)]
        terms, signs = zip(*sorted(both_terms, key=lambda one: PLACES.index(one[0].place)), strict=True)
        turned = signs[0]
        listed.append(Candidate(terms, tuple(turned * one for one in signs), turned * strength, share))
    return listed


def _dimension(term: Term, units: Mapping[str, str]) -> object:
    """That of a term's strength."""
    unit = ratio(units[term.at], term.unit)
    return shape(known_powers(unit, term.text), term.text)
