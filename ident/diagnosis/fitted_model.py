"""A model at its optimum for the runs that it is fitted to, and its errors on these and other runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.diagnosis.auxiliary_channels import auxiliary_channels
from ident.diagnosis.compared_records import ComparedRecords
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.cross_validation import OutOfFold, out_of_fold
from ident.diagnosis.evidence.comparison import Residuals
from ident.diagnosis.evidence.evidence import BlockMean
from ident.diagnosis.evidence.free_run import FreeRun, adds_up
from ident.diagnosis.evidence.model_error import predicted_share
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.fit.fitness import Local
from ident.fit.levenberg_marquardt import Way
from ident.fit.low_frequency_delay import slow_lag
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.result import Combination, TransducerOffset
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import Space
from ident.fit.summary import told_offsets
from ident.fit.transducer import Offset, offset_at, offsets_that_count
from ident.fit.uncertainty import DETERMINED, Covariance, covariance
from ident.noise.effective_sample_size import independent_samples
from ident.run import Run, over_runs
from ident.time_budget import in_time
from ident.unstable import UNSTABLE
from ident.words.plus_minus import NOT_DETERMINED

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FittedModel:
    """A model with these effects at its optimum: `values` by the equations' names, SI."""

    effects: tuple[str, ...]
    values: Mapping[str, float]
    space: Space
    point: Array
    local: Local
    fitness: SimulatedFitness = field(repr=False)
    records: ComparedRecords = field(repr=False)

    @cached_property
    def held_out(self) -> OutOfFold:
        """Its residuals on stretches, or on whole runs, that were held out of the fit in turn."""
        lengths = [run.length for run in self.fitness.runs]
        return self._residuals(
            out_of_fold(self.point, self.local, self._left_of, self._seen, lengths, self.records.swept)
        )

    @cached_property
    def residuals_held_out(self) -> Residuals:
        """The held-out residuals, in the form in which models of these runs are compared."""
        return Residuals(self.held_out.residuals, self.records.bands, self.held_out.levels)

    @cached_property
    def residuals_fitted(self) -> Residuals:
        """Its residuals on the runs that it was fitted to: they compare models with equal numbers of parameters."""
        every = range(len(self.fitness.runs))
        fitted = self._residuals(next(self._left_of([self.point], every)))
        return Residuals(fitted.residuals, self.records.bands, fitted.levels)

    @cached_property
    def predicted_share(self) -> BlockMean:
        """The share of its residual that the inputs predict: above zero where it lacks an effect."""
        fitness, runs = self.fitness, self.fitness.runs
        outputs = fitness.outputs(self.point)
        inputs = ("command", *auxiliary_channels(fitness.preset, fitness.matrix.runs, runs))
        return predicted_share(
            [fitness.left(run, outputs[run.id]) for run in runs],
            [[run.channels[name] for name in inputs] for run in runs],
            [outputs[run.id] for run in runs],
            max(int(min(run.sample_rate for run in runs) * np.pi / (2 * fitness.band)), 1),  # four samples a period
        )

    @cached_property
    def free_run(self) -> FreeRun:
        """The free run of the runs that it is fitted to over windows."""
        return self.free_run_of(self.fitness.runs)

    def free_run_of(self, runs: Sequence[Run]) -> FreeRun:
        """The free run of any runs of the matrix, begun as their windows are, and its expected power."""
        own = self.fitness if tuple(runs) == self.fitness.runs else self.fitness.fresh(tuple(runs))
        whole = own.whole()
        found = whole.exact(self.point).runs
        if not all(np.isfinite(of.error) for of in found):
            return FreeRun(np.inf, 0.0)
        outputs = whole.outputs(self.point)
        expected = [
            self._expected(run, run.measured - outputs[run.id], of) for run, of in zip(whole.runs, found, strict=True)
        ]
        power = [of.error**2 + of.offset**2 for of in found]
        return FreeRun(float(over_runs(power, whole.runs)), float(over_runs(expected, whole.runs)))

    def _expected(self, run: Run, residual: Array, found: NormalMatrices) -> float:
        """The power that the disturbances at the ends of the windows, and the errors of the parameters, add up to."""
        anchoring, p = self.fitness.anchoring(run), len(self.point)
        window = min(anchoring.window, run.length)
        ends = anchoring(residual)[window - 1 :: window]
        lasting = len(ends) / max(independent_samples(ends), 1.0)  # windows over which a disturbance is correlated
        own = lasting * float(np.mean(ends**2)) / run.power * run.length
        shared = found.gram[:p, :p] + found.length * np.outer(found.means[:p], found.means[:p])
        of_parameters = float(np.sum(self._known.seen * shared)) / found.total
        return adds_up(own, run.length / window, anchoring.memory > 0) + of_parameters

    def _left_of(self, points: Sequence[Array], numbers: Sequence[int]) -> Iterator[list[Array]]:
        """The residuals of the model at each point on some runs, means included; over windows as these show them.

        The free runs at two points drift apart: windows may not begin in the one and end in the other.
        """
        runs = tuple(self.fitness.runs[number] for number in numbers)
        for outputs in self.fitness.part(runs).outputs_of_points(points):
            yield [self.fitness.shown(run, run.measured - outputs[run.id]) for run in runs]

    def _seen(self, number: int, residual: Array) -> Array:
        """The residual of a run in the loss: less its mean or the offset of its transducer, or as its windows show
        it."""
        if self.fitness.horizon is not None:
            return residual
        if self.local.runs[number].counted:
            return residual - offset_at(self.fitness.runs[number], self._offsets)
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(residual - residual.mean())

    def _residuals(self, whole: Sequence[Array]) -> OutOfFold:
        """The residuals in eq. (17), and their means."""
        runs = self.fitness.runs
        with np.errstate(over="ignore", invalid="ignore"):
            sizes = np.array([float(np.std(run.measured)) for run in runs])
            means = np.array([float(r.mean()) for r in whole]) / sizes
            seen = tuple(self._seen(number, r) for number, r in enumerate(whole))
        if self.fitness.horizon is not None or any(run.counted for run in self.local.runs):
            means = np.zeros(len(runs))  # windows have none, and where the mean counts the residuals hold it
        return OutOfFold(seen, sizes, means - means.mean(), np.array([run.share for run in runs]))

    def reordered(self, effects: tuple[str, ...]) -> FittedModel:
        """The same model with its effects in another order; its cached results stay."""
        other = copy(self)
        other.__dict__["effects"] = effects
        return other

    @property
    def stable(self) -> bool:
        """Whether the model is stable on every run."""
        return bool(np.isfinite(self.local.error))

    def asks_for(self, way: Way, share: float) -> bool:
        """Whether a further step, within the bounds of the `way`, predicts a reduction of more than a share of the
        error."""
        return self.stable and way.promised(self.point, self.local, self.space.spans) > share * self.local.error

    @property
    def finite(self) -> bool:
        """Whether the model is stable on every run, and a simulation confirms its residual."""
        return self.stable and self._simulation_confirms

    @cached_property
    def _simulation_confirms(self) -> bool:
        """Whether a simulation from the estimated initial states has the residual of their linear correction.

        A model that is not linear in them may have a small predicted residual that no initial state reaches.
        """
        return not self._moving or self._confirms(self._simulated)

    @property
    def _moving(self) -> bool:
        return any(run.begins == "moving" for run in self.fitness.runs)

    def _confirms(self, simulated: _Simulated) -> bool:
        return simulated.error < CRITERIA.estimation.simulation_excess * self.error

    @cached_property
    def _simulated(self) -> _Simulated:
        """The simulation from the initial states of the search, or from new guesses where it does not confirm those."""
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
        """The error of eq. (17) averaged over validation data; None where there are none, or the model is unstable on
        one.

        The residual is of a simulation from the estimated initial states: their linear correction would make the error
        of a nonlinear model too small.
        """
        found = self._verified
        return None if found is None or found.unstable else found.error

    @cached_property
    def _verified(self) -> _Simulated | None:
        """The residuals of a simulation of the validation data; None where there are none."""
        runs = self.fitness.matrix.of_use("verify")
        return _Simulated.of(self.fitness.fresh(runs), self.point, self._offsets) if runs else None

    @property
    def unstable(self) -> dict[str, tuple[str, ...]]:
        """By use the ids of the runs on which it is unstable, only for uses with such runs."""
        pairs = zip(self.fitness.runs, self.local.runs, strict=True)
        fitted = tuple(run.id for run, found in pairs if not found.error < UNSTABLE)
        known = None if fitted else in_time(lambda: self._verified)
        verified = known.unstable if known is not None else ()
        return {use: runs for use, runs in (("fit", fitted), ("verify", verified)) if runs}

    @property
    def errors_with_mean(self) -> dict[str, float | None]:
        """RMS(x − x_m)/std(x_m) by use; {} over windows, whose errors count the mean."""
        if self.fitness.horizon is not None or not self.stable:
            return {}
        found: dict[str, float | None] = {"fit": float(over_runs(self._with_mean, self.local.runs))}
        known = in_time(lambda: self._verified)
        return found | ({} if known is None or known.unstable else {"verify": known.with_mean})

    @property
    def rmse(self) -> dict[str, float | None]:
        """RMS(x − x_m) in :attr:`rmse_unit` by use; {} where no mean is counted."""
        runs, found = self.fitness.runs, self.errors_with_mean
        if not self.rmse_unit or not found:
            return {}
        left = [of * float(np.std(run.measured)) for of, run in zip(self._with_mean, runs, strict=True)]
        sizes: dict[str, float | None] = {"fit": float(over_runs(left, runs))}
        known = in_time(lambda: self._verified)
        return sizes | ({"verify": known.rmse} if known is not None and "verify" in found else {})

    @property
    def rmse_unit(self) -> str:
        """The SI unit of the measured outputs; "" where they have several."""
        units = {run.units.get(run.output, "1") for run in self.fitness.runs}
        return units.pop() if len(units) == 1 else ""

    @property
    def _with_mean(self) -> list[float]:
        """RMS(x − x_m)/std(x_m) of each run that is fitted, with the offsets of transducers."""
        pairs = zip(self.fitness.runs, self.local.runs, strict=True)
        return [
            float(np.hypot(of.error, of.offset - offset_at(run, self._offsets) / float(np.std(run.measured))))
            for run, of in pairs
        ]

    @cached_property
    def _offsets(self) -> Mapping[str, Offset]:
        """The offsets of transducers that are part of the model."""
        return {} if self.fitness.horizon is not None else offsets_that_count(self.local)

    @property
    def transducer_offset(self) -> dict[str, TransducerOffset]:
        """The offsets of transducers in the form of a result."""
        return told_offsets(self._offsets, self.fitness.matrix)

    @property
    def errors(self) -> dict[str, float | None]:
        """Its errors by use; None where it is unstable on a run that it is fitted to.

        An error is None, too, where there is no time for its simulation.
        """
        if not self.stable:
            return {"fit": None, "held_out": None, "verify": None}
        held_out, verify = in_time(lambda: self.held_out.error), in_time(lambda: self.on_verify)
        return {"fit": self.error, "held_out": held_out, "verify": verify}

    @cached_property
    def on_verify_runs(self) -> tuple[list[Array], Array | None]:
        """Its residuals on validation data by eq. (17), (n,) each, and their means that count, (runs,).

        The means are less the offset of their transducer, and zero for a run whose mean does not count. They are None
        where no mean counts, or the model is fitted over windows.
        """
        runs = self.fitness.matrix.of_use("verify")
        outputs = self.fitness.fresh(runs).outputs(self.point)
        residuals = [self.fitness.left(run, outputs[run.id]) for run in runs]
        if self.fitness.horizon is not None or not any(run.mean_counts for run in runs):
            return residuals, None
        return residuals, np.array([self._counted_mean(run, outputs[run.id]) for run in runs])

    @cached_property
    def zeros(self) -> dict[str, float]:
        """Where the zero of the model lies in the reading of each fitted run, by its id: 0 over windows.

        It is the offset of the transducer where the mean counts, and the mean of the residual where it does not.
        """
        if self.fitness.horizon is not None:
            return dict.fromkeys((run.id for run in self.fitness.runs), 0.0)
        outputs = self.fitness.outputs(self.point)
        return {
            run.id: offset_at(run, self._offsets) if run.mean_counts else float(np.mean(run.measured - outputs[run.id]))
            for run in self.fitness.runs
        }

    def _counted_mean(self, run: Run, output: Array) -> float:
        with np.errstate(over="ignore", invalid="ignore"):
            mean = float(np.mean(run.measured - output)) - offset_at(run, self._offsets)
        return mean if run.mean_counts else 0.0

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
        """The total delay of its response to a slow command, where the data determine it."""
        return slow_lag(self.fitness, self._known)

    @property
    def parameters(self) -> dict[str, ParameterEstimate]:
        """The estimate of every parameter, by its name."""
        preset, found = self.fitness.preset, {}
        for one in preset.parameters:
            name = one.in_equations
            found[one.name] = ParameterEstimate(self.values[name], preset.unit(one), self.deviation(name), one.symbol)
        return found

    @property
    def offset(self) -> float:
        """The mean of the runs' offsets."""
        return float(over_runs([run.offset for run in self.local.runs], self.local.runs))


