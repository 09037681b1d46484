"""The search for what no list holds, one term after the other.

Three disjoint sets of the fitted runs: terms are ranked on the first, by one linear regression, and refitted to it;
the second chooses between the refits; the third confirms. What passes the bar is refitted to all fitted runs, and the
next term sought beside it. Of one run or two each serves for all three, with stretches of it held out in turn, and what
comes of it is a hypothesis. Runs to verify only report.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import count
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.custom.definition import read_effect
from ident.diagnosis.family import ModelFamily, Refit
from ident.diagnosis.proposals.evidence import evidence
from ident.diagnosis.proposals.meanings import meaning
from ident.diagnosis.proposals.own import STRENGTH, definition
from ident.diagnosis.proposals.proposal import Proposal, Proposals, Refused
from ident.diagnosis.proposals.records import paths, records
from ident.diagnosis.proposals.regression import Regression, regression
from ident.diagnosis.proposals.terms import Library, Term, ratio
from ident.diagnosis.significance import improvement
from ident.equations.mathml import mathml
from ident.errors import TimeIsUp, Unusable
from ident.matrix import Run, over_runs
from ident.parallel import each
from ident.progress import Progress, Report
from ident.stages import PLACES
from ident.units.quantity import known_powers, shape

Array = NDArray[np.float64]
MOST = 3  # terms
_PREFIX = "proposed_"
_PLACES = {"controller": "e", "spool": "w", "flow": "Q", "load": "R", "sensor": "y"}
_SIGNALS = ("w", "Q", "P", "v", "x", "F")
_TRIED, _PAIRS, _PAIRED = 6, 3, 12  # single terms and pairs that are refitted, and terms that are paired with all
_DRIVE = ("controller", "valve", "spool", "flow")  # one input of the machine: of two terms there one is enough
_EVIDENCE = 5.0  # nats beyond the logarithm of how many were looked at
_PROPORTIONAL = 1.0 - 1e-6  # cosine of signals that are one
_AS_GOOD = 1.02  # times the least error: a simpler one is taken
_FEWEST = 3  # runs, of which one each searches, chooses and confirms


@dataclass(frozen=True)
class _Candidate:
    """Terms with one strength, a sign each, and what the regression makes of them; `alike` cannot be told from them."""

    terms: tuple[Term, ...]
    signs: tuple[float, ...]
    strength: float
    share: float
    alike: tuple[tuple[Term, ...], ...] = ()

    @property
    def equation(self) -> str:
        """What is added where."""
        return "; ".join(
            f"{term.at} = {term.at} {'+' if sign > 0 else '-'} {STRENGTH} * ({term.text})"
            for term, sign in zip(self.terms, self.signs, strict=True)
        )


@dataclass(frozen=True)
class _Sight:
    """The contenders of a step, best first; samples of the signals that they are of, and the units of these."""

    contenders: tuple[_Candidate, ...]
    typical: Mapping[str, Array]
    units: Mapping[str, str]


@dataclass
class Search:
    """A search from a model that ended above the noise; `models` are those of all fitted runs."""

    models: ModelFamily
    base: Refit
    report: Report
    most: int = MOST
    looked_at: int = 0
    found: list[Proposal] = field(default_factory=list)
    refused: Refused | None = None
    complete: bool = False

    def __post_init__(self) -> None:
        self.beside = self.base.effects

    def run(self) -> Proposals:
        """One term on top of the other until none passes the bar, or the noise is reached."""
        with suppress(TimeIsUp):
            while len(self.found) < self.most and not self.models.at_floor(self.base) and self._added():
                pass
            self.complete = True
        return Proposals(
            found=tuple(self.found), refused=self.refused, looked_at=self.looked_at, complete=self.complete
        )

    def _added(self) -> bool:
        """Look for one more term; True where one passed the bar."""
        self.report(Progress("proposing", len(self.found), self.most))
        sought, chosen_by, confirming = _parts(self.models.runs)
        searching = self.models.without(run.id for run in self.models.runs if run not in sought)
        base = searching.refit(self.base.effects, self.base.values)
        if not base.finite:
            return False
        name = next(f"{_PREFIX}{n}" for n in count(1) if f"{_PREFIX}{n}" not in self.models.effects)
        sight = self._seen(base)
        tried = [one for one in each(lambda c: self._tried(searching, base, name, c, sight), sight.contenders) if one]
        if not tried:
            return False
        few = _few(self.models.runs)
        errors = [refit.held_out.error if few else _error(refit, chosen_by) for _, refit, _ in tried]
        good = [one for one, error in zip(tried, errors, strict=True) if error <= _AS_GOOD * min(errors)]
        candidate, refit, family = min(good, key=_simplicity)
        if few:
            gain = improvement(base.held_out, refit.held_out)
            gained, sound = gain.nats, gain.beyond_chance
        else:
            integrated = self.models.horizon is not None
            seen = evidence(confirming, _left(base, confirming), _left(refit, confirming), self.models.band, integrated)
            gained, sound = seen.nats, seen.steady and seen.worthwhile
        bar = float(np.log(self.looked_at)) + _EVIDENCE
        if not (gained > bar and sound):
            self.refused = Refused(equation=candidate.equation, nats=gained, bar=bar)
            return False
        self.models = replace(self.models, effects=family.effects, given=family.given, _known={})
        self.base = self.models.refit(refit.effects, refit.values)
        self.found.append(self._proposal(candidate, name, gained, bar, few))
        return True

    def _proposal(self, candidate: _Candidate, name: str, gained: float, bar: float, hypothesis: bool) -> Proposal:
        effect = next(d for d in self.models.given.custom if d["name"] == name)
        shapes = {
            p.symbol: self.base.values[p.in_equations] for p in self.models.effects[name].added[1:]
        }  # fmt: skip
        own = (
            {**effect, "shape": {s: {**effect["shape"][s], "value": v} for s, v in shapes.items()}}
            if shapes
            else effect
        )
        return Proposal(
            place=tuple(dict.fromkeys(term.place for term in candidate.terms)),
            equation=candidate.equation,
            effect=own,
            strength=self.base.values[self.models.strength(name)],
            unit=self.models.effects[name].strength.unit,
            beside=self.beside,
            terms=len(self.found) + 1,
            shapes=sum(term.free_shapes for term in candidate.terms),
            error=self.base.errors,
            nats=gained,
            bar=bar,
            alike=tuple("; ".join(f"{t.at}: {t.text}" for t in terms) for terms in candidate.alike),
            meaning=meaning(candidate.terms),
            formula=" ".join(mathml(line) for line in candidate.equation.split("; ")),
            hypothesis=hypothesis,
        )

    # What is looked at ------------------------------------------------------------------------------------------

    def _seen(self, base: Refit) -> _Sight:
        """The terms that promise most, and pairs of two places with one strength, best first."""
        preset, matrix = self.models.preset, self.models.matrix
        named = {equation.target for equation in preset.core.equations if not equation.is_rate} | {*preset.core.states}
        names = [name for name in _SIGNALS if name in named]
        places = {place: at for place, at in _PLACES.items() if at in named}
        runs = records(base, list(dict.fromkeys((*names, *places.values()))))
        typical = {name: np.concatenate([record.signals[name] for record in runs]) for name in runs[0].signals}
        names = _distinct(names, typical)
        responses = {at: paths(preset, base.values, matrix.actuator, at, runs) for at in places.values()}
        varied = [name for name in ("Kp", "mL", "k") if np.ptp(typical[name]) > 0]
        units = {**_CONDITIONS, **preset.chain.units}
        shortest = min(run.duration for run in self.models.runs)
        library = Library(places, names, typical, units, self.models.band, shortest, varied)
        terms = list(library.terms())
        self.looked_at += len(terms)
        self.report(Progress("proposing", len(self.found), self.most, base.error))
        found = regression(terms, runs, responses, self.models.band)
        singles = [_single(found, group) for group in found.classes()[:_TRIED]]
        pairs = _pairs(found, units)
        self.looked_at += _PAIRED * len(terms)
        return _Sight((*singles, *pairs), typical, units)

    def _tried(
        self, searching: ModelFamily, base: Refit, name: str, candidate: _Candidate, sight: _Sight
    ) -> tuple[_Candidate, Refit, ModelFamily] | None:
        """The refit with a candidate to the runs that search; None where it cannot be added."""
        own = definition(name, candidate.terms, candidate.signs, candidate.strength, sight.typical, sight.units)
        try:
            effect = read_effect(own, model=self.models.preset.name)
        except Unusable:
            return None
        free = {
            f"{name}.{one.symbol}": (own["shape"][one.symbol]["lower"], own["shape"][one.symbol]["upper"])
            for term in candidate.terms for one in term.shapes if one.free
        }  # fmt: skip
        given = replace(
            searching.given, custom=(*searching.given.custom, own), bounds={**searching.given.bounds, **free}
        )
        family = replace(searching, effects={**searching.effects, name: effect}, given=given, _known={})
        start = {**base.values, family.strength(name): candidate.strength}
        start |= {p.in_equations: p.value for p in effect.added[1:]}
        refit = family.refit((*base.effects, name), start)
        return (candidate, refit, family) if refit.finite else None


_CONDITIONS = {"Kp": "1", "mL": "kg", "k": "N/m"}


def _parts(runs: Sequence[Run]) -> tuple[tuple[Run, ...], tuple[Run, ...], tuple[Run, ...]]:
    """The runs that search, that choose, and that confirm: each with runs of all conditions. Of too few all do all.

    The outputs of one record stay together.
    """
    if _few(runs):
        return tuple(runs), tuple(runs), tuple(runs)

    def condition(run: Run) -> tuple[float, ...]:
        of = run.specimen
        return (of.mass, of.stiffness, run.Kp, run.drive) if of else (0.0, 0.0, run.Kp, run.drive)

    ordered = list(dict.fromkeys(run.record or run.id for run in sorted(runs, key=condition)))
    parts = [set(ordered[first::3]) for first in range(3)]
    sought, chosen_by, confirming = (tuple(run for run in runs if (run.record or run.id) in part) for part in parts)
    return sought, chosen_by, confirming


def _few(runs: Sequence[Run]) -> bool:
    """Whether there are fewer records than search, choose and confirm."""
    return len({run.record or run.id for run in runs}) < _FEWEST


def _distinct(names: Sequence[str], typical: Mapping[str, Array]) -> list[str]:
    """The signals that move, without those that are another one in other units."""
    kept: list[str] = []
    for name in names:
        x = typical[name]
        size = float(np.linalg.norm(x))
        alike = any(
            abs(float(x @ typical[other])) > _PROPORTIONAL * size * np.linalg.norm(typical[other]) for other in kept
        )
        if size > 0 and np.ptp(x) > 0 and not alike:
            kept.append(name)
    return kept


def _cosine(a: Array, b: Array) -> float:
    return abs(float(a @ b)) / float(np.linalg.norm(a) * np.linalg.norm(b))


def _single(found: Regression, group: Sequence[int]) -> _Candidate:
    """The plainest term of a class."""
    terms = [found.terms[i] for i in group]
    best = min(range(len(group)), key=lambda i: (not meaning([terms[i]]), terms[i].free_shapes, len(terms[i].text)))
    at = group[best]
    share, strengths = found.together([at])
    others = tuple((term,) for i, term in enumerate(terms) if i != best)
    return _Candidate((terms[best],), (1.0,), float(strengths[0]), share, others)


def _pairs(found: Regression, units: Mapping[str, str]) -> list[_Candidate]:
    """Two places with one strength: terms whose strengths have one unit, one where the drive is and one elsewhere."""
    power, dimensions = np.diag(found.products), [_dimension(term, units) for term in found.terms]
    plain = np.array([not term.shapes and power[i] > 0 for i, term in enumerate(found.terms)])
    driven = np.array([term.place in _DRIVE for term in found.terms])
    best: dict[tuple[int, int], tuple[float, float, float]] = {}
    for i in [group[0] for group in found.classes()[:_PAIRED]]:
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
    leading = sorted(best.items(), key=lambda one: -one[1][0])[:_PAIRS]
    listed = []
    for (i, j), (share, strength, sign) in leading:
        both_terms = [(found.terms[i], 1.0), (found.terms[j], sign)]
        terms, signs = zip(*sorted(both_terms, key=lambda one: PLACES.index(one[0].place)), strict=True)
        turned = signs[0]
        listed.append(_Candidate(terms, tuple(turned * one for one in signs), turned * strength, share))
    return listed


def _dimension(term: Term, units: Mapping[str, str]) -> object:
    """That of a term's strength."""
    unit = ratio(units[term.at], term.unit)
    return shape(known_powers(unit, term.text), term.text)


def _error(refit: Refit, runs: Sequence[Run]) -> float:
    """Eq. (17) of runs that a refit was not made for."""
    found = refit.fitness.fresh(tuple(runs)).exact(refit.point, sensitivities=False).runs
    return float(over_runs([run.error for run in found], runs))


def _left(refit: Refit, runs: Sequence[Run]) -> list[Array]:
    """The residuals of some runs."""
    fitness = refit.fitness.fresh(tuple(runs))
    outputs = fitness.outputs(refit.point)
    return [run.measured - outputs[run.id] for run in runs]


def _simplicity(tried: tuple[_Candidate, Refit, ModelFamily]) -> tuple[Any, ...]:
    """What of two that are as good comes first."""
    candidate = tried[0]
    text = "".join(term.text for term in candidate.terms)
    return (
        len(candidate.terms),
        sum(t.free_shapes for t in candidate.terms),
        not meaning(candidate.terms),
        len(text),
        text,
    )
