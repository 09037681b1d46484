"""What a diagnosis found, as the contract writes it."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from schemas.result import DefinitionView, ErrorBudget, Errors, Nothing, SettingsView, StepView, TransducerOffsetView


class RefittedView(BaseModel):
    """A parameter of a refit, SI; null where the data do not determine its standard error."""

    value: float
    unit: str
    std_error: float | None
    symbol: str


class BaselineView(BaseModel):
    """Errors and offset of the model that was given; `unstable` has by use the runs on which it is unstable.

    `error_with_mean` is RMS(x − x_m)/std(x_m), `rmse` RMS(x − x_m) in `rmse_unit`. Where they are not known these are
    absent.
    """

    error: Errors
    offset: float | None
    error_with_mean: Errors = Field(default_factory=dict)
    rmse: Errors = Field(default_factory=dict)
    rmse_unit: str = ""
    unstable: dict[str, list[str]] = Field(default_factory=dict)
    transducer_offset: dict[str, TransducerOffsetView] = Field(default_factory=dict)


class CandidateView(BaseModel):
    """An effect that the model lacks, best first by held-out error; `group` are those it cannot be told from.

    Without `parameters` there is only the prediction.
    """

    effect: str
    error: Errors
    offset: float | None
    predicted_error: float | None
    parameters: dict[str, RefittedView]
    group: list[str]
    probability: float | None = None
    evidence: dict[str, float | bool | str | None]
    why: str
    error_with_mean: Errors = Field(default_factory=dict)
    rmse: Errors = Field(default_factory=dict)
    rmse_unit: str = ""
    unstable: dict[str, list[str]] = Field(default_factory=dict)
    transducer_offset: dict[str, TransducerOffsetView] = Field(default_factory=dict)


class RungView(BaseModel):
    """A step of the ladder: what was added to the model before it, null for the fitted model itself.

    `nats` by which it made the held-out data more likely.
    """

    added: str | None
    error: Errors
    offset: float | None
    nats: float | None
    parameters: dict[str, RefittedView]
    error_with_mean: Errors = Field(default_factory=dict)
    rmse: Errors = Field(default_factory=dict)
    rmse_unit: str = ""
    unstable: dict[str, list[str]] = Field(default_factory=dict)
    transducer_offset: dict[str, TransducerOffsetView] = Field(default_factory=dict)


class LabelErrorsView(BaseModel):
    """Eq. (17) of a run as labelled, what the other runs let expect, and with the label mended."""

    as_labelled: float | None
    usual: float | None
    mended: float | None


class SuspectView(BaseModel):
    """A run, which of its labels is doubted, what stands there and what the data say, in `unit`."""

    run: str
    what: str
    stated: float | None
    found: float | None
    unit: str
    error: LabelErrorsView
    evidence: str


class ExplanationView(BaseModel):
    """Another model of the machine that explains as well as what was found, with these effects, and its errors.

    `better`: beyond chance.
    """

    machine: str
    effects: list[str]
    error: Errors
    better: bool = False


class NoiseTestView(BaseModel):
    """The numbers by which the residual on the estimation data counts as noise, or does not.

    Where a noise `floor` is known the `error` has to be below the `limit`; else the `correlation` of neighbouring
    residuals must not be above it. Where no command was repeated, and the error is at most twice the floor,
    it is also noise if the share that the inputs predict of it, out of fold, is no more than chance: `predicted` is at
    most `predicted_limit`.
    """

    error: float
    limit: float
    floor: float | None = None
    correlation: float | None = None
    predicted: float | None = None
    predicted_limit: float | None = None


class SeparationView(BaseModel):
    """The numbers by which the data distinguish two models, each with the limit up to which they do not.

    `gain` in nats; `apart` is the power of the difference of the outputs over the power of the output, which the noise
    hides up to `hidden`; `means_apart` is of the runs' means over the outputs' deviations; `difference` is of the
    errors' powers, and does not count where the noise hides the difference of the outputs.
    """

    gain: float
    gain_limit: float
    apart: float
    apart_limit: float
    hidden: float
    means_apart: float
    means_limit: float
    difference: float
    difference_limit: float | None


class AlternativeView(BaseModel):
    """An effect in the place of the added one, and the numbers by which the data distinguish the two, or not."""

    effect: str
    instead_of: str
    separation: SeparationView


class RiseView(BaseModel):
    """The error on runs to verify without an effect and with it, and by how many standard errors it rises.

    The last two are null where the model is unstable on runs to verify with the effect: on those in `unstable`.
    `instead_of` are effects that the model has which it rises from, and that are not in this one. Of a `free_run` the
    errors are those with its mean, of a machine that is fitted over windows, and there are no standard errors.
    Where the mean counts in the fit the errors `with_mean` are what rises, from the first to the second.
    """

    effect: str
    before: float
    after: float | None
    deviations: float | None
    unstable: list[str] = Field(default_factory=list)
    instead_of: list[str] = Field(default_factory=list)
    free_run: bool = False
    with_mean: list[float] = Field(default_factory=list)


class VerdictView(BaseModel):
    """What to add, what the data cannot tell apart, whose label is doubted, whether the residual is unexplained.

    `standing` is found where the error is at the noise floor, stand_in where it is above it or may be, contradicted
    where the error rises with an effect (`contradicted_by`, with numbers in `contradictions`) on runs to verify,
    nothing where no effect helps.
    `because` has the reasons of a stand-in, `alternatives` the numbers that decide a group, `competing` those of
    effects that are as probable as a named one and in no group with it. `noise_test` has the numbers by which the
    residual is unexplained, null where it was not asked. `at_bound` are effects whose strength ended at a bound
    that the search set, `elsewhere` what other models explain as well, and `stood_in` effects of the ladder that
    are not named, for beside proposed terms they are not needed. `unconfirmed` are those that are not named, for
    validation data show nothing of them, and `by_chance` those that are not named, for it is more probable than not
    that nothing is missing. `probability` is that of the verdict, null where it was not asked;
    `probabilities` those of each effect that was refitted, of "nothing" and of something "unlisted",
    `group_probabilities` those of the groups.
    """

    effects: list[str]
    standing: Literal["found", "stand_in", "contradicted", "nothing"] | None = None
    contradicted_by: list[str] = Field(default_factory=list)
    contradictions: list[RiseView] = Field(default_factory=list)
    indistinguishable: list[list[str]]
    suspects: list[SuspectView]
    unexplained: bool
    text: str
    at_bound: list[str] = Field(default_factory=list)
    elsewhere: list[ExplanationView] = Field(default_factory=list)
    stood_in: list[str] = Field(default_factory=list)
    unconfirmed: list[str] = Field(default_factory=list)
    by_chance: list[str] = Field(default_factory=list)
    probability: float | None = None
    probabilities: dict[str, float] = Field(default_factory=dict)
    group_probabilities: list[float] = Field(default_factory=list)
    noise_test: NoiseTestView | None = None
    because: list[Literal["untested", "unexplained", "at_bound", "dispensable_contradicted"]] = Field(
        default_factory=list
    )
    alternatives: list[AlternativeView] = Field(default_factory=list)
    competing: list[AlternativeView] = Field(default_factory=list)


class EffectSetView(BaseModel):
    """A set of effects that was refitted, and its gain over the fitted model, from which its probability follows."""

    effects: list[str]
    nats: float


class SpecimenView(BaseModel):
    """What the actuator moves, SI."""

    mass: float
    stiffness: float
    damping: float


class ProposalView(BaseModel):
    """The run that the lab should add, SI: `text` says why, `conditions` what, `run` is its entry in matrix.yaml.

    `separation` are the standard deviations of the noise by which the models in question will then differ, `so_far`
    those by the runs there are, `typical` those by another run; `std_errors` the share of each standard error that is
    expected to be left.
    """

    specimen: SpecimenView | None
    gain: float | None
    amplitude: float
    unit: str
    signal: str
    frequency: float
    seconds: float
    sample_rate: float
    seed: int
    separation: float | None
    so_far: float | None
    typical: float | None
    information: float
    std_errors: dict[str, float]
    text: str
    conditions: str
    run: dict[str, str | float | dict[str, str]]


class TermView(BaseModel):
    """A term that no list holds, proposed by search: where it acts, its equation, the effect of its own that it is.

    `class` are the forms that the data cannot tell from it; `nats` those of runs that neither search nor choice saw,
    `bar` what they had to exceed. `formula` is its equation in MathML. With `contradicted` the error rises on runs to
    verify. `instead_of` are effects that the catalogue had named and that are not in it.
    """

    model_config = ConfigDict(populate_by_name=True)

    place: list[str]
    equation: str
    effect: DefinitionView
    strength: float
    std_error: float | None = None
    unit: str
    parameters: dict[str, RefittedView] = Field(default_factory=dict)
    view: str = ""
    terms: int
    shapes: int
    error: Errors
    nats: float
    bar: float
    alike: list[str] = Field(alias="class")
    beside: list[str]
    meaning: str
    formula: str
    hypothesis: bool
    free_curve: bool = False
    contradicted: RiseView | None = None
    instead_of: list[str] = Field(default_factory=list)
    unstable: dict[str, list[str]] = Field(default_factory=dict)


class MissingInputView(BaseModel):
    """A stretch of a run, in s or samples, in which an input acted that is not recorded."""

    model_config = ConfigDict(populate_by_name=True)

    run: str
    start: float = Field(alias="from")
    end: float = Field(alias="to")
    evidence: str


class OscillationView(BaseModel):
    """A run that swings by itself: Hz and 1/s, or 1/sample."""

    run: str
    frequency: float
    growth: float
    cause: str
    evidence: str


class DiagnosisResult(BaseModel):
    """The contract's diagnose JSON.

    Not `complete`, the stages `not_looked_at` are missing: there was no time for them, or they failed. Of the terms
    that were `looked_at` so many are `terms_left_out`, for no model can hold them or they are not finite. `effect_sets`
    are all sets of effects that were refitted, `most_nats` the gain of a model whose residual is the noise.
    `missing_inputs` are where an input acted that is not recorded; on a run to fit, no effect was looked for.
    """

    model: str
    effects: list[str]
    baseline: BaselineView
    noise_floor: Errors
    horizon: float | None = None
    memory: float | None = None
    left_out: list[str] = Field(default_factory=list)
    budget: ErrorBudget | Nothing
    candidates: list[CandidateView]
    ladder: list[RungView]
    verdict: VerdictView
    proposals: list[TermView] = Field(default_factory=list)
    looked_at: int | None = None
    terms_left_out: int | None = None
    complete: bool = True
    not_looked_at: list[str] = Field(default_factory=list)
    next_experiment: ProposalView | Nothing
    settings: SettingsView
    seed: int
    seconds: float
    version: str
    data_hash: str
    notes: list[str]
    effect_sets: list[EffectSetView] = Field(default_factory=list)
    most_nats: float | None = None
    max_effects: int | None = None
    preprocessing: list[StepView] = Field(default_factory=list)
    missing_inputs: list[MissingInputView] = Field(default_factory=list)
    oscillation: list[OscillationView] = Field(default_factory=list)
