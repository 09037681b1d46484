"""The rule by which an effect is added: the questions that are asked of the evidence for it.

An effect is added where the answer to each question is yes. The selection, the trials with companions, the reason that
a reader gets, the figures of the answer and `docs/diagnosis.md` all follow from this file. To change the rule, change a
question here and its number in :mod:`ident.diagnosis.evidence.criteria`, whose reason gives the measurement.

* **Is it real?** The gain G = ν/2 ln(V before / V after) is in nats (`evidence.nats`). V is the energy of the residual
  over bands, each over the energy of the disturbance there, which is the same for both models. So a drift that
  neither explains decides nothing. ν counts distinct degrees of freedom, never samples: two for each harmonic of a
  periodic test, at most 30 for a band, at most 100 in all. Five and a hundred periods of a sine say the same. The gain
  has to pass a bar: the 95 % point of the largest gain of all effects on 200 residuals with the same spectrum and
  random phases. The bar is the correction for the number of models compared. Half of the largest possible gain
  (`evidence.most_nats`) passes, too. Of four runs or more that is asked without the run that gains most: an effect that
  one run alone asks for is a warning about that run.
* **Does it matter?** It explains more than a hundredth of the power above the noise (`evidence.share`). It does so
  beyond the error of the share, of the difference, or of the share of the loss, in which each band counts by the
  disturbance there (`evidence.weighted_share`): a drift scatters the first two. The error comes from the scatter
  between runs, or between blocks of ten correlation times; those of a short record are shorter, but never below four.
* **Does it hold everywhere?** No condition of the tests and neither half of the records may lose beyond its error and
  by a hundredth of the explainable power (`evidence.carries_over`).
* **Does it run freely?** This is asked of a machine that is fitted over windows. A window begins where the record was
  measured, and forgives errors that add up slowly. So the power of the free run, with its mean, may not rise with the
  effect by more than chance. Chance is the sum of disturbances like those at the ends of the windows, and of the
  standard errors of the parameters (`ident/diagnosis/evidence/free_run.py`). If the effect is right that is exceeded in
  one case of twenty at most. An effect that only the free run speaks against is tried with each other effect: friction
  and a constant force may run freely together, and neither alone.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from math import sqrt
from typing import Any

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.evidence import SPANS, Evidence
from ident.diagnosis.evidence.free_run import drives_away
from ident.words.message import Message
from ident.words.percent import PER_CENT


@dataclass(frozen=True)
class Question:
    """A question of the rule: `yes` answers it by the evidence.

    `refusal` is the reason for a reader where the answer is no, a text like those of :mod:`ident.words.messages`, and
    `numbers` works out the values that the text names. An effect that improves the model on the whole and fails a
    question that is `of_a_part` is tried with each other effect: another may be missing there. `shows` is whether the
    reason also says how the effect would show; `figure` is the name of the answer among the figures of the evidence,
    where it has one.
    """

    yes: Callable[[Evidence, EvidenceCriteria], bool]
    refusal: str
    numbers: Callable[[Evidence], Mapping[str, Any]] = lambda _: {}
    of_a_part: bool = False
    shows: bool = False
    figure: str = ""

    def reason(self, evidence: Evidence) -> Message:
        """The reason why an effect with this evidence is not added."""
        return Message(f"why.{self.yes.__name__}", self.numbers(evidence), self.refusal)


def matters(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model explains a share of the explainable power, or of the runs' means, that matters.

    It does so beyond the error of the share, of the difference, or of the share of the loss, in which each band counts
    by the disturbance there. The first is small where every block gains the same share, the second where some blocks,
    or some runs, gain more of it than others, the third where a drift scatters both.
    """
    of_levels = evidence.level > criteria.level and evidence.level_share.above(criteria.share, criteria)
    of_difference = evidence.difference.above(criteria.share * evidence.explainable, criteria)
    weighted = evidence.share.mean > criteria.share and evidence.weighted_share.above(criteria.share, criteria)
    return of_levels or of_difference or weighted or evidence.share.above(criteria.share, criteria)


def _shares(evidence: Evidence) -> dict[str, float]:
    share, error = evidence.share.mean, evidence.share.bound(EVIDENCE_CRITERIA)
    return {"share": PER_CENT * share, "error": PER_CENT * error, "least": PER_CENT * EVIDENCE_CRITERIA.share}


