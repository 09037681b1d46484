"""The search for unlisted terms, one after the other.

Three disjoint sets of the fitted runs: terms are ranked on the first, by one linear regression, and refitted to it; the
second chooses between the refits; the third confirms. A term that passes the bar is refitted to all fitted runs, and
the next term is sought in addition to it. Where there are few runs, all serve for all three, with stretches of them and
whole runs held out in turn, and the term is a hypothesis. Validation data only report.
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
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.candidate_terms import CandidateTerms, candidate_terms
from ident.diagnosis.discovery.characteristic_plot import characteristic_view
from ident.diagnosis.discovery.discovery_result import DiscoveryResult, RejectedTerm
from ident.diagnosis.discovery.interpretation import interpretation
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.discovery.term_candidate import TermCandidate
from ident.diagnosis.discovery.term_evidence import term_evidence
from ident.diagnosis.discovery.term_to_effect import (
    as_fitted,
    curves,
    definition,
    equation_text,
    lines_of,
    searched_bounds,
)
from ident.diagnosis.evidence.rule import generalises, matters
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import evidence, verified_change, worth_adding
from ident.diagnosis.tie_breaking import stable_minimum, stable_ranking
from ident.diagnosis.verdict import contradiction
from ident.diagnosis.verification import Contradiction
from ident.equations.mathml import mathml
from ident.errors import TimeIsUp, Unusable
from ident.fit.levenberg_marquardt import Way
from ident.parallel import each
from ident.progress import Progress, Report
from ident.run import Run, over_runs

Array = NDArray[np.float64]
RefittedTerm = tuple[TermCandidate, FittedModel, CandidateModels]
_PREFIX = "proposed_"


@dataclass
class TermSearch:
    """A search from a model whose residual is above the noise; `models` are the models of all fitted runs.

    Effects that are `given` stay; other effects, and earlier terms, are taken out where a later term makes them
    redundant.
    """

    models: CandidateModels
    base: FittedModel
    report: Report
    given: tuple[str, ...]
    asked: bool = True
    most: int = CRITERIA.discovery.most
    looked_at: int = 0
    left_out: int = 0
    proposals: list[Proposal] = field(default_factory=list)
    rejected: RejectedTerm | None = None
    complete: bool = False

    def __post_init__(self) -> None:
        self.beside = self.base.effects

    def run(self) -> DiscoveryResult:
        """Add one term after the other until none passes the bar, or the noise is reached; then one free curve.

        With few runs, which cannot confirm it, a free curve is sought only on request: it takes longer than all terms.
        """
        begun = TermSearch(self.models, self.base, self.report, self.given)
        with suppress(TimeIsUp):
            while len(self.proposals) < self.most and not self.models.at_floor(self.base) and self._added():
                pass
            if (self.asked or not _few(self.models.runs)) and not self.models.at_floor(self.base):
                self._drawn(begun)
            self.complete = True
        return DiscoveryResult(
            proposals=tuple(map(self._restated, self.proposals)),
            refit=self.base,
            rejected=self.rejected,
            looked_at=self.looked_at,
            left_out=self.left_out,
            complete=self.complete,
        )

    def _drawn(self, begun: TermSearch) -> None:
        """Add one free curve to the terms; or put it in the place of all terms, where the error is then no larger."""
        terms = self.proposals
        self._added(curves=True)
        begun.looked_at, begun.left_out = self.looked_at, self.left_out
        if (
            terms
            and begun._added(curves=True)
            and _held_out(begun) <= CRITERIA.equality.practically_equal * _held_out(self)
        ):
            self.models, self.base, self.beside, self.proposals = (
                begun.models,
                begun.base,
                begun.beside,
                begun.proposals,
            )
        self.looked_at, self.left_out = begun.looked_at, begun.left_out

    def _added(self, curves: bool = False) -> bool:
        """Look for one more term, or for a free curve; True where one passed the bar."""
        self.report(Progress("proposing", len(self.proposals), self.most))
        sought, chosen_by, confirming = _parts(self.models.runs)
        searching = self.models.without(run.id for run in self.models.runs if run not in sought)
        base = searching.refit(self.base.effects, self.base.values)
        if not base.finite:
            return False
        name = next(f"{_PREFIX}{n}" for n in count(1) if f"{_PREFIX}{n}" not in self.models.effects)
        seen = candidate_terms(self.models, base, curves=curves)
        self._count(seen)
        self.report(Progress("proposing", len(self.proposals), self.most, base.error))
        tried = self._all_tried(searching, base, name, seen, curves)
        if not tried:
            return False
        few, bar = _few(self.models.runs), least_gain(self.looked_at)
        candidate, refit, family = _chosen(base, tried, () if few else chosen_by)
        if few:
            found = evidence(base, refit)
            gained, sound = found.gain, matters(found) and generalises(found)
        else:
            integrated = self.models.horizon is not None
            told = term_evidence(
                confirming, _left(base, confirming), _left(refit, confirming), self.models.band, integrated
            )
            gained, sound = told.log_likelihood_gain, told.worthwhile and (told.consistent or told.beyond(bar))
        if not (gained > bar and sound):
            self._reject(next(one for one in family.given.custom if one["name"] == name), refit, gained, bar)
            return False
        self.models = self.models.with_effects(family.effects, family.given)
        without, self.base = self.base, self.models.refit(refit.effects, refit.values)
        self._prune(name)
        proposal = self._proposal(candidate, seen, name, gained, bar, few)
        self.proposals.append(replace(proposal, contradicted=self._contradiction(name, without)))
        return True

    def _count(self, seen: CandidateTerms) -> None:
        """Add up the numbers of terms that were tried and left out."""
        self.looked_at += seen.looked_at
        self.left_out += seen.left_out

    def _reject(self, own: Mapping[str, Any], refit: FittedModel, gained: float, bar: float) -> None:
        """Record a term below the bar, where it is the best of those."""
        if self.rejected is None or gained > self.rejected.log_likelihood_gain:
            terms = {one["name"] for one in self.models.given.custom}
            beside = tuple(name for name in self.base.effects if name not in terms and name not in self.given)
            self.rejected = RejectedTerm(
                equation=equation_text(own), log_likelihood_gain=gained, bar=bar, beside=beside, error=refit.errors
            )

    def _all_tried(
        self, searching: CandidateModels, base: FittedModel, name: str, seen: CandidateTerms, curves: bool
    ) -> list[RefittedTerm]:
        """The refits with the best candidates of rough refits.

        A strong term moves the signals that terms read. So where the residual of the best exceeds the noise, the terms
        in its place are sought once more, with the signals of the model that has it.
        """

        def refits(candidates: Sequence[TermCandidate], least: float = np.inf) -> list[RefittedTerm]:
            built = [one for one in (_built(searching, base, name, c, seen) for c in candidates) if one]
            self.left_out += len(candidates) - len(built)
            begun = [one for one in each(lambda of: _tried(base, name, *of), built) if one]
            return _ahead(begun, least)

        tried = refits(seen.candidates)
        if not tried:
            return tried
        best = stable_minimum(tried, lambda one: one[1].error)
        if not searching.at_floor(best[1]):
            again = candidate_terms(self.models, best[1], best[2].effects[name], curves)
            self._count(again)
            new = [one for one in again.candidates if not any(map(one.begins_as, seen.candidates))]
            tried += refits(new, best[1].local.error)
        ranked = stable_ranking(tried, lambda one: one[1].error)
        plain = [one for one in ranked[CRITERIA.estimation.leading :] if one[0].plain][: CRITERIA.discovery.of_a_kind]
        close = [
            one
            for one in (*ranked[: CRITERIA.estimation.leading], *plain)
            if one[1].error <= CRITERIA.free_widths.missed * ranked[0][1].error
        ]
        on = replace(CRITERIA.estimation.full, aim=CRITERIA.equality.practically_equal * ranked[0][1].local.error)
        return _followed(each(lambda one: _gone_on(one, on), close))

    def _prune(self, latest: str) -> None:
        """Take out the effects and terms that are redundant since the latest term."""
        for name in self.base.effects:
            if name in (latest, *self.given):
                continue
            values = self._joined(latest, name)
            less = self.models.refit(tuple(e for e in self.base.effects if e != name), values)
            if less.finite and not worth_adding(self.models, less, self.base):
                self.base = less
        self.beside = tuple(name for name in self.beside if name in self.base.effects)
        self.proposals = [one for one in self.proposals if one.effect["name"] in self.base.effects]

    def _joined(self, latest: str, name: str) -> dict[str, float]:
        """The values with the strength of a term given to the latest, where both are one equation."""
        values = dict(self.base.values)
        equations = {one["name"]: one["equation"] for one in self.models.given.custom}
        if name in equations and equations[name] == equations[latest]:
            values[self.models.strength(latest)] += values[self.models.strength(name)]
        return values

    def _contradiction(self, name: str, before: FittedModel) -> Contradiction | None:
        """The contradiction of the latest term by validation data, None where there is none."""
        return contradiction(verified_change(name, before, self.base))

    def _proposal(
        self, candidate: TermCandidate, seen: CandidateTerms, name: str, gained: float, bar: float, hypothesis: bool
    ) -> Proposal:
        own = next(one for one in self.models.given.custom if one["name"] == name)
        own = as_fitted(own, self.models.effects[name], self.base.values)
        return Proposal(
            place=tuple(dict.fromkeys(term.place for term in candidate.terms)),
            equation=equation_text(own),
            effect=own,
            strength=self.base.values[self.models.strength(name)],
            std_error=self.base.deviation(self.models.strength(name)),
            unit=self.models.preset.display.recorded.shown(self.models.effects[name].strength.unit),
            parameters=self.base.parameters,
            view=characteristic_view(candidate.terms[0], self.models.preset, seen.typical),
            beside=self.beside,
            terms=len(self.proposals) + 1,
            shapes=sum(term.fitted for term in candidate.terms),
            error=self.base.errors,
            unstable=self.base.unstable,
            nats=gained,
            bar=bar,
            alike=tuple("; ".join(f"{t.at}: {t.text}" for t in terms) for terms in candidate.alike),
            meaning=interpretation(candidate.terms),
            formula=" ".join(mathml(line, curves(own)) for line in lines_of(own)),
            hypothesis=hypothesis,
            free_curve=any(term.curve is not None for term in candidate.terms),
        )

    def _restated(self, proposal: Proposal) -> Proposal:
        """The proposal with the values of the last refit: later terms move the shapes of earlier ones."""
        name = str(proposal.effect["name"])
        if name not in self.base.effects:  # the time was over while it was weighed
            return proposal
        return replace(proposal, effect=as_fitted(proposal.effect, self.models.effects[name], self.base.values))


def _built(
    searching: CandidateModels, base: FittedModel, name: str, candidate: TermCandidate, seen: CandidateTerms
) -> tuple[TermCandidate, CandidateModels] | None:
    """The models with a candidate as an effect of this name; None where no model can hold it."""
    with np.errstate(all="ignore"):  # bounds that are no numbers are refused below
        own = definition(name, candidate.terms, candidate.signs, candidate.strength, seen.typical, seen.units)
    try:
        effect = read_effect(own, model=searching.preset.name)
    except Unusable:
        return None
    bounds = {**searching.given.bounds, **searched_bounds(own, candidate.terms)}
    given = replace(searching.given, custom=(*searching.given.custom, own), bounds=bounds)
    family = searching.with_effects({**searching.effects, name: effect}, given)
    # It may close a circle of signals with the earlier terms.
    return (candidate, family) if family.fit_together((*base.effects, name)) else None


def _tried(base: FittedModel, name: str, candidate: TermCandidate, family: CandidateModels) -> RefittedTerm | None:
    """First steps with a candidate on the runs that search; None where the model is not stable."""
    start = {**base.values, family.strength(name): candidate.strength}
    start |= {p.in_equations: p.value for p in family.effects[name].added[1:]}
    refit = family.refit((*base.effects, name), start, way=CRITERIA.estimation.screen)
    return (candidate, refit, family) if refit.stable else None


def least_gain(looked_at: int) -> float:
    """The gain (nats) that the best of so many terms has to exceed."""
    return float(np.log(looked_at)) + CRITERIA.discovery.log_likelihood_gain


def _held_out(search: TermSearch) -> float:
    return search.base.held_out.error


def _ahead(begun: Sequence[RefittedTerm], least: float) -> list[RefittedTerm]:
    """Rough refits that end where they cannot come near the `least` error before, or the least of the first steps."""
    on = replace(
        CRITERIA.estimation.trial,
        aim=CRITERIA.free_widths.missed * min([least, *(refit.local.error for _, refit, _ in begun)]),
    )
    return _followed(each(lambda one: _gone_on(one, on), begun))


def _followed(tried: Sequence[RefittedTerm]) -> list[RefittedTerm]:
    """The refits that a simulation confirms, simulated in parallel."""
    return [one for one, finite in zip(tried, each(lambda one: one[1].finite, tried), strict=True) if finite]


def _gone_on(tried: RefittedTerm, way: Way) -> RefittedTerm:
    """A refit that is continued."""
    candidate, refit, family = tried
    return candidate, family.continued(refit, way), family


def _chosen(base: FittedModel, tried: Sequence[RefittedTerm], runs: Sequence[Run]) -> RefittedTerm:
    """The simplest refit of those with about the least error on some runs, or on held-out data where there are none.

    Where all refits gain little over the base, a term that is as good within some per cent may gain nothing: a second
    bound is a share of the gain.
    """
    before, *errors = each(
        lambda one: _error(one, runs) if runs else one.held_out.error, [base, *(refit for _, refit, _ in tried)]
    )
    least = min(errors)
    bound = min(
        CRITERIA.equality.practically_equal * least, least + CRITERIA.discovery.lost_gain * max(before - least, 0.0)
    )
    good = [one for one, error in zip(tried, errors, strict=True) if error <= bound]
    return min(good, key=lambda one: one[0].simplicity)


def _parts(runs: Sequence[Run]) -> tuple[tuple[Run, ...], tuple[Run, ...], tuple[Run, ...]]:
    """The runs that search, choose and confirm, each part with runs of all conditions; too few runs serve for all
    three.

    The outputs of one record stay together.
    """
    if _few(runs):
        return tuple(runs), tuple(runs), tuple(runs)

    def condition(run: Run) -> tuple[float, ...]:
        of = run.specimen
        return (of.mass, of.stiffness, run.Kp, run.drive) if of else (0.0, 0.0, run.Kp, run.drive)

    ordered = list(dict.fromkeys(run.record or run.id for run in sorted(runs, key=condition)))
    parts: list[set[str]] = [set(), set(), set()]
    dealing, count = np.random.default_rng(0), len(parts)
    for first in range(0, len(ordered), count):  # of neighbours each part gets one: in turn a part would get one gain
        for at, record in zip(dealing.permutation(count), ordered[first : first + count], strict=False):
            parts[at].add(record)
    sought, chosen_by, confirming = (tuple(run for run in runs if (run.record or run.id) in part) for part in parts)
    return sought, chosen_by, confirming


def _few(runs: Sequence[Run]) -> bool:
    """Whether there are too few records for separate parts that search, choose and confirm."""
    return len({run.record or run.id for run in runs}) < CRITERIA.discovery.fewest_runs


def _error(refit: FittedModel, runs: Sequence[Run]) -> float:
    """The error of eq. (17) on runs that a refit was not made for."""
    found = refit.fitness.fresh(tuple(runs)).exact(refit.point, sensitivities=False).runs
    return float(over_runs([run.error for run in found], runs))


def _left(refit: FittedModel, runs: Sequence[Run]) -> list[Array]:
    """The residuals of some runs."""
    fitness = refit.fitness.fresh(tuple(runs))
    outputs = fitness.outputs(refit.point)
    return [run.measured - outputs[run.id] for run in runs]
