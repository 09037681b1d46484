"""A fitted model beside the measurements, run by run."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import linear_model
from ident.comparison.frequency_response import DescribingGain, Spectra, describing_gain, spectra
from ident.custom.definition import preset_with
from ident.effects.effect import usual_shapes
from ident.errors import Unusable
from ident.fit.known_zeros import with_known_zeros
from ident.fit.normal_matrices import output
from ident.fit.result import FitResult
from ident.fit.simulated_runs import BegunOver, every_run, is_simulated
from ident.fit.transducer import offset_at
from ident.linear import LinearModel
from ident.matrix import Actuator, Matrix
from ident.parallel import each
from ident.preprocessing import prepare
from ident.presets import Preset
from ident.run import USES, Run, over_runs
from ident.unstable import UNSTABLE, bounded
from ident.words.engineering import quantity
from ident.words.error import ErrorOf, first_line
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Simulator = Callable[[Preset, Mapping[str, float], Matrix], dict[str, Array]]
"""A model, its values by the equations' names and a matrix in; the output of every run out, by the run's id."""
_HUGE = 1e100  # of a signal: its square is still a number
_NUMBERS = ("RMSE", "with the mean", "NRMSE fit", "eq. (17)", "offset", "MAE")


@dataclass(frozen=True)
class RunComparison(TabularResult):
    """One run: eq. (17), the offset, the model's output and the frequency responses.

    `modelled` (n,) is in the run's own unit, beside ``run.measured``, with the offset `of_transducer`; `linear` is None
    for a model with effects. `core` makes the linear model that such a model has without its effects.
    """

    run: Run
    linear: LinearModel | None
    modelled: Array
    of_transducer: float = 0.0
    core: Callable[[], LinearModel] | None = None

    def listings(self) -> Iterable[Listing | str]:
        """Its errors, a row."""
        yield Listing("", ("run", "use", *_NUMBERS), [self.row], _NUMBERS)

    @property
    def row(self) -> tuple[str, ...]:
        """Id, use, RMSE, the error with the mean counted, eq. (17), offset and mean size of the residual."""
        offset, of = "–" if self.unstable else percent(self.offset), self.words
        mean_size = "–" if self.mae is None else quantity(self.mae, self.unit)
        return (self.run.id, self.run.use, of.rmse or "–", of.counted(), of.fit(), of.alone(), offset, mean_size)

    @cached_property
    def error(self) -> float:
        """Eq. (17): std(x_m − x) / std(x_m), at most :data:`ident.unstable.UNSTABLE`."""
        return bounded(float(np.std(self.residual) / np.std(self.run.measured)))

    @cached_property
    def offset(self) -> float:
        """Difference of the means over the standard deviation, of the model without the offset of its transducer."""
        offset = float((np.mean(self.residual) + self.of_transducer) / np.std(self.run.measured))
        return math.copysign(bounded(abs(offset)), offset) if self.unstable else offset

    @property
    def error_with_mean(self) -> float:
        """RMS(x − x_m) / std(x_m): it sees the means that eq. (17) does not."""
        remaining = self.offset - self.of_transducer / float(np.std(self.run.measured))
        return UNSTABLE if self.unstable else math.hypot(self.error, remaining)

    @property
    def fit_percent(self) -> float | None:
        """100 (1 − ‖x − x_m‖/‖x_m − mean x_m‖) of the free simulation; None where the model is unstable on the run."""
        return None if self.unstable else 100.0 * (1.0 - self.error_with_mean)

    @property
    def unstable(self) -> bool:
        """Whether the model is unstable on the run."""
        return not self.error < UNSTABLE

    @property
    def words(self) -> ErrorOf:
        """Its error as a reader reads it."""
        size = "" if self.rmse is None else quantity(self.rmse, self.unit)
        return ErrorOf(self.error, self.error_with_mean, (self.run.id,) if self.unstable else (), size)

    @cached_property
    def residual(self) -> Array:
        """Measured − modelled, (n,); where the model ran away, the largest finite number."""
        with np.errstate(over="ignore", invalid="ignore"):
            left = np.nan_to_num(self.run.measured - self.modelled, nan=_HUGE)
        return np.clip(left, -_HUGE, _HUGE)

    @property
    def unit(self) -> str:
        """The unit of the residual, SI or the record's own."""
        return self.run.units.get(self.run.output, "1")

    @cached_property
    def rmse(self) -> float | None:
        """The residual's root mean square √(mean (x_m − x)²) in `unit`: it sees the offset, which eq. (17) does not.

        None where the model is unstable on the run.
        """
        return None if self.unstable else float(np.sqrt(np.mean(self.residual**2)))

    @cached_property
    def mae(self) -> float | None:
        """The residual's mean size, mean |x_m − x|, in `unit`; None where the model is unstable on the run."""
        return None if self.unstable else float(np.mean(np.abs(self.residual)))

    @property
    def frequency(self) -> Array:
        """Frequencies of the estimates in Hz, (f,), without zero."""
        return self._spectra.frequency

    @property
    def measured(self) -> Complex:
        """Measured frequency response, the H1 estimate S_ux / S_uu, (f,)."""
        return self._spectra.response

    @property
    def coherence(self) -> Array:
        """|S_ux|² / (S_uu S_xx), (f,)."""
        return self._spectra.coherence

    @property
    def random_error(self) -> Array:
        """Relative standard error of the measured response, (f,)."""
        return self._spectra.random_error

    def response(self, frequency: Array) -> Complex:
        """The model's own frequency response at `frequency` (f,) in Hz; with effects its describing gain."""
        if self.linear is not None:
            return np.asarray(self.linear.frequency_response(frequency)[0])
        core, gain = self._described
        answer = gain.at(frequency)
        return answer if core is None else np.asarray(core.frequency_response(frequency)[0] * answer)

    @cached_property
    def _described(self) -> tuple[LinearModel | None, DescribingGain]:
        """The linear model without effects and the describing gain over its output; or None, and over the command."""
        core = self.core() if self.core else None
        reference = None if core is None else output(self.run, core)
        if reference is None or not np.abs(reference).max() < _HUGE:
            return None, describing_gain(self.run, self.run.command, self.modelled)
        return core, describing_gain(self.run, reference, self.modelled)

    @cached_property
    def _spectra(self) -> Spectra:
        return spectra(self.run, self.run.command, self.run.measured)


