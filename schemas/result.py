"""What a fit and a diagnosis hold, in the contract's words: one JSON over HTTP and in the files of the commands."""

from typing import Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Field

Errors: TypeAlias = dict[str, float | None]
"""Eq. (17), or the offset, by use: fit, held_out, verify; null where there are no such runs."""
Number: TypeAlias = int | float
"""As its user wrote it: 20 stays 20."""
Entry: TypeAlias = str | bool | int | float | None
Entries: TypeAlias = dict[str, Entry]


class Nothing(BaseModel):
    """An object without members: there is none."""

    model_config = ConfigDict(extra="forbid")


class DefinitionView(BaseModel):
    """An effect of one's own as its user wrote it; what was not written is absent."""

    name: str
    place: Entry = None
    equation: Entry | list[Entry] = None
    strength: Entries = Field(default_factory=dict)
    shape: Entry | list[Entry | Entries] | dict[str, Entry | Entries] = None
    curve: dict[str, Entry | list[Entry]] = Field(default_factory=dict)
    state: Entries = Field(default_factory=dict)
    meaning: Entry = None
    looks: Entry = None
    source: Entry = None


class StartView(BaseModel):
    """Where a fit begins: the end of a `fit`, or of a refit of a `diagnosis`, `values` SI by parameter.

    `horizon` and `memory` (s) are those of its windows, `left_out` the runs that it was not fitted to.
    """

    of: Literal["fit", "diagnosis"]
    values: dict[str, float]
    horizon: float | None = None
    memory: float | None = None
    left_out: list[str] = Field(default_factory=list)
    error: float | None = None
    data_hash: str = ""
    search: bool = False


class SettingsView(BaseModel):
    """What was chosen about a fit, SI; an earlier version may not have known all of it, which is then absent."""

    model: str = "qian2014"
    effects: list[str] = Field(default_factory=list)
    method: str = "ga"
    bounds: dict[str, tuple[Number, Number]] = Field(default_factory=dict)
    fixed: dict[str, Number] = Field(default_factory=dict)
    load: str = "none"
    seed: int = 0
    options: dict[str, Number] = Field(default_factory=dict)
    custom: list[DefinitionView] = Field(default_factory=list)
    budget: Number | None = None
    preprocessing: dict[str, bool] = Field(default_factory=dict)
    start: StartView | None = None


class ErrorBudget(BaseModel):
    """Parts of eq. (17), combining quadratically; null noise cannot be told and is within nonlinear."""

    noise: float | None
    linear: float
    nonlinear: float
    bounds: dict[str, tuple[float, float]]
    notes: list[str]


class EstimateView(BaseModel):
    """One parameter: value, standard error (null where the data do not determine it), bounds, all in `unit`."""

    value: float
    unit: str
    std_error: float | None
    lower: float
    upper: float
    at_bound: bool
    symbol: str = ""
    meaning: str = ""
    fixed: bool = False


class CombinationView(BaseModel):
    """A product of powers of parameters that the data determine although its factors may not be."""

    expression: str
    value: float
    unit: str
    std_error: float


class UndeterminedView(BaseModel):
    """A parameter that the data do not determine, and why."""

    name: str
    reason: str


class TransducerOffsetView(BaseModel):
    """What the transducer of a channel reads above the model, one number for all of its runs, in `unit`."""

    value: float
    unit: str
    std_error: float
    large: bool = False


class RunErrorView(BaseModel):
    """Eq. (17) of one run, and its offset; RMS(x − x_m) over std(x_m), and in `unit`. Unknown is absent."""

    id: str
    use: str
    error: float
    offset: float
    error_with_mean: float | None = None
    rmse: float | None = None
    unit: str = ""


class GenerationView(BaseModel):
    """One generation of a search: errors are eq. (17), `population` holds one parameter vector a row."""

    index: int
    best: float
    mean: float
    population: list[list[float]] = Field(default_factory=list)
    errors: list[float] = Field(default_factory=list)


class StructureView(BaseModel):
    """A model that the channels allow, fitted where none was named; `parameters` is how many were searched.

    `values` are those of its parameters, SI; `probability` is that of the model among those that were compared.
    """

    machine: str
    error: Errors
    parameters: int
    why: str
    values: dict[str, float] = Field(default_factory=dict)
    probability: float | None = None


