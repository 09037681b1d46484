"""A model at its optimum for the runs that it is fitted to, and how it does there and elsewhere."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.cross_validation import CrossValidation, by_chunk, cross_validated, not_held_out
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.significance import improvement
from ident.fit.fitness import STEP, Local, Worth
from ident.fit.result import Combination
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.slow_answer import slow_lag
from ident.fit.space import Space
from ident.fit.uncertainty import DETERMINED, Covariance, covariance
from ident.noise.autoregression import prediction_errors
from ident.noise.effective_sample_size import independent_samples
from ident.run import Run, over_runs
from ident.time_budget import in_time
from ident.unstable import UNSTABLE
from ident.words.plus_minus import NOT_DETERMINED

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FittedModel:
    """A model with these effects at its optimum: `values` by the equations' names, SI."""

    effects: tuple[str, ...]
    values: Mapping[str, float]
    space: Space
    point: Array
    local: Local
    fitness: SimulatedFitness = field(repr=False)

    @cached_property
    def held_out(self) -> CrossValidation:
        """Its errors on blocks that were left out in turn."""
        found = cross_validated(self.point, self.local, self._evaluated, self._simulated.independent)
        return self._with_innovations(found)

    @cached_property
    def not_held_out(self) -> CrossValidation:
        """The same with nothing left out: to compare models of as many parameters."""
        return self._with_innovations(not_held_out(self.local, self._simulated.independent))

    def _evaluated(self, point: Array, worth: Worth) -> Local:
        return self.fitness.exact(point, worth=worth)

    def _with_innovations(self, found: CrossValidation) -> CrossValidation:
        innovations = self._simulated.innovations(found.squares.shape[1])
        return replace(found, innovations=innovations, in_windows=self.fitness.horizon is not None)

    def reordered(self, effects: tuple[str, ...]) -> FittedModel:
        """The same model with its effects in another order; what is known of it stays known."""
        other = copy(self)
        other.__dict__["effects"] = effects
        return other

    @cached_property
    def between_runs(self) -> CrossValidation | None:
        """Its errors on whole runs that were left out in turn; None of a single run."""
        if len(self.local.runs) < 2:
            return None
        return cross_validated(self.point, self.local, self._evaluated, self._simulated.independent, whole_runs=True)

    @property
    def stable(self) -> bool:
        """Whether the model is stable on every run."""
        return bool(np.isfinite(self.local.error))

    @property
    def finite(self) -> bool:
        """Whether the model is stable on every run, and leaves there what it promises."""
        return self.stable and self._simulation_confirms

    @cached_property
    def _simulation_confirms(self) -> bool:
        """Whether a simulation from the first states that were found leaves what their linear correction promises.

        A model that is not linear in them may look good where no first state at all leads.
        """
        return not self._moving or self._confirms(self._simulated)

    @property
    def _moving(self) -> bool:
        return any(run.begins == "moving" for run in self.fitness.runs)

    def _confirms(self, simulated: _Simulated) -> bool:
        return simulated.error < CRITERIA.estimation.simulation_excess * self.error

    @cached_property
    def _simulated(self) -> _Simulated:
        """From the first states that the search went with, or from guesses where those lead nowhere."""
        found = _Simulated.of(self.fitness, self.point)
        if not self._moving or self._confirms(found):
            return found
        again = _Simulated.of(self.fitness.fresh(self.fitness.runs), self.point)
        return again if self._confirms(again) else found

    @property
    def error(self) -> float:
        """Eq. (17) averaged over the runs."""
        return float(over_runs([run.error for run in self.local.runs], self.local.runs))

    @cached_property
    def on_verify(self) -> float | None:
        """Eq. (17) averaged over the runs to verify; None where there are none, or the model is unstable on one.

        Of what it leaves there once their first states are found, as a comparison shows it: what is linear in these
        would flatter a model that is not.
        """
        found = self._verified
        return None if found is None or found.unstable else found.error

    @cached_property
    def _verified(self) -> _Simulated | None:
        """What a simulation of the runs to verify leaves; None where there are none."""
        runs = self.fitness.matrix.of_use("verify")
        return _Simulated.of(self.fitness.fresh(runs), self.point) if runs else None

    @property
    def unstable(self) -> dict[str, tuple[str, ...]]:
        """By the use of runs the ids of those on which it is unstable; a use without such runs is left out."""
        pairs = zip(self.fitness.runs, self.local.runs, strict=True)
        fitted = tuple(run.id for run, found in pairs if not found.error < UNSTABLE)
        known = None if fitted else in_time(lambda: self._verified)
        verified = known.unstable if known is not None else ()
        return {use: runs for use, runs in (("fit", fitted), ("verify", verified)) if runs}

    @property
    def errors_with_mean(self) -> dict[str, float | None]:
        """RMS(x − x_m)/std(x_m) by what it is measured on; nothing over windows, whose errors count the mean."""
        if self.fitness.horizon is not None or not self.stable:
            return {}
        fitted = [float(np.hypot(run.error, run.offset)) for run in self.local.runs]
        found: dict[str, float | None] = {"fit": float(over_runs(fitted, self.local.runs))}
        known = in_time(lambda: self._verified)
        return found | ({} if known is None or known.unstable else {"verify": known.with_mean})

    @property
    def errors(self) -> dict[str, float | None]:
        """Its errors by what they are measured on; None where it is unstable on a run that it is fitted to.

        And where there is no time to simulate it there.
        """
        if not self.stable:
            return {"fit": None, "held_out": None, "verify": None}
        held_out, verify = in_time(lambda: self.held_out.error), in_time(lambda: self.on_verify)
        return {"fit": self.error, "held_out": held_out, "verify": verify}

    def residuals(self, runs: Sequence[Run]) -> list[Array]:
        """What it leaves of any runs of the matrix, (n,) each, less its mean or over windows."""
        outputs = self.fitness.fresh(tuple(runs)).outputs(self.point)
        return [self.fitness.left(run, outputs[run.id]) for run in runs]

    @property
    def hysteretic(self) -> frozenset[str]:
        """Its effects that act in jumps."""
        return frozenset(effect.name for effect in self.fitness.preset.effects if effect.stride > STEP)

    @cached_property
    def _known(self) -> Covariance:
        return covariance(self.local, self.point)

    def deviation(self, parameter: str) -> float | None:
        """The standard error of a parameter by its name in the equations; None where it is held or not determined."""
        if parameter not in self.space.names:
            return None
        error = self._known.deviation(lambda points: self.space.values(points)[parameter])
        return error if np.isfinite(error) and error <= NOT_DETERMINED * abs(self.values[parameter]) else None

    @property
    def at_bounds(self) -> tuple[str, ...]:
        """The parameters, by their names in the equations, that are known and for which the data ask beyond a bound."""
        ended = (name for name in self.space.names if self.space.at_bound(name, self.point))
        known = ((name, abs(self.values[name]), self.deviation(name)) for name in ended)
        return tuple(name for name, value, error in known if error is not None and error < DETERMINED * value)

    def slow_lags(self) -> Iterator[Combination]:
        """How late it answers to a slow command, where that is determined."""
        return slow_lag(self.fitness, self._known)

    @property
    def parameters(self) -> dict[str, ParameterEstimate]:
        """What it found of every parameter, by its name."""
        preset, found = self.fitness.preset, {}
        for one in preset.parameters:
            name = one.in_equations
            found[one.name] = ParameterEstimate(self.values[name], preset.unit(one), self.deviation(name), one.symbol)
        return found

    @property
    def offset(self) -> float:
        """The mean of the runs' offsets."""
        return float(over_runs([run.offset for run in self.local.runs], self.local.runs))


