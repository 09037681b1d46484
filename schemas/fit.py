"""Fits and the jobs that make them."""

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, StrictBool

from schemas.result import ErrorBudget, Errors, EstimateView, FitResultView, SettingsView

Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]


class Chosen(BaseModel):
    """What may be chosen about a fit; `bounds` and `set` may carry units ("1 ms"), plain numbers are SI.

    Without a `model` that which fits is taken, of those that the channels allow; with effects, bounds or values the
    likeliest. The search ends with the generation that goes beyond `budget`, s. `custom` adds effects of one's own:
    definitions as `POST /custom-effects` takes them, or names of those at `/own-effects`, which `effects` takes, too.
    `preprocessing` switches steps off by name: `{"stroke_centre": false}`.
    """

    model_config = ConfigDict(extra="forbid")
    model: str | None = None
    effects: list[str] = Field(default_factory=list, max_length=50)
    custom: list[dict[str, Any] | str] = Field(default_factory=list, max_length=10)
    method: str = "ga"
    seed: int = Field(default=0, ge=0, lt=2**31)
    bounds: dict[str, tuple[Finite | str, Finite | str]] = Field(default_factory=dict)
    set: dict[str, Finite | str] = Field(default_factory=dict)
    options: dict[str, Finite] = Field(default_factory=dict)
    load: str = "none"
    budget: float | None = Field(default=None, gt=0)
    preprocessing: dict[str, StrictBool] = Field(default_factory=dict, max_length=50)


class StartRequest(BaseModel):
    """The stored `fit` or `diagnosis` where a fit begins; of a diagnosis the model that it recommends.

    `effects` take another model that the diagnosis refitted, with just these added, and `terms` the first of the terms
    that it proposes. With `search` the whole space is searched too, and the better end is the fit.
    """

    model_config = ConfigDict(extra="forbid")
    fit: str | None = None
    diagnosis: str | None = None
    effects: list[str] = Field(default_factory=list, max_length=50)
    terms: int | None = Field(default=None, ge=0)
    search: bool = False


class FitRequest(Chosen):
    """A fit to be queued; one with a `start` begins where an earlier result ended, and chooses nothing else."""

    matrix: str
    parent: str | None = None
    start: StartRequest | None = None


class EffectsRequest(BaseModel):
    """Effects to add to a fit: one by `effect`, or some by `effects`, or what `custom` defines.

    A definition whose name is not among `effects` is added all the same; names are those of `/effects`, of
    `/own-effects`, and of what the newest diagnosis of the fit ranked or proposes: a proposed term is added with those
    before it and the effects that they stand on. Where the `diagnosis` of the fit refitted the model with just these,
    the new fit begins there.
    """

    model_config = ConfigDict(extra="forbid")
    effect: str | None = None
    effects: list[str] = Field(default_factory=list, max_length=50)
    custom: list[dict[str, Any] | str] = Field(default_factory=list, max_length=10)
    diagnosis: str | None = None


class ExpectedView(BaseModel):
    """An effect, and the error (eq. 17) that a fit has with it, or is expected to have before any refit."""

    effect: str
    error: float


class ProgressView(BaseModel):
    """Where a job is: `done` of `total` steps of `stage`; `error` is the best eq. (17) so far.

    `expected` is what a diagnosis sees at once: the effects that promise most, first, while it confirms them; `added`
    are those that it has added so far, each with the held-out error since; `verdict` is what the catalogue gave, once
    it is through.
    """

    stage: str = ""
    done: int = 0
    total: int = 0
    error: float | None = None
    expected: list[ExpectedView] = Field(default_factory=list)
    added: list[ExpectedView] = Field(default_factory=list)
    verdict: str = ""


class TimeLeftView(BaseModel):
    """How many seconds a job has left, as `jobs` that have ended tell; as likely as not between `lower` and `upper`."""

    seconds: float
    lower: float
    upper: float
    jobs: int


class JobSettings(SettingsView):
    """What a job was asked for: the fit, and of a diagnosis what to add at most, its time, and a search made anew.

    Of a hybrid simulation the names of its case, controller and ground motion, of a profile its parameter, of a test
    plan its program.
    """

    max_effects: int | None = None
    time: float | None = None
    reseed: int | None = None
    case: str | None = None
    controller: str | None = None
    ground: str | None = None
    parameter: str | None = None
    program: str | None = None


class JobProblem(BaseModel):
    """Why a job failed; `detail` says what is wrong, `where` where, `remedy` what to do."""

    code: str = ""
    detail: str = ""
    where: str = ""
    remedy: str = ""


class JobView(BaseModel):
    """A queued, running or ended job; `parent` is the fit that it starts from, `problem` says why it failed.

    `fit`, `diagnosis`, `hybrid_simulation` and `plan` are the ids of what it made. `matrix` and `serial` are "" where
    a job needs no runs and is about no actuator: a plan without a fit. `elapsed` are the seconds since its work began,
    until now or until it ended; `time_left` is null where it does not run, and before ended jobs of its kind tell it.
    """

    id: str
    kind: str
    state: str
    matrix: str
    serial: str
    settings: JobSettings
    progress: ProgressView
    parent: str | None
    fit: str | None
    diagnosis: str | None
    hybrid_simulation: str | None = None
    plan: str | None = None
    problem: JobProblem | None
    created_at: str
    began_at: str | None = None
    ended_at: str | None
    elapsed: float | None = None
    time_left: TimeLeftView | None = None


