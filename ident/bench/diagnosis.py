"""A diagnosis of a bench's model: what of the effects of a bench is added, in the words of any diagnosis."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from importlib.metadata import version

import numpy as np

from ident.bench.effect_ranking import Candidate, Refit, Refitter
from ident.bench.outputs import errors_of, model_of, noise_floor
from ident.bench.records import Record, bench_set
from ident.comparison.compare import fitted
from ident.custom.definition import preset_with
from ident.diagnosis.budget import SearchBudget
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence.comparison import compare
from ident.diagnosis.evidence.separation import indistinguishable, separation
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Alternative, Baseline, Diagnosis, Ranked, Rung
from ident.diagnosis.sentences import evidence_figures, verdict_text, why_of_evidence
from ident.diagnosis.stages import FURTHER, not_looked_at
from ident.diagnosis.unfitted import unranked
from ident.diagnosis.verdict import Findings, Residual, conclude
from ident.effects.effect import Effect
from ident.errors import TimeIsUp, Unusable
from ident.fit.parameter_bounds import of_model
from ident.fit.result import FitResult
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.presets import preset
from ident.progress import Expected, Progress
from ident.time_budget import in_time


def diagnose_bench(matrix: Matrix, fit: FitResult, custom: Sequence[Effect], course: SearchBudget) -> Diagnosis:
    """Rank the effects of a bench and the user's own, add what helps beyond chance, and say whether the residual is
    explained."""
    _refuse_candidates_given(fit)
    with course.budget.running():
        try:
            return BenchDiagnoser(matrix, fit, tuple(custom), course).diagnosis()
        except TimeIsUp:
            return unranked(matrix, fit, course.seconds_taken)


def _refuse_candidates_given(fit: FitResult) -> None:
    """Raise Unusable for bounds and values of effects that the fit does not have: here they are fitted without."""
    given = Settings.from_json(dict(fit.settings)) if fit.settings else Settings(fit.model)
    own = of_model(given, preset_with(fit.model, fit.effects, given.custom))
    for name in (*given.bounds, *given.fixed):
        if name not in own.bounds and name not in own.fixed:
            raise Unusable(
                "bad-option",
                f"{name} is given, and effects of a bench are tried without bounds",
                "bounds or values",
                "leave it out",
            )


class BenchDiagnoser:
    """One diagnosis of bench records."""

    def __init__(self, matrix: Matrix, fit: FitResult, custom: tuple[Effect, ...], course: SearchBudget) -> None:
        self.matrix, self.fit, self.course = matrix, fit, course
        self.complete = False
        self._known_errors: dict[Refit, dict[str, float | None]] = {}
        bench = bench_set(matrix)
        self.records = {use: tuple(r for r in bench.records if r.use == use) for use in ("fit", "verify")}
        self.preset, _, values = fitted(fit, matrix)
        model = model_of(values, bench.supply_pressure, self.preset)
        self.refitter = Refitter(model, preset(fit.model), self.preset.effects, self.records["fit"], custom)
        self.floor = {use: noise_floor(matrix, use) for use in ("fit", "verify")}

    def diagnosis(self) -> Diagnosis:
        """The whole of it."""
        first: list[Candidate] = []
        steps = [self.refitter.base]
        with suppress(TimeIsUp):
            self._errors(steps[0])
            self._add(first, steps)
            self.complete = True
        return self._said(first, steps)

    def _said(self, first: list[Candidate], steps: list[Refit]) -> Diagnosis:
        """What was found so far, by the first ranking and the refits from the fitted model on."""
        base = steps[0]
        found, group = steps[-1], _alike(first)
        groups = (group,) if len(group) > 1 and group[0] in found.effects else ()
        errors, before = self._errors(found), self._errors(base)
        residual = Residual(errors["fit"] or 0.0, self.floor["fit"] or None, excess=CRITERIA.noise.bench_excess)
        added = found.effects[len(base.effects) :]
        verdict = conclude(
            Findings(added=added, alternatives=groups, compared=_compared(first, group), residual=residual)
        )
        missing = () if self.complete else (FURTHER,)
        said = verdict_text(
            added,
            groups,
            (),
            verdict.unexplained,
            errors,
            float(before["fit"] or 0.0),
            floor=self.floor["fit"],
            complete=self.complete,
        )
        text = " ".join((said, *not_looked_at(missing)))
        return Diagnosis(
            model=self.fit.model,
            effects=base.effects,
            baseline=Baseline(before, self._offset(base), unstable=self._unstable(base)),
            noise_floor={"fit": self.floor["fit"], "held_out": None, "verify": self.floor["verify"]},
            candidates=tuple(self._ranked(c, group, base, i == 0) for i, c in enumerate(first)),
            ladder=tuple(self._rung(step, steps[i - 1] if i else None) for i, step in enumerate(steps)),
            verdict=replace(verdict, text=text),
            proposals=(),
            complete=self.complete,
            not_looked_at=missing,
            seed=self.fit.seed,
            seconds=self.course.seconds_taken,
            version=version("servoident"),
            data_hash=self.matrix.data_hash,
            settings=dict(self.fit.settings),
            preprocessing=self.fit.preprocessing,
        )

    def _add(self, first: list[Candidate], steps: list[Refit]) -> None:
        """Fill the first ranking, and the refits from the fitted model to the last, each with one effect more."""
        first += self.refitter.rank(steps[0], self._names(steps[0]), self._progress)
        ranking = first
        while len(steps) <= self.course.most and ranking and ranking[0].worth_adding:
            steps.append(ranking[0].refit)
            self._heard(first, steps)
            names = self._names(steps[-1])
            ranking = self.refitter.rank(steps[-1], names, self._progress) if len(steps) <= self.course.most else []

    def _heard(self, first: list[Candidate], steps: list[Refit]) -> None:
        """Tell of a step."""
        self.course.added = tuple(Expected(step.effects[-1], step.held_out_error) for step in steps[1:])
        if self.course.listener is not None:
            self.course.listener(self._said(first, steps))

    def _names(self, refit: Refit) -> list[str]:
        """What may be added."""
        return [name for name in self.refitter.effects if name not in refit.effects]

    def _progress(self, done: int, total: int) -> None:
        self.course.report_progress(Progress("confirming", done, total))

    # What is said ----------------------------------------------------------------------------------------------

    def _mean(self, refit: Refit, records: tuple[Record, ...], what: str) -> float | None:
        """None where there are none, or no time to simulate them."""
        found = in_time(lambda: [float(getattr(run, what)) for run in errors_of(records, refit.model)])
        return float(np.mean(found)) if found else None

    def _errors(self, refit: Refit) -> dict[str, float | None]:
        """What is known of them stays known where there is no time left."""
        known = self._known_errors.get(refit, {})
        on = {use: known.get(use) or self._mean(refit, self.records[use], "error") for use in ("fit", "verify")}
        found = {"fit": on["fit"], "held_out": refit.held_out_error, "verify": on["verify"]}
        return self._known_errors.setdefault(refit, found) | found

    def _unstable(self, refit: Refit) -> dict[str, tuple[str, ...]]:
        """By the use of records the ids of those on which the model is unstable, where there is time to simulate."""
        runs = {
            use: in_time(lambda records=records: errors_of(records, refit.model)) or ()  # type: ignore[misc]
            for use, records in self.records.items()
        }
        found = {use: tuple(one.id for one in of if one.unstable) for use, of in runs.items()}
        return {use: ids for use, ids in found.items() if ids}

    def _offset(self, refit: Refit) -> float | None:
        return self._mean(refit, self.records["fit"], "offset")

    def _parameters(self, refit: Refit) -> dict[str, ParameterEstimate]:
        effects = tuple(self.refitter.effects[name] for name in refit.effects)
        known = {p.in_equations: p for p in self.refitter.bare.with_effects(effects).parameters}
        deviations = refit.solution.deviations
        found = {
            known[name].name: ParameterEstimate(value, known[name].unit, deviations[name], known[name].symbol)
            for name, value in refit.solution.values.items()
        }
        return dict(sorted(found.items(), key=lambda entry: "." not in entry[0]))

    def _ranked(self, candidate: Candidate, group: tuple[str, ...], base: Refit, best: bool) -> Ranked:
        refit, effect = candidate.refit, self.refitter.effects[candidate.effect]
        helps, errors = candidate.worth_adding, (base.held_out_error, refit.held_out_error)
        return Ranked(
            effect=candidate.effect,
            error=self._errors(refit),
            offset=self._offset(refit),
            predicted_error=candidate.predicted,
            parameters=self._parameters(refit),
            unstable=self._unstable(refit),
            group=group if candidate.effect in group and len(group) > 1 else (),
            evidence=evidence_figures(candidate.evidence, effect, helps),
            why=why_of_evidence(candidate.evidence, effect, errors, helps, None, best),
        )

    def _rung(self, step: Refit, before: Refit | None) -> Rung:
        nats = None if before is None else compare(before.held_out, step.held_out).gain
        added = None if before is None else step.effects[-1]
        return Rung(
            added=added,
            error=self._errors(step),
            offset=self._offset(step),
            nats=nats,
            parameters=self._parameters(step),
            unstable=self._unstable(step),
        )


def _alike(ranking: list[Candidate]) -> tuple[str, ...]:
    """The best and those that are worse by no more than chance, where the best helps."""
    if not ranking or not ranking[0].worth_adding:
        return ()
    best = ranking[0].refit.held_out
    return tuple(c.effect for c in ranking if c is ranking[0] or indistinguishable(compare(c.refit.held_out, best)))


def _compared(ranking: list[Candidate], group: tuple[str, ...]) -> tuple[Alternative, ...]:
    """The other effects of a group in the place of the best, with the numbers that decide."""
    best, others = ranking[:1], [c for c in ranking[1:] if c.effect in group]
    pairs = [(first, other) for first in best for other in others]
    return tuple(
        Alternative(other.effect, first.effect, separation(compare(first.refit.held_out, other.refit.held_out)))
        for first, other in pairs
    )