@dataclass(frozen=True)
class Comparison(TabularResult):
    """All runs of a matrix against one fit."""

    matrix: Matrix
    fit: FitResult
    runs: tuple[RunComparison, ...]

    @property
    def error(self) -> dict[str, float | None]:
        """Eq. (17) averaged over the runs of each use, but for those that the fit left out."""
        return {use: self._mean(use, "error") for use in USES}

    @property
    def offset(self) -> dict[str, float | None]:
        """The offset averaged over the runs of each use."""
        return {use: self._mean(use, "offset") for use in USES}

    @property
    def error_with_mean(self) -> dict[str, float | None]:
        """RMS(x − x_m)/std(x_m) averaged over the runs of each use."""
        return {use: self._mean(use, "error_with_mean") for use in USES}

    @property
    def fit_percent(self) -> dict[str, float | None]:
        """The fit to the data averaged over the runs of each use, %; None where the model is unstable on one."""
        return {
            use: None if any(one.unstable for one in self._meant(use)) else self._mean(use, "fit_percent")
            for use in USES
        }

    @property
    def rmse(self) -> dict[str, float | None]:
        """The RMSE averaged over the runs of each use; None where a run has none, or the outputs have several units."""
        units = {one.unit for one in self.runs}
        known = {use: all(one.rmse is not None for one in self._meant(use)) for use in USES}
        return {use: self._mean(use, "rmse") if told and len(units) == 1 else None for use, told in known.items()}

    def error_of(self, use: str) -> ErrorOf:
        """The error on the runs of a use as a reader reads it."""
        unstable = tuple(one.run.id for one in self._meant(use) if one.unstable)
        size = self.rmse[use]
        said = "" if size is None else quantity(size, self.runs[0].unit)
        return ErrorOf(self.error[use], self.error_with_mean[use], unstable, said, self.fit.error_of(use).offset)

    @property
    def headline(self) -> str:
        """The first line: the error on each use of runs with what a reader must know beside it."""
        return first_line(" + ".join((self.fit.model, *self.fit.effects)), {use: self.error_of(use) for use in USES})

    def listings(self) -> Iterable[Listing | str]:
        """The error of every run, in per cent and in its unit, and the means."""
        yield self.headline
        rows = [one.row for one in self.runs]
        means = {use: self.error_of(use) for use in USES}
        rows += [
            ("mean", use, of.rmse or "–", of.counted(), of.fit(), of.alone(), "", "")
            for use, of in means.items()
            if of.error is not None
        ]
        yield Listing("", ("run", "use", *_NUMBERS), rows, _NUMBERS)

    def records(self) -> list[dict[str, Any]]:
        """A record a run, for a data frame: eq. (17) and the offset as fractions, RMSE and MAE in `unit`.

        `error_with_mean` is RMS(x − x_m)/std(x_m). Where the model is unstable on a run there is no RMSE and no MAE.
        """
        return [
            {
                "id": one.run.id,
                "use": one.run.use,
                "error": one.error,
                "offset": one.offset,
                "error_with_mean": one.error_with_mean,
                "fit_percent": one.fit_percent,
                "rmse": one.rmse,
                "mae": one.mae,
                "unit": one.unit,
            }
            for one in self.runs
        ]

    def _meant(self, use: str) -> list[RunComparison]:
        """The runs of a use that a mean is over: not those that the fit left out."""
        return [one for one in self.runs if one.run.use == use and one.run.id not in self.fit.left_out]

    def _mean(self, use: str, what: str) -> float | None:
        found = self._meant(use)
        return float(over_runs([getattr(run, what) for run in found], [run.run for run in found])) if found else None


