"""The result of a diagnosis, in the contract's words: its JSON has these names in this order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ident.diagnosis.discovery.proposal import Proposal, from_json
from ident.diagnosis.evidence.separation import Separation
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.verification import Contradiction, Reason, Standing
from ident.errors import Unusable
from ident.fit.result import TransducerOffset, large_offsets
from ident.matrix import Matrix, StepOutcome
from ident.plain import UNWRITTEN, WHERE_KNOWN, Misfit, read, written
from ident.residuals.budget import Budget
from ident.run import USES, Specimen
from ident.words.engineering import quantity
from ident.words.error import ErrorOf, first_line
from ident.words.result_tables import TabularResult, in_brief

Errors = Mapping[str, float | None]
"""Eq. (17) averaged over the runs of a kind: fit, held_out, verify; None where there are none."""
NO_ERRORS: Errors = {"fit": None, "held_out": None, "verify": None}
"""The errors of a model that was not refitted."""


class Judged:
    """A model with its errors by use: with the mean counted, `rmse` in `rmse_unit`, and its unstable runs, if known."""

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
    """A candidate effect: its predicted error, the errors of its refit, and the evidence for it.

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
        """The estimate of its strength in the refit, the first of its parameters."""
        return next((found for name, found in self.parameters.items() if name.startswith(f"{self.effect}.")), None)


