"""What the four blocks lack, ranked: each effect is refitted with every value of the model to every record.

Ranked are the effects that the fast simulation knows, and the user's own. What is better beyond chance is judged as
for any model, see :mod:`ident.diagnosis.evidence.comparison`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.least_squares import Solution, solve
from ident.bench.model import CONSTANTS, FAST, Model, beyond_fast
from ident.bench.natural_sizes import ends_of_the_way, natural_sizes
from ident.bench.records import Record
from ident.bench.reduced_record import Observed, observe
from ident.bench.residual import Residual
from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.cross_validation import fold_of_segments
from ident.diagnosis.evidence.chance import bar
from ident.diagnosis.evidence.comparison import Residuals, common_disturbance, compare
from ident.diagnosis.evidence.energy_bands import EnergyBands
from ident.diagnosis.evidence.energy_bands import Record as ComparedRecord
from ident.diagnosis.evidence.evidence import Evidence
from ident.diagnosis.evidence.rule import worth_adding
from ident.effects import CATALOGUE
from ident.effects.effect import Effect, off_values
from ident.effects.second_lag import SECOND_LAG
from ident.effects.spring_load import SPRING_LOAD
from ident.fit.bounded_step import bounded_step
from ident.fit.criteria import FIT_CRITERIA
from ident.parallel import each
from ident.parameter import Starts
from ident.presets import Preset

Array = NDArray[np.float64]


def _unsaid(_done: int, _total: int) -> None:
    """Report nothing."""


_SHARES = FIT_CRITERIA.search.strengths


@dataclass(frozen=True, eq=False)
class Refit:
    """The model with these effects at its optimum: errors of eq. (17) of each record, with nothing left out and held
    out, and what is compared with another refit: each record over the residual of the fitted model on it."""

    effects: tuple[str, ...]
    solution: Solution
    error: float
    held_out_error: float
    held_out: Residuals

    @property
    def model(self) -> Model:
        """With its values."""
        return self.solution.model


@dataclass(frozen=True, eq=False)
class Candidate:
    """An effect, the error of its first refit, to the constants only, its full refit, the evidence for it, and whether
    it is worth adding by the rule."""

    effect: str
    predicted: float
    refit: Refit
    evidence: Evidence
    worth_adding: bool = False


@dataclass(frozen=True, eq=False)
class Refitter:
    """Refits of a fitted model with further effects, to the records of the fit.

    `bare` is the preset without effects, `on` are those of the fitted `model`, `custom` the user's own.
    """

    model: Model
    bare: Preset
    on: tuple[Effect, ...]
    records: tuple[Record, ...]
    custom: tuple[Effect, ...] = ()

    @cached_property
    def effects(self) -> Mapping[str, Effect]:
        """Those of the model and those that it may be given, by name, in the order of the catalogue."""
        known = {*self.on, *FAST, *self.custom}
        return {effect.name: effect for effect in (*CATALOGUE, *self.custom) if effect in known}

    @cached_property
    def _coarse(self) -> tuple[Observed, ...]:
        """The records as a first refit takes them."""
        return observe(self.records)

    @cached_property
    def _fine(self) -> tuple[Observed, ...]:
        return finely(self.records)

    @cached_property
    def base(self) -> Refit:
        """The fitted model, refitted to the weighed records."""
        return self._refit(tuple(effect.name for effect in self.on), self.model)

    @cached_property
    def _left(self) -> Array:
        """Mean square of the fitted model's residual in the position of each record."""
        residual = self._positions(self.model)
        return np.array([float(np.mean(r**2)) for r in residual])

    @cached_property
    def _shown(self) -> list[Observed]:
        """The records whose positions are compared, without their pressures."""
        return [replace(one, pressure_scale=None) for one in self._fine if np.isfinite(one.position_scale)]

    def rank(self, base: Refit, names: Sequence[str], done: Callable[[int, int], None] = _unsaid) -> list[Candidate]:
        """The effects beside those of `base`, best first by held-out error; `done` is told after each."""
        found = []
        for name in names:
            found.append(self._candidate(base, name))
            done(len(found), len(names))
        chance = cache(lambda: _bar(base, found))
        judged = [replace(one, worth_adding=worth_adding(one.evidence, chance)) for one in found]
        return sorted(judged, key=lambda one: one.refit.held_out_error)

    def _candidate(self, base: Refit, name: str) -> Candidate:
        effects = (*base.effects, name)
        model = self._with(base.model, effects)
        best = with_effect(model, self.effects[name], self._coarse, (*CONSTANTS, *self._strengths(effects)))
        refit = self._refit(effects, best)
        return Candidate(name, self._error(best), refit, compare(base.held_out, refit.held_out))

    def _strengths(self, effects: Sequence[str]) -> tuple[str, ...]:
        return tuple(self.effects[name].added[0].in_equations for name in effects)

    def _with(self, model: Model, effects: Sequence[str]) -> Model:
        """The model with these effects, new ones off."""
        on = tuple(effect for name, effect in self.effects.items() if name in effects)
        strengths = centred(off_values(on), self.records) | dict(model.strengths)
        return replace(model, strengths=strengths, chain=beyond_fast(self.bare.with_effects(on).chain))

    def _refit(self, effects: tuple[str, ...], start: Model) -> Refit:
        names = (*CONSTANTS, *start.table.names, *self._strengths(effects))
        first = _longer_first(solve(Residual(start, self._coarse, names)).model)
        weighed = tuple(each(lambda one: one.weighed(first), self._fine))
        solution = solve(Residual(first, weighed, names))
        held_out = self._out_of_fold(Residual(solution.model, weighed, names))
        error = np.mean([np.sqrt(np.mean(r**2) / one.power) for r, one in zip(held_out, self._shown, strict=True)])
        return Refit(effects, solution, self._error(solution.model), float(error), Residuals(held_out, self._bands))

    @cached_property
    def _bands(self) -> EnergyBands:
        """Of the positions that are compared, each record over the residual of the fitted model on it."""
        records = (
            ComparedRecord(float(np.sqrt(left)), one.record.id)
            for left, one in zip(self._left, self._shown, strict=True)
        )
        return EnergyBands(tuple(records), tuple(len(r) for r in self._positions(self.model)))

    def _positions(self, model: Model) -> list[Array]:
        return [one.residual(model) for one in self._shown]

    def _error(self, model: Model) -> float:
        """Eq. (17), averaged over the records."""
        pairs = zip(self._positions(model), self._shown, strict=True)
        return float(np.mean([np.sqrt(np.mean(r**2) / one.power) for r, one in pairs]))

    def _out_of_fold(self, whole: Residual) -> tuple[Array, ...]:
        """The residuals (n,) of the positions that are compared, by models that were fitted without each fold."""
        products, runs = whole.normal(whole.origin).products, len(self._fine)
        folds = [fold_of_segments(number, len(products) // runs, runs) for number in range(runs)]
        of_block = np.concatenate(folds)
        models = [
            whole.at(whole.origin + _bounded(products[of_block != fold].sum(axis=0)))
            for fold in range(of_block.max() + 1)
        ]
        shown = (folds[number] for number, one in enumerate(self._fine) if np.isfinite(one.position_scale))
        return tuple(
            _by_fold([one.residual(m) for m in models], of) for one, of in zip(self._shown, shown, strict=True)
        )


def _bar(base: Refit, candidates: Sequence[Candidate]) -> float:
    """The gain (nats) that the best of the candidates exceeds by chance in one case of twenty.

    A candidate's response is the difference of its refit from the model without it, in which all parameters moved.
    """
    held_out = [one.refit.held_out for one in candidates]
    before = base.held_out.series
    responses = [np.column_stack([run - other.series[at] for other in held_out]) for at, run in enumerate(before)]
    return bar(before, [np.empty((len(run), 0)) for run in before], responses, common_disturbance([base.held_out]))


def _by_fold(residuals: Sequence[Array], folds: NDArray[np.intp]) -> Array:
    """Of a record's residuals (n,), one of each fold, the one of the fold that each sample is in."""
    n = len(residuals[0])
    return np.asarray(np.array(residuals)[folds[np.arange(n) * len(folds) // n], np.arange(n)])


def _longer_first(model: Model) -> Model:
    """Two lags in series may change places: the longer one is T."""
    name = SECOND_LAG.added[0].in_equations
    second = model.strengths.get(name, 0.0)
    return replace(model.with_values({name: model.T}), T=second) if second > model.T else model


def _bounded(products: Array) -> Array:
    """The Gauss-Newton step of [J, r] products, no longer than one linearisation is believed along each axis."""
    p, longest = len(products) - 1, CRITERIA.cross_validation.longest_step
    return np.clip(bounded_step(np.full(p, 0.5), products[:p, :p], products[:p, p]), -longest, longest)


def finely(records: Sequence[Record]) -> tuple[Observed, ...]:
    """The records in steps so fine that a mean over samples is not taken for a lag."""
    return observe(records, rate=BENCH_CRITERIA.comparison.fine_rate)


def with_effect(model: Model, effect: Effect, observed: tuple[Observed, ...], names: tuple[str, ...]) -> Model:
    """The best of quick fits of these values, from a weak, a middling and a strong effect."""
    sizes = natural_sizes(model, [one.record for one in observed])
    few = CRITERIA.estimation.screen.most
    tried = [solve(Residual(start, observed, names), few) for start in _starts(model, effect, sizes)]
    return min(tried, key=lambda solution: solution.cost).model


def centred(values: Mapping[str, float], records: Sequence[Record]) -> dict[str, float]:
    """The values, a load that grows with the position being zero in the middle of all positions."""
    centre = SPRING_LOAD.added[1].in_equations
    middle = 0.5 * sum(ends_of_the_way(records))
    return {name: middle if name == centre else value for name, value in values.items()}


def _starts(model: Model, effect: Effect, sizes: Mapping[Starts, float]) -> list[Model]:
    """Models with some of an effect, the lag made shorter by what a second lag or a delay takes over."""
    strength = effect.added[0]
    if strength.start is Starts.TIME:
        return [
            replace(model.with_values({strength.in_equations: share * model.T}), T=(1.0 - share) * model.T)
            for share in _SHARES
        ]
    size = sizes.get(strength.start, strength.upper)
    signs = (1.0,) if strength.lower >= 0 else (1.0, -1.0)
    return [model.with_values({strength.in_equations: sign * share * size}) for share in _SHARES for sign in signs]