class JobPage(BaseModel):
    """A page of jobs, newest first."""

    items: list[JobView]
    next: str | None = None


class FitView(BaseModel):
    """A stored fit: the contract's fit JSON and where it belongs.

    `objections` say why an approval needs a reason: an error far above the noise floor, verify runs that
    contradict the fit.
    """

    id: str
    matrix: str
    serial: str
    parent: str | None
    created_at: str
    approved_at: str | None
    current: bool
    objections: list[str] = Field(default_factory=list)
    result: FitResultView


class LadderRung(BaseModel):
    """A fit on the way to another: the effects that it added to its parent, and what they made of the error.

    `unstable` has by use the runs on which the model is unstable.
    """

    fit: str
    parent: str | None
    matrix: str
    added: list[str]
    error: Errors
    error_with_mean: Errors = Field(default_factory=dict)
    unstable: dict[str, list[str]] = Field(default_factory=dict)
    parameters: dict[str, EstimateView]
    seed: int
    version: str
    data_hash: str
    created_at: str
    approved_at: str | None
    current: bool


class LadderView(BaseModel):
    """The chain of parents of a fit, the first one first. Every fit on it is still there and can be approved."""

    fit: str
    rungs: list[LadderRung]


class ComparedRun(BaseModel):
    """Eq. (17) and offset of a run; root mean square and mean size of its residual in `unit`, and the first over std.

    Where the model is unstable on the run, root mean square and mean size are null.
    """

    id: str
    use: str
    error: float
    offset: float
    error_with_mean: float | None = None
    fit_percent: float | None = None
    rmse: float | None
    mae: float | None
    unit: str


class ErrorSize(BaseModel):
    """Root mean square and mean size of the residual, in `unit`, and as they are printed."""

    rmse: float
    mae: float
    unit: str
    rmse_in_print: str
    mae_in_print: str


class WhitenessView(BaseModel):
    """The test of Ljung and Box at 99 % on some runs: how many there are, how many pass, and the verdict on all."""

    runs: int
    white: int
    passed: bool


class ErrorSizesView(BaseModel):
    """That of each run, and the means over the runs of a use that have one unit; is the residual of a use white."""

    uses: dict[str, ErrorSize]
    runs: dict[str, ErrorSize]
    whiteness: dict[str, WhitenessView] = Field(default_factory=dict)


class ProfileRequest(BaseModel):
    """The parameter whose profile is asked for."""

    model_config = ConfigDict(extra="forbid")

    parameter: str = Field(min_length=1, max_length=200)


class FitColumn(BaseModel):
    """One of several fits, under the letter that the runs name it by, and the serial number of its actuator.

    `ratio` is its error over that of the first fit, `points` the difference in per cent of the signal, each by use.
    """

    fit: str
    name: str
    serial: str = ""
    model: str
    effects: list[str]
    error: Errors
    parameters: dict[str, EstimateView]
    ratio: Errors = Field(default_factory=dict)
    points: Errors = Field(default_factory=dict)


class RunBeside(BaseModel):
    """A run, and its eq. (17) in each of the fits by their letters; null where a fit has not seen it.

    `ratio` is the error over that in the first fit, `points` the difference in per cent of the signal.
    """

    id: str
    use: str
    error: dict[str, float | None]
    ratio: dict[str, float | None] = Field(default_factory=dict)
    points: dict[str, float | None] = Field(default_factory=dict)


class SideBySideView(BaseModel):
    """Several fits side by side, in the order in which they were asked for."""

    fits: list[FitColumn]
    runs: list[RunBeside]


class GroupError(BaseModel):
    """Eq. (17) on runs, or on parts of every run, with something in common; `value` is the condition in SI."""

    label: str
    value: float | None
    runs: int
    error: float
    mean: float


class BandedRun(BaseModel):
    """The error of a run in each band, whose squares add up to that of its error; null where no frequency lies."""

    id: str
    use: str
    error: float
    bands: list[float | None]


class Bands(BaseModel):
    """Edges in Hz, one more than bands."""

    edges: list[float]
    runs: list[BandedRun]


class ResidualCurve(BaseModel):
    """What is missing at a place of the chain against a signal, with its 95 % band; `explained` of the power."""

    name: str
    missing: str
    against: str
    shows: str
    x_unit: str
    y_unit: str
    x: list[float]
    y: list[float]
    lower: list[float]
    upper: list[float]
    explained: float


class TrendPoint(BaseModel):
    """A parameter refitted to the runs of one condition."""

    condition: float
    runs: int
    value: float
    std_error: float | None


class ParameterTrend(BaseModel):
    """A parameter against a condition; `p` by permutation, `clear` beyond chance among all tests."""

    parameter: str
    unit: str
    condition: str
    points: list[TrendPoint]
    p: float
    clear: bool


class ComparisonView(BaseModel):
    """A fit against every run of its matrix, recomputed: where it fails, and what its error is made of."""

    fit: str
    error: dict[str, float | None]
    offset: dict[str, float | None]
    error_with_mean: dict[str, float | None] = Field(default_factory=dict)
    fit_percent: dict[str, float | None] = Field(default_factory=dict)
    rmse: dict[str, float | None] = Field(default_factory=dict)
    whiteness: dict[str, WhitenessView] = Field(default_factory=dict)
    runs: list[ComparedRun]
    bands: Bands
    groups: dict[str, list[GroupError]]
    curves: list[ResidualCurve]
    trends: list[ParameterTrend]
    budget: ErrorBudget | None
