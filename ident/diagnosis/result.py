"""What a diagnosis found, in the contract's words: its JSON has these names in this order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ident.diagnosis.discovery.proposal import Proposal, from_json
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.verification import Standing
from ident.errors import Unusable
from ident.fit.result import TransducerOffset, large_offsets
from ident.matrix import Matrix, StepOutcome
from ident.plain import UNWRITTEN, WHERE_KNOWN, Misfit, read, written
from ident.residuals.budget import Budget
from ident.run import USES, Specimen
from ident.words.engineering import quantity
from ident.words.error import ErrorOf, first_line
from ident.words.shown import Shown, in_brief

Errors = Mapping[str, float | None]
"""Eq. (17) averaged over the runs of a kind: fit, held_out, verify; None where there are none."""
NO_ERRORS: Errors = {"fit": None, "held_out": None, "verify": None}
"""The errors of what was not refitted."""


class Judged:
    """What has errors by use: with the mean counted, `rmse` in `rmse_unit`, and where it is unstable, if known."""

    error: Errors
    error_with_mean: Errors
    rmse: Errors
    rmse_unit: str
    unstable: Mapping[str, tuple[str, ...]]
    transducer_offset: Mapping[str, TransducerOffset]

    def error_of(self, use: str) -> ErrorOf:
        """The error on the runs of a use as a reader reads it: a model that is unstable where it is fitted has none."""
        unstable = self.unstable.get("fit", ()) or self.unstable.get(use, ())
        size, offset = self.rmse.get(use), large_offsets(self.transducer_offset)
        size_said = quantity(size, self.rmse_unit) if size else ""
        return ErrorOf(self.error.get(use), self.error_with_mean.get(use), unstable, size_said, offset)


@dataclass(frozen=True)
class Baseline(Judged):
    """Errors and offset of the model that was given; by use also RMS(x − x_m)/std(x_m), and where it is unstable."""

    error: Errors = field(default_factory=dict)
    offset: float | None = None
    error_with_mean: Errors = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse: Errors = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse_unit: str = field(default="", metadata=WHERE_KNOWN)
    unstable: Mapping[str, tuple[str, ...]] = field(default_factory=dict, metadata=WHERE_KNOWN)
    transducer_offset: Mapping[str, TransducerOffset] = field(default_factory=dict, metadata=WHERE_KNOWN)


@dataclass(frozen=True, kw_only=True)
class Ranked(Judged):
    """An effect that the model lacks: what it was predicted to gain, what its refit gained, and why.

    `group` is the group of the verdict that it belongs to. Without `parameters` only the prediction was made.
    `unstable` has by use the runs on which the model is unstable with it.
    """

    effect: str
    error: Errors = field(default_factory=dict)
    offset: float | None = None
    predicted_error: float | None = None
    parameters: Mapping[str, ParameterEstimate] = field(default_factory=dict)
    group: tuple[str, ...] = ()
    probability: float | None = field(default=None, metadata=WHERE_KNOWN)
    evidence: Mapping[str, float | str | bool | None] = field(default_factory=dict)
    why: str = ""
    error_with_mean: Errors = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse: Errors = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse_unit: str = field(default="", metadata=WHERE_KNOWN)
    unstable: Mapping[str, tuple[str, ...]] = field(default_factory=dict, metadata=WHERE_KNOWN)
    transducer_offset: Mapping[str, TransducerOffset] = field(default_factory=dict, metadata=WHERE_KNOWN)

    @property
    def strength(self) -> ParameterEstimate | None:
        """What the refit found of its strength, the first of its parameters."""
        return next((found for name, found in self.parameters.items() if name.startswith(f"{self.effect}.")), None)


@dataclass(frozen=True, kw_only=True)
class Rung(Judged):
    """A step of the ladder: what was added (None: the fitted model), the errors after it, the parameters.

    `nats` tell by how much the step made the held-out data more likely, `unstable` has by use the runs on which the
    model is unstable after it.
    """

    added: str | None = None
    error: Errors = field(default_factory=dict)
    offset: float | None = None
    nats: float | None = None
    parameters: Mapping[str, ParameterEstimate] = field(default_factory=dict)
    error_with_mean: Errors = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse: Errors = field(default_factory=dict, metadata=WHERE_KNOWN)
    rmse_unit: str = field(default="", metadata=WHERE_KNOWN)
    unstable: Mapping[str, tuple[str, ...]] = field(default_factory=dict, metadata=WHERE_KNOWN)
    transducer_offset: Mapping[str, TransducerOffset] = field(default_factory=dict, metadata=WHERE_KNOWN)


@dataclass(frozen=True)
class LabelErrors:
    """Eq. (17) of a run as labelled, what the other runs let expect, and with the label mended."""

    as_labelled: float | None = None
    usual: float | None = None
    mended: float | None = None


@dataclass(frozen=True)
class Suspect:
    """A run, which of its labels is doubted, what stands there and what the data say, in `unit`; why, in a sentence."""

    run: str
    what: str = ""
    stated: float | None = None
    found: float | None = None
    unit: str = "1"
    error: LabelErrors = LabelErrors()
    evidence: str = ""


@dataclass(frozen=True)
class Explanation:
    """Another model of the machine that explains as well as what was found, with these effects, and its errors.

    `better`: beyond chance.
    """

    machine: str
    effects: tuple[str, ...] = ()
    error: Errors = field(default_factory=dict)
    better: bool = False


@dataclass(frozen=True)
class Verdict:
    """What to add, what the data cannot tell apart, whose label is doubted, and whether the residual is unexplained.

    `standing` says how sure the effects are, see :data:`ident.diagnosis.verification.Standing`; None where it was not
    asked. `contradicted_by` are those with which the error rises on runs to verify, `at_bound` those whose strength
    ended at a bound that the search set, `elsewhere` what other models explain as well. `stood_in` are effects of the
    ladder that are not named: beside terms that a search proposes the model does as well without them; `unconfirmed`
    are others of the ladder that are not named: runs to verify show nothing of them.
    `indistinguishable` are groups of which one is named, or two lags or delays that two others stand for as well.
    `probability` is that of the verdict, None where it was not asked; `probabilities` those of each effect that was
    refitted, of "nothing" and of something "unlisted", `group_probabilities` those of the groups.
    """

    effects: tuple[str, ...] = ()
    standing: Standing | None = None
    contradicted_by: tuple[str, ...] = ()
    indistinguishable: tuple[tuple[str, ...], ...] = ()
    suspects: tuple[Suspect, ...] = ()
    unexplained: bool = False
    text: str = ""
    at_bound: tuple[str, ...] = ()
    elsewhere: tuple[Explanation, ...] = ()
    stood_in: tuple[str, ...] = ()
    unconfirmed: tuple[str, ...] = field(default=(), metadata=WHERE_KNOWN)
    probability: float | None = field(default=None, metadata=WHERE_KNOWN)
    probabilities: Mapping[str, float] = field(default_factory=dict, metadata=WHERE_KNOWN)
    group_probabilities: tuple[float, ...] = field(default=(), metadata=WHERE_KNOWN)


@dataclass(frozen=True)
class EffectSet:
    """A set of effects that was refitted, and its gain over the fitted model, from which its probability follows."""

    effects: tuple[str, ...] = ()
    nats: float = 0.0


@dataclass(frozen=True, kw_only=True)
class NextRun:
    """The run that the lab should add, SI, as :class:`ident.design.experiment.Experiment` tells it.

    `conditions` are its words, `run` its entry in matrix.yaml.
    """

    specimen: Specimen | None = None
    gain: float | None = None
    amplitude: float
    unit: str = "m"
    signal: str
    frequency: float
    seconds: float
    sample_rate: float
    seed: int = 0
    separation: float | None = None
    so_far: float | None = None
    typical: float | None = None
    information: float = 0.0
    std_errors: Mapping[str, float] = field(default_factory=dict)
    text: str = ""
    conditions: str = ""
    run: Mapping[str, str | float | Mapping[str, str]] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Diagnosis(Shown):
    """Everything that was found about one fit of one matrix; `effects` are those that the fit had.

    `budget` is None where the model is unstable at every run, `next_experiment` where no run can be proposed. With a
    `horizon` (s) every error is that over windows of this length, as `window` of the fit says it (`memory`, s, too).
    Runs that are `left_out`, for their labels are doubted, are in no refit and no error. Not `complete`, it is what had
    been found when the search was stopped, or goes on; `not_looked_at` are the stages that are missing. `proposals`
    are terms that no list holds, of as many that were `looked_at`: they are no part of the verdict. `terms_left_out` of
    these no model can hold, or they are not finite. None is what an earlier version did not tell. `matrix` holds the
    data, where the diagnosis was made here. `effect_sets` are all sets of effects that were refitted, `most_nats` the
    gain of a model whose residual is the noise. `missing_inputs` are the stretches in which an input acted that
    is not recorded: run, from, to (s, or samples) and evidence; where a run to fit has one, no effect was looked for.
    `oscillation` has the runs that swing by themselves: run, frequency, growth (Hz and 1/s, or 1/sample), cause.
    `max_effects` is how many effects could be added.
    """

    model: str = "qian2014"
    effects: tuple[str, ...] = ()
    baseline: Baseline = Baseline()
    noise_floor: Errors = field(default_factory=dict)
    horizon: float | None = field(default=None, metadata=WHERE_KNOWN)
    memory: float | None = field(default=None, metadata=WHERE_KNOWN)
    left_out: tuple[str, ...] = field(default=(), metadata=WHERE_KNOWN)
    budget: Budget | None = None
    candidates: tuple[Ranked, ...]
    ladder: tuple[Rung, ...] = ()
    verdict: Verdict
    proposals: tuple[Proposal, ...] | None = None
    looked_at: int | None = field(default=None, metadata=WHERE_KNOWN)
    terms_left_out: int | None = field(default=None, metadata=WHERE_KNOWN)
    complete: bool = True
    not_looked_at: tuple[str, ...] = field(default=(), metadata=WHERE_KNOWN)
    next_experiment: NextRun | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    seed: int = 0
    seconds: float = 0.0
    version: str = ""
    data_hash: str = ""
    notes: tuple[str, ...] = ()
    effect_sets: tuple[EffectSet, ...] = field(default=(), metadata=WHERE_KNOWN)
    most_nats: float | None = field(default=None, metadata=WHERE_KNOWN)
    preprocessing: tuple[StepOutcome, ...] = field(default=(), metadata=WHERE_KNOWN)
    max_effects: int | None = field(default=None, metadata=WHERE_KNOWN)
    missing_inputs: tuple[Mapping[str, str | float], ...] = field(default=(), metadata=WHERE_KNOWN)
    oscillation: tuple[Mapping[str, str | float], ...] = field(default=(), metadata=WHERE_KNOWN)
    matrix: Matrix | None = field(default=None, compare=False, repr=False, metadata=UNWRITTEN)

    @property
    def confirmed_ladder(self) -> tuple[Rung, ...]:
        """The ladder without the last effects of which runs to verify show nothing: what is recommended."""
        return tuple(rung for rung in self.ladder if rung.added not in self.verdict.unconfirmed)

    @property
    def lacks_input(self) -> bool:
        """Whether no effect was looked for, since an input of the runs to fit is not recorded."""
        return bool(self.missing_inputs) and self.complete and not self.candidates

    @property
    def oscillates(self) -> bool:
        """Whether a part of the error remains, and the machine oscillates by itself: no effect can stand for that."""
        return bool(self.oscillation) and self.verdict.unexplained

    @property
    def headline(self) -> str:
        """Its first line: the model that was fitted, and its error on each use of runs."""
        of = {use: self.baseline.error_of(use) for use in USES}
        return first_line(" + ".join((self.model, *self.effects)), of)

    @property
    def summary(self) -> tuple[str, ...]:
        """The verdict in three lines: what is missing, what it does to the error, what to do next."""
        return in_brief(self)

    def records(self) -> list[dict[str, Any]]:
        """A record an effect that was ranked, best first, for a data frame."""
        return [
            {
                "effect": one.effect, "probability": one.probability, "predicted_error": one.predicted_error,
                **{use: one.error.get(use) for use in ("fit", "held_out", "verify")},
                "strength": strength.value if (strength := one.strength) else None, "why": one.why,
            }
            for one in self.candidates
        ]  # fmt: skip

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data (no NaN, no infinity); what an earlier version did not tell is left out."""
        data: dict[str, Any] = written(self) | {"proposals": [one.to_json() for one in self.proposals or ()]}
        if self.proposals is None:
            del data["proposals"]
        if not self.verdict.stood_in:
            del data["verdict"]["stood_in"]
        if self.verdict.standing is None:
            del data["verdict"]["standing"], data["verdict"]["contradicted_by"]
        return data | {name: data[name] or {} for name in ("budget", "next_experiment")}

    @classmethod
    def from_json(cls, data: object) -> Diagnosis:
        """The inverse of :meth:`to_json`, of what any version wrote. Raises Unusable where it is no diagnosis."""
        try:
            return read(cls, _in_own_names(data))
        except Misfit as error:
            raise bad_diagnosis(str(error)) from None


def _in_own_names(data: object) -> object:
    """The data with the proposals in the names of their fields."""
    listed = data.get("proposals") if isinstance(data, Mapping) else None
    if not isinstance(data, Mapping) or not isinstance(listed, list):
        return data
    return {**data, "proposals": [from_json(one) if isinstance(one, Mapping) else one for one in listed]}


def bad_diagnosis(why: str, where: str = "diagnosis") -> Unusable:
    """The refusal of what is no diagnosis, or of one whose models cannot be put together."""
    return Unusable("bad-diagnosis", f"not the JSON of a diagnosis: {why}", where,
                    "give the file that `servoident diagnose --json FILE` wrote")  # fmt: skip
