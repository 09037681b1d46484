"""What a fit found, in the contract's words."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ident.errors import Unusable
from ident.fit.sheet_quantity import SheetQuantity
from ident.matrix import Actuator, Matrix, StepOutcome
from ident.plain import UNWRITTEN, WHERE_KNOWN, Misfit, read, written
from ident.presets.description import description
from ident.presets.record_units import SAMPLE
from ident.run import USES
from ident.unstable import UNSTABLE
from ident.words.engineering import quantity
from ident.words.error import ErrorOf, first_line
from ident.words.result_tables import TabularResult


@dataclass(frozen=True)
class Estimate:
    """One parameter: value, standard error (None where the data do not determine it), bounds, all in `unit`."""

    value: float
    unit: str
    std_error: float | None
    lower: float
    upper: float
    at_bound: bool
    symbol: str = ""
    meaning: str = ""
    fixed: bool = False


@dataclass(frozen=True)
class Combination:
    """A product of powers of parameters that the data determine although its factors may not be."""

    expression: str
    value: float
    unit: str
    std_error: float


@dataclass(frozen=True)
class Undetermined:
    """A parameter that the data do not determine, and why."""

    name: str
    reason: str


@dataclass(frozen=True)
class TransducerOffset:
    """What the transducer of a channel reads above the model, one number for all of its runs, in `unit`.

    A `large` one is the larger part of the residual, so that every error is said with it.
    """

    value: float
    unit: str
    std_error: float
    large: bool = False


def large_offsets(offsets: Mapping[str, TransducerOffset]) -> str:
    """The large ones in words: "3.2 V"."""
    return " and ".join(quantity(one.value, one.unit) for one in offsets.values() if one.large)


@dataclass(frozen=True)
class RunError:
    """Eq. (17) of one run, and its offset (difference of means over the standard deviation).

    `error_with_mean` is RMS(x − x_m)/std(x_m), `rmse` RMS(x − x_m) in `unit`, that of the output, x being the model
    with the offset of its transducer, where it has one; `offset` is that without it. Earlier versions did not write
    these; of a run on which the model is unstable `rmse` is not known.
    """

    id: str
    use: str
    error: float
    offset: float
    error_with_mean: float | None = field(default=None, metadata=WHERE_KNOWN)
    rmse: float | None = field(default=None, metadata=WHERE_KNOWN)
    unit: str = field(default="", metadata=WHERE_KNOWN)

    @property
    def unstable(self) -> bool:
        """Whether the model is unstable on it."""
        return not self.error < UNSTABLE

    @property
    def words(self) -> ErrorOf:
        """Its error as a reader reads it."""
        with_mean = self.error_with_mean if self.error_with_mean is not None else math.hypot(self.error, self.offset)
        return ErrorOf(self.error, with_mean, (self.id,) if self.unstable else ())


@dataclass(frozen=True)
class Generation:
    """One generation of a search: errors are eq. (17), `population` holds one parameter vector a row."""

    index: int
    best: float
    mean: float
    population: tuple[tuple[float, ...], ...] = field(default=(), repr=False)
    errors: tuple[float, ...] = field(default=(), repr=False)


@dataclass(frozen=True)
class Structure:
    """A model that the channels allow, fitted where none was named: its error, the parameters searched, what of it.

    `values` are those of its parameters, SI; `probability` is that of the model among those that were compared, None
    where it was the only one.
    """

    machine: str
    error: Mapping[str, float | None] = field(default_factory=dict)
    parameters: int = 0
    why: str = ""
    values: Mapping[str, float] = field(default_factory=dict)
    probability: float | None = None


@dataclass(frozen=True)
class Window:
    """What a machine that integrates is fitted over, s, and the errors of a model that begins each where it was.

    The error is the root mean square of x_m − x, counted from the beginning of each window, over std(x_m). In
    `free_run` are the ends of the interval that has 95 % of the free run's errors, eq. (17), of parameters that lie
    within their standard errors: what a machine integrates hangs on them for as long as the run takes. With a `memory`
    (s), that of the filter that tells it, the speed of each window is begun anew, too. Where the `clock` is "sample"
    both are in samples, for the sample period is unknown.
    """

    horizon: float
    error: Mapping[str, float | None] = field(default_factory=dict)
    free_run: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    memory: float | None = None
    clock: str = field(default="", metadata=WHERE_KNOWN)

    @property
    def length(self) -> str:
        """The horizon in words: "0.85 s", of an unknown sample period "20 samples"."""
        return f"{self.horizon:.3g} {'samples' if self.clock == SAMPLE else 's'}"


@dataclass(frozen=True)
class Starts:
    """From how many points of the search the polish started, and how many ended at the error of the fit.

    `errors` has the error of the search's samples at each end, the least first, `values` the parameters there, SI;
    a start that ended nowhere, where no simulation follows, has neither.
    """

    tried: int
    agree: int
    errors: tuple[float, ...] = field(default=(), compare=False)
    values: Mapping[str, tuple[float, ...]] = field(default_factory=dict, compare=False)

    def __str__(self) -> str:
        return f"{self.agree} of {self.tried} starts agree"


@dataclass(frozen=True)
class FitResult(TabularResult):
    """A finished fit. Errors are eq. (17) averaged over the runs of a use, from the time domain; fractions, not %.

    `transducer_offset` has, by the channel, what its transducer reads above the model, where the runs say that its mean
    counts, or it is more than chance. x is the model with it, but for `offset`, which is that of the model alone.
    `error_with_mean` is RMS(x − x_m)/std(x_m), which sees the means that eq. (17) does not, `rmse` RMS(x − x_m) in
    `rmse_unit`, None where the outputs have several units; both are averaged as the error is. Earlier versions wrote
    the first as `anchored_error` alone, which is the same. `fit_percent` is 100 less the first in per cent: 100 (1 −
    ‖x − x_m‖/‖x_m − mean x_m‖) of the free simulation. `aic` is Akaike's criterion on the runs to fit, see
    :mod:`ident.fit.information`, None of a fit over windows. `window` is there where the fit was made over windows.
    `evolution` belongs to the parameters `searched`, in that order. `actuator` is what was stated of the machine;
    earlier versions did not keep it. The search of one that `ended_early` ran out of its time. Runs that are
    `left_out` were not fitted, and are in no mean over the runs to fit; they stand in `runs`. `preprocessing` has
    what became of each step of it, which earlier versions did not tell. `sheet` has the acceptance sheet of bench
    records by quantity, `conditions` those of the test that are known, SI. `matrix` holds the data, where the fit was
    made here.
    """

    model: str
    effects: tuple[str, ...]
    parameters: Mapping[str, Estimate]
    correlation: Mapping[str, Mapping[str, float]]
    determined: tuple[Combination, ...]
    undetermined: tuple[Undetermined, ...]
    error: Mapping[str, float | None]
    offset: Mapping[str, float | None]
    noise_floor: Mapping[str, float | None]
    runs: tuple[RunError, ...]
    method: str
    seed: int
    evaluations: int
    seconds: float
    version: str
    data_hash: str
    notes: tuple[str, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    anchored_error: Mapping[str, float | None] = field(default_factory=dict, metadata=WHERE_KNOWN)
    error_with_mean: Mapping[str, float | None] = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse: Mapping[str, float | None] = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse_unit: str = field(default="", metadata=WHERE_KNOWN)
    transducer_offset: Mapping[str, TransducerOffset] = field(default_factory=dict, metadata=WHERE_KNOWN)
    fit_percent: Mapping[str, float | None] = field(default_factory=dict, metadata=WHERE_KNOWN)
    aic: float | None = field(default=None, metadata=WHERE_KNOWN)
    window: Window | None = field(default=None, metadata=WHERE_KNOWN)
    starts: Starts | None = field(default=None, metadata=WHERE_KNOWN)
    structures: tuple[Structure, ...] = field(default=(), metadata=WHERE_KNOWN)
    ended_early: bool = field(default=False, metadata=WHERE_KNOWN)
    left_out: tuple[str, ...] = field(default=(), metadata=WHERE_KNOWN)
    searched: tuple[str, ...] = ()
    evolution: tuple[Generation, ...] = field(default=(), repr=False)
    actuator: Actuator | None = field(default=None, metadata=WHERE_KNOWN)
    preprocessing: tuple[StepOutcome, ...] = field(default=(), metadata=WHERE_KNOWN)
    sheet: Mapping[str, SheetQuantity] = field(default_factory=dict, metadata=WHERE_KNOWN)
    conditions: Mapping[str, float] = field(default_factory=dict, metadata=WHERE_KNOWN)
    matrix: Matrix | None = field(default=None, compare=False, repr=False, metadata=UNWRITTEN)

    def records(self) -> list[dict[str, Any]]:
        """A record a parameter, SI, for a data frame."""
        return [{"parameter": name, **written(estimate)} for name, estimate in self.parameters.items()]

    @property
    def headline(self) -> str:
        """Its first line: the model, and the error on each use of runs with what a reader must know of it."""
        return first_line(" + ".join((self.model, *self.effects)), {use: self.error_of(use) for use in USES})

    def error_of(self, use: str) -> ErrorOf:
        """The error on the runs of a use as a reader reads it: with the mean where it counts, and the unstable runs."""
        with_mean, size = (self.error_with_mean or self.anchored_error).get(use), self.rmse.get(use)
        meant = (run for run in self.runs if run.use == use and run.id not in self.left_out)
        unstable = tuple(run.id for run in meant if run.unstable)
        size_said = quantity(size, self.rmse_unit) if size else ""
        return ErrorOf(self.error.get(use), with_mean, unstable, size_said, large_offsets(self.transducer_offset))

    @property
    def values(self) -> dict[str, float]:
        """Parameter values by name, SI."""
        return {name: estimate.value for name, estimate in self.parameters.items()}

    def with_custom(self, definitions: Sequence[Mapping[str, Any]]) -> FitResult:
        """The same fit whose settings know these effects of the user; its model stays as it is."""
        settings = {"model": self.model, **self.settings, "custom": [dict(definition) for definition in definitions]}
        return replace(self, settings=settings)

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data (no NaN, no infinity), with the stages of a machine; what is not known is left out."""
        machine = description(self.model)
        return {**written(self), **({"machine": machine} if machine else {})}

    @classmethod
    def from_json(cls, data: object) -> FitResult:
        """The inverse of :meth:`to_json`, of what any version wrote. Raises Unusable where it is no fit."""
        try:
            found = read(cls, data)
            for name, value in found.values.items():
                if not math.isfinite(value):
                    raise Misfit("is not finite", f"parameters.{name}.value")
            return found
        except Misfit as error:
            raise Unusable(
                "bad-fit",
                f"not the JSON of a fit: {error}",
                "fit",
                "give the file that `servoident fit --json FILE` wrote",
            ) from None