def improves(less: FittedModel, more: FittedModel) -> bool:
    """Whether a model does better than another beyond chance, and what it has learned holds from run to run."""
    return improvement(less.held_out, more.held_out).beyond_chance and generalises(less, more)


def generalises(less: FittedModel, more: FittedModel) -> bool:
    """Whether a model is no worse than another, but by chance, on whole runs that neither was fitted to.

    What does better on blocks of runs that it has seen, and worse here, tells runs apart instead of explaining them.
    """
    return not dominated(more, less, share=-np.inf)


def dominated(worse: FittedModel, better: FittedModel, share: float = CRITERIA.significance.dominated) -> bool:
    """Whether of two models one is better beyond chance, and by a `share`, on whole runs that neither was fitted to.

    Equals whose fits end at other optima lie some per cent apart there.
    """
    before, after = worse.between_runs, better.between_runs
    if before is None or after is None:
        return False
    gain = improvement(before, after)
    return gain.beyond_chance and gain.reduction > share


def indistinguishable(best: FittedModel, other: FittedModel, base: FittedModel | None = None) -> bool:
    """Whether of two refits the better one is better by chance only, or by no more than refits of it end apart.

    What acts in jumps has an optimum behind every jump: moved by next to nothing it ends at another, some per cent off.
    So far off is alike only what explains most of what the best explains of that which a `base` left.
    """
    if improvement(other.held_out, best.held_out).within_chance:
        return True
    least, left = best.held_out.score, other.held_out.score
    most = (
        np.inf
        if base is None
        else base.held_out.score - CRITERIA.significance.hysteretic_share * (base.held_out.score - least)
    )
    return best.hysteretic != other.hysteretic and left <= min(CRITERIA.significance.hysteretic_scatter * least, most)


def distinguishable(worse: FittedModel, better: FittedModel) -> bool:
    """Whether of two models of as many parameters, at the noise, one is likelier beyond chance, by however little."""
    return (
        not indistinguishable(better, worse)
        and improvement(worse.held_out, better.held_out).likelihood_gain_significant
    )


@dataclass(frozen=True)
class _Simulated:
    """What a simulation leaves of runs: eq. (17) averaged over them, and how many of its samples tell something new.

    `whole` (n,) is what it leaves of each from its first sample to its last, `with_mean` RMS(x − x_m)/std(x_m) of it,
    averaged as the error is; `unstable` are the ids of the runs on which the model is.
    """

    error: float
    independent: float
    whole_residuals: list[Array]
    with_mean: float
    unstable: tuple[str, ...]

    @classmethod
    def of(cls, fitness: SimulatedFitness, point: Array) -> _Simulated:
        """Simulate the model at a point."""
        outputs, runs = fitness.outputs(point), fitness.runs
        left = [fitness.left(run, outputs[run.id]) for run in runs]
        errors = [_rms(r) / np.std(run.measured) for r, run in zip(left, runs, strict=True)]
        whole = [run.measured - outputs[run.id] for run in runs]
        with_mean = over_runs([_rms(r) / np.std(run.measured) for r, run in zip(whole, runs, strict=True)], runs)
        unstable = tuple(run.id for run, error in zip(runs, errors, strict=True) if not error < UNSTABLE)
        independent = sum(map(independent_samples, left))
        return cls(float(over_runs(errors, runs)), independent, whole, float(with_mean), unstable)

    def innovations(self, chunks: int) -> Array:
        """Σ of squares of what the past of each residual does not foretell, by chunk, (runs, chunks)."""
        return by_chunk([prediction_errors(residual) for residual in self.whole_residuals], chunks)


def _rms(residual: Array) -> float:
    """The root mean square, infinite of what overflows: a model that ran away is no warning."""
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.sqrt(np.mean(residual**2)))