@dataclass(frozen=True, kw_only=True)
class Rung(Judged):
    """A step of the ladder: the added effect (None: the fitted model), the errors after it, the parameters.

    `nats` is the log-likelihood gain of the step on the held-out data, `unstable` has by use the runs on which the
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
    """The error of eq. (17) of a run as labelled, its usual error by the other runs, and with the new label."""

    as_labelled: float | None = None
    usual: float | None = None
    mended: float | None = None


@dataclass(frozen=True)
class Suspect:
    """A run with a doubtful label: the label, its stated value and its value by the data, in `unit`, and the
    evidence."""

    run: str
    what: str = ""
    stated: float | None = None
    found: float | None = None
    unit: str = "1"
    error: LabelErrors = LabelErrors()
    evidence: str = ""


@dataclass(frozen=True)
class Explanation:
    """Another model of the machine that explains the data as well as the last model, with its effects and errors.

    `better`: it explains more, beyond chance.
    """

    machine: str
    effects: tuple[str, ...] = ()
    error: Errors = field(default_factory=dict)
    better: bool = False


@dataclass(frozen=True)
class NoiseTest:
    """The numbers by which the residual on the estimation data counts as noise, or does not.

    Where a noise `floor` is known the `error` has to be below the `limit`; else the `correlation` of the residual
    with itself, a few samples later, must not be above it. Where no command was repeated, and the error is at most
    twice the floor, it is also noise if the share that the inputs predict of it, out of fold, is no more than chance:
    `predicted` is at most `predicted_limit`.
    """

    error: float
    limit: float
    floor: float | None = None
    correlation: float | None = None
    predicted: float | None = field(default=None, metadata=WHERE_KNOWN)
    predicted_limit: float | None = field(default=None, metadata=WHERE_KNOWN)


@dataclass(frozen=True)
class Alternative:
    """An effect in the place of the effect that was added, and the numbers by which the data distinguish the two, or
    not.

    They are of its refit and of the model with the added effect; of an effect of a group, of the best model with an
    effect of the group, where the refit is indistinguishable from that one alone.
    """

    effect: str
    instead_of: str
    separation: Separation


@dataclass(frozen=True)
class Verdict:
    """The named effects, the groups that the data cannot tell apart, the suspects, and whether the residual is
    explained.

    `standing` says how sure the effects are, see :data:`ident.diagnosis.verification.Standing`; None where it is
    not known; `because` has the reasons of a stand-in. `contradicted_by` are effects with which the error rises on
    validation data, `contradictions` the numbers of each. `at_bound` are effects whose strength ended at a bound of
    the search, `elsewhere` explanations by other machines that are as good. Three kinds of effects of the ladder
    are not named: `stood_in` are redundant with proposed terms, validation data show nothing of `unconfirmed` ones,
    and for all of `by_chance` it is more probable than not that nothing is missing. `indistinguishable` are groups
    of effects one of which is named, or two lags or delays that two others replace as well; `alternatives` has the
    numbers that decide the groups of the first kind, `competing` those of effects that are as probable in the place
    of a named one and in no group with it. `probability` is the probability of the verdict, None where it is not
    known; `probabilities` has each effect that was refitted, "nothing" and something "unlisted",
    `group_probabilities` has one for each group. The residual is `unexplained` by the numbers of `noise_test`; they
    are None where there was no time for the test.
    """

    effects: tuple[str, ...] = ()
    standing: Standing | None = None
    contradicted_by: tuple[str, ...] = ()
    contradictions: tuple[Contradiction, ...] = field(default=(), metadata=WHERE_KNOWN)
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
    noise_test: NoiseTest | None = field(default=None, metadata=WHERE_KNOWN)
    because: tuple[Reason, ...] = field(default=(), metadata=WHERE_KNOWN)
    alternatives: tuple[Alternative, ...] = field(default=(), metadata=WHERE_KNOWN)
    competing: tuple[Alternative, ...] = field(default=(), metadata=WHERE_KNOWN)
    by_chance: tuple[str, ...] = field(default=(), metadata=WHERE_KNOWN)

    @property
    def unsupported(self) -> tuple[str, ...]:
        """The effects of the ladder that are not recommended: the unconfirmed ones, and those by chance."""
        return (*self.unconfirmed, *self.by_chance)


@dataclass(frozen=True)
class EffectSet:
    """A set of effects that was refitted, and its gain over the fitted model, from which its probability follows."""

    effects: tuple[str, ...] = ()
    nats: float = 0.0


@dataclass(frozen=True, kw_only=True)
class NextRun:
    """The run that the lab should add, SI, by :class:`ident.design.experiment.Experiment`.

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
class Diagnosis(TabularResult):
    """The whole diagnosis of one fit of one matrix; `effects` are the effects that the fit had.

    `budget` is None where the model is unstable at every run, `next_experiment` where no run can be proposed. With a
    `horizon` (s) every error is over windows of this length, as in the fit's `window` (`memory`, s, too). Runs that are
    `left_out` because of a doubtful label are in no refit and no error. `complete` is false where the search was
    stopped, or goes on; `not_looked_at` are the stages that are missing. `proposals` are unlisted terms, the best of
    those that were `looked_at`: they are no part of the verdict. `terms_left_out` counts the terms that no model can
    have, or that are not finite. None means that an earlier version did not write it. `matrix` has the data, where the
    diagnosis was made in this process. `effect_sets` are all sets of effects that were refitted, `most_nats` the gain
    of a model whose residual is the noise. `missing_inputs` are the stretches in which an input acted that is not
    recorded: run, from, to (s, or samples) and evidence; where estimation data have one, no effect was looked for.
    `oscillation` has the runs that swing by themselves: run, frequency, growth (Hz and 1/s, or 1/sample), cause.
    `max_effects` is the largest number of effects that could be added.
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
        """The recommended ladder: without effects of which validation data show nothing, or that are by chance."""
        return tuple(rung for rung in self.ladder if rung.added not in self.verdict.unsupported)

    @property
    def lacks_input(self) -> bool:
        """Whether no effect was looked for, because an input of the estimation data is not recorded."""
        return bool(self.missing_inputs) and self.complete and not self.candidates

    @property
    def oscillates(self) -> bool:
        """Whether the residual is unexplained, and the machine oscillates by itself: no effect explains that."""
        return bool(self.oscillation) and self.verdict.unexplained

    @property
    def headline(self) -> str:
        """The first line: the fitted model, and its error on each use of runs."""
        of = {use: self.baseline.error_of(use) for use in USES}
        return first_line(" + ".join((self.model, *self.effects)), of)

    @property
    def summary(self) -> tuple[str, ...]:
        """The verdict in three lines: the missing effects, the change of the error, the next step."""
        return in_brief(self)

    def records(self) -> list[dict[str, Any]]:
        """One record for each ranked effect, best first, for a data frame."""
        return [
            {
                "effect": one.effect,
                "probability": one.probability,
                "predicted_error": one.predicted_error,
                **{use: one.error.get(use) for use in ("fit", "held_out", "verify")},
                "strength": strength.value if (strength := one.strength) else None,
                "why": one.why,
            }
            for one in self.candidates
        ]

    def to_json(self) -> dict[str, Any]:
        """The diagnosis as plain JSON data (no NaN, no infinity), without fields that an earlier version did not
        write."""
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
        """The inverse of :meth:`to_json`, for the JSON of any version. Raises Unusable where it is no diagnosis."""
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
    """The refusal of data that are no diagnosis, or of a diagnosis whose models cannot be put together."""
    return Unusable(
        "bad-diagnosis",
        f"not the JSON of a diagnosis: {why}",
        where,
        "give the file that `servoident diagnose --json FILE` wrote",
    )