def modelled(
    preset: Preset, values: Mapping[str, float], matrix: Matrix, begun_over: BegunOver | None = None
) -> dict[str, Array]:
    """The output of a model with effects for every run of a matrix, by the run's id; it may be begun over windows."""
    return replace(every_run(preset, matrix), begun_over=begun_over).outputs_at(values)


def compare(matrix: Matrix, fit: FitResult, simulator: Simulator = modelled) -> Comparison:
    """Every run of the matrix against the fitted model; `simulator` runs a model whose fit simulates.

    Raises Unusable where the fit is of another model's data.
    """
    preset, matrix, values = fitted(fit, matrix)
    if fit.window:
        simulator = partial(modelled, begun_over=(fit.window.horizon, fit.window.memory))
    outputs = simulator(preset, values, matrix) if is_simulated(preset, matrix) else None

    def one(run: Run) -> RunComparison:
        own = offset_at(run, fit.transducer_offset)
        model = linear_model(preset.core, values, run, matrix.actuator) if preset.is_linear else None
        if outputs is not None:
            core = None if preset.core.memories else partial(linear_model, preset.core, values, run, matrix.actuator)
            return RunComparison(run, model, outputs[run.id] + own, own, core)
        assert model is not None
        return RunComparison(run, model, output(run, model) + own, own)

    return Comparison(matrix, fit, tuple(each(one, matrix.runs)))


def fitted(fit: FitResult, matrix: Matrix) -> tuple[Preset, Matrix, dict[str, float]]:
    """The model of a fit as it suits a matrix, the matrix as it was fitted, and its values by equations' names.

    What drives the model is in the matrix, and the zeros that rest tells count where they did in the fit.

    Raises Unusable where a value is missing.
    """
    named = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    load, switches = str(fit.settings.get("load", "none")), fit.settings.get("preprocessing", {})
    preset, driven = prepare(named, matrix, load, switches)
    values = usual_shapes(named.effects)
    values |= {preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    missing = [p.name for p in preset.parameters if p.in_equations not in values]
    if missing:
        raise Unusable("bad-fit", f"no value of {', '.join(missing)}", "fit", f"give a fit of model {fit.model}")
    return preset, with_known_zeros(driven, fit.settings.get("known_zeros", ())), values


def response(fit: FitResult, run: Run, actuator: Actuator, frequency: Array) -> Complex:
    """The frequency response (f,) of the fitted model's linear core at `frequency` in Hz.

    For a run of the matrix, or one whose conditions were changed.
    """
    preset, matrix, values = fitted(fit, Matrix(actuator, (run,)))
    if preset.core.memories:
        raise Unusable(
            "no-linear-core",
            f"the model {preset.name} has no linear core: its play acts at any amplitude",
            "frequency response",
            "use the figures of the bench",
        )
    return np.asarray(linear_model(preset.core, values, matrix.runs[0], actuator).frequency_response(frequency)[0])