class MachineView(BaseModel):
    """What a machine that was put together from stages has at each place, what is recorded, and the gains known."""

    controller: str = "none"
    of: str = "displacement"
    valve: str = "none"
    spool: str = "rigid"
    flow: str = "none"
    pressure: str = "none"
    load: str = "none"
    sensor: list[str]
    gains: dict[str, float] = Field(default_factory=dict)


class StartsView(BaseModel):
    """From how many points the polish started, and how many ended at the error of the fit; error and values of each."""

    tried: int
    agree: int
    errors: list[float] = Field(default_factory=list)
    values: dict[str, list[float]] = Field(default_factory=dict)


class WindowView(BaseModel):
    """What a machine that integrates is fitted over, s, and the errors of a model that begins each where it was.

    `free_run`: by use, the ends of the interval that has 95 % of the free run's errors of parameters within their
    standard errors. `memory`: of the filter (s) that tells the speed with which each begins, where that is begun anew.
    With the `clock` "sample" both are in samples, for the period is unknown.
    """

    horizon: float
    error: Errors
    free_run: dict[str, list[float]] = Field(default_factory=dict)
    memory: float | None = None
    clock: str = ""


class RigStated(BaseModel):
    """The limits of a rig, SI: stroke from end to end, what the piston, the valve and the supply may reach."""

    stroke: float | None = None
    speed: float | None = None
    acceleration: float | None = None
    force: float | None = None
    flow: float | None = None
    supply_pressure: float | None = None


class ActuatorStated(BaseModel):
    """What was stated of the machine that was fitted, SI; null is not stated."""

    serial: str
    name: str = ""
    batch: str = ""
    piston_area: float | None = None
    stroke: float | None = None
    supply_pressure: float | None = None
    servo_valve: str = ""
    notes: str = ""
    volume: float | None = None
    rig: RigStated | None = None


class StepView(BaseModel):
    """A step of preprocessing: whether it was applied, not needed or switched off, and what was told of it."""

    step: str
    state: Literal["applied", "not_needed", "off"]
    told: str = ""


class SheetQuantityView(BaseModel):
    """A quantity of the acceptance sheet of bench records, SI, with the limits that its data set states."""

    value: float
    std_error: float
    unit: str
    lower: float | None = None
    upper: float | None = None


class FitResultView(BaseModel):
    """The contract's fit JSON; `evolution` belongs to the parameters `searched`, in that order.

    `error_with_mean` is RMS(x − x_m)/std(x_m), `rmse` RMS(x − x_m) in `rmse_unit`, averaged as the error is; x is the
    model with its `transducer_offset`, by channel. `fit_percent` is 100 (1 − RMS(x − x_m)/std(x_m)) of the free
    simulation; `aic` compares fits to the same samples.

    What an earlier version did not know is absent.
    """

    model: str
    effects: list[str]
    parameters: dict[str, EstimateView]
    correlation: dict[str, dict[str, float]]
    determined: list[CombinationView]
    undetermined: list[UndeterminedView]
    error: Errors
    offset: Errors
    noise_floor: Errors
    runs: list[RunErrorView]
    method: str
    seed: int
    evaluations: int
    seconds: float
    version: str
    data_hash: str
    notes: list[str] = Field(default_factory=list)
    settings: SettingsView = Field(default_factory=SettingsView)
    searched: list[str] = Field(default_factory=list)
    evolution: list[GenerationView] = Field(default_factory=list)
    anchored_error: Errors = Field(default_factory=dict)
    error_with_mean: Errors = Field(default_factory=dict)
    rmse: Errors = Field(default_factory=dict)
    rmse_unit: str = ""
    transducer_offset: dict[str, TransducerOffsetView] = Field(default_factory=dict)
    fit_percent: Errors = Field(default_factory=dict)
    aic: float | None = None
    window: WindowView | None = None
    starts: StartsView | None = None
    machine: MachineView | None = None
    structures: list[StructureView] = Field(default_factory=list)
    actuator: ActuatorStated | None = None
    ended_early: bool = False
    left_out: list[str] = Field(default_factory=list)
    preprocessing: list[StepView] = Field(default_factory=list)
    sheet: dict[str, SheetQuantityView] = Field(default_factory=dict)
    conditions: dict[str, float] = Field(default_factory=dict)