def generalises(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether no condition and no span loses beyond its error, and by a share of the explainable power that matters."""
    return losing_part(evidence, criteria) is None


def losing_part(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> Hashable | None:
    """The first condition or span that loses beyond its error by a share that matters; None where none does."""
    least, each = -criteria.share * evidence.explainable, criteria.of_several(len(evidence.parts))
    return next((name for name, part in evidence.parts.items() if part.below(least, each)), None)


def _where(evidence: Evidence) -> dict[str, str]:
    part = losing_part(evidence)
    return {"where": f"on the {part} of the records" if part in SPANS else "under one condition of the tests"}


def runs_freely(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model, better over windows, does not drive the free run away beyond its uncertainty."""
    return evidence.free_runs is None or not drives_away(*evidence.free_runs, criteria)


def _errors(evidence: Evidence) -> dict[str, float]:
    assert evidence.free_runs is not None
    before, after = evidence.free_runs
    return {"before": sqrt(before.power), "after": sqrt(after.power), "expected": sqrt(after.expected)}


QUESTIONS = (
    Question(
        matters,
        "The effect explains {share:.2g} ± {error:.2g} % of the error above the noise floor. At least {least:.2g} % is "
        "required, beyond the standard error.",
        _shares,
        shows=True,
    ),
    Question(
        generalises,
        "The error rises {where}. An effect that only part of the data support is not added.",
        _where,
        of_a_part=True,
        figure="carries_over",
    ),
    Question(
        runs_freely,
        "The windows begin where the record was measured. The error of the free run rises from {before:error} to "
        "{after:error}, where disturbances and errors of the parameters would add up to {expected:error}. An effect "
        "that drives the free run away is not added.",
        _errors,
        of_a_part=True,
    ),
)  # the last question
"""The questions of the rule, in the order of their reasons for a reader; `is_real` is asked in addition."""


def is_real(evidence: Evidence, bar: Callable[[], float], criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model gains more than chance.

    The gain has to be worth a parameter, and to pass the `bar` of :func:`ident.diagnosis.evidence.chance.bar`, which is
    worked out only where it decides. Where a residual has few harmonics some candidate often matches a random phase,
    and the bar comes near to the largest possible gain: half of the largest possible gain passes, too.
    """
    gain = min(evidence.gain, evidence.without)
    return may_be_real(evidence, criteria) and (gain > criteria.reaches * evidence.most or gain > bar())


def may_be_real(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the gain is worth a parameter, without which no bar is asked for, and no further simulation."""
    return min(evidence.gain, evidence.without) > criteria.least_gain


_IS_REAL = Question(may_be_real, "That is no more than the best of all effects gains by chance.", shows=True)
"""The reason for an effect that passes all others: the sentences do not know the bar."""


def improves_on_the_whole(
    evidence: Evidence, bar: Callable[[], float], criteria: EvidenceCriteria = EVIDENCE_CRITERIA
) -> bool:
    """Whether the second model gains more than chance, and passes each question that is not of a part of the data."""
    asked = (question for question in QUESTIONS if not question.of_a_part)
    on_the_whole = may_be_real(evidence, criteria) and all(question.yes(evidence, criteria) for question in asked)
    return on_the_whole and is_real(evidence, bar, criteria)


def worth_adding(
    evidence: Evidence, bar: Callable[[], float] = lambda: float("inf"), criteria: EvidenceCriteria = EVIDENCE_CRITERIA
) -> bool:
    """The rule by which an effect is added: the second model gains more than chance, and passes each question.

    The selection asks it of fitted models through :mod:`ident.diagnosis.model_comparison`. Without a `bar` the second
    model has to gain half of all that can be gained.
    """
    passes = may_be_real(evidence, criteria) and all(question.yes(evidence, criteria) for question in QUESTIONS)
    return passes and is_real(evidence, bar, criteria)  # last: a bar takes longer than all other answers together


def refusing(evidence: Evidence, is_worth_adding: bool) -> Question | None:
    """The first question that an effect fails, by the rule's answer on it; None where it is worth adding."""
    if is_worth_adding:
        return None
    return next((question for question in QUESTIONS if not question.yes(evidence, EVIDENCE_CRITERIA)), _IS_REAL)