@dataclass(frozen=True)
class _Simulated:
    """The error and residuals of a simulation of runs: eq. (17) averaged over them.

    `with_mean` is RMS(x − x_m)/std(x_m) of whole runs, `rmse` RMS(x − x_m), averaged as the error is;
    `unstable` are the ids of the runs on which the model is.
    """

    error: float
    with_mean: float
    rmse: float
    unstable: tuple[str, ...]

    @classmethod
    def of(cls, fitness: SimulatedFitness, point: Array, offsets: Mapping[str, Offset] | None = None) -> _Simulated:
        """Simulate the model at a point, with the `offsets` of transducers."""
        outputs, runs = fitness.outputs(point), fitness.runs
        left = [fitness.left(run, outputs[run.id]) for run in runs]
        errors = [_rms(r) / np.std(run.measured) for r, run in zip(left, runs, strict=True)]
        whole = [run.measured - outputs[run.id] - offset_at(run, offsets or {}) for run in runs]
        sizes = [_rms(r) for r in whole]
        with_mean = over_runs([size / np.std(run.measured) for size, run in zip(sizes, runs, strict=True)], runs)
        unstable = tuple(run.id for run, error in zip(runs, errors, strict=True) if not error < UNSTABLE)
        return cls(float(over_runs(errors, runs)), float(with_mean), float(over_runs(sizes, runs)), unstable)


def _rms(residual: Array) -> float:
    """The root mean square, infinite where it overflows: a model that diverged gives no warning."""
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.sqrt(np.mean(residual**2)))
