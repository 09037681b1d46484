"""The rule by which an effect is added: the questions that are asked of the evidence for it.

An effect is added where the answer to each question is yes. The selection, the trials with companions, the reason that
a reader gets and the figures of the answer all follow from this list. To change the rule, change a question here,
its number in :mod:`ident.diagnosis.evidence.criteria` and its text in :mod:`ident.words.verdict_messages`.

*Is it real?* The gain has to pass the bar, the 95 % point of the largest gain that any candidate makes of residuals
with the same spectrum and random phases (:mod:`ident.diagnosis.evidence.chance`), or half of all that can be gained.
The bar is the correction for the number of models compared. With four runs or more the gain has to pass without the run
that gains most, too: an effect that one run alone asks for is a warning about that run.

*Does it matter?* The share of the explainable power that the effect takes has to be above a hundredth beyond its error.

*Does it hold everywhere?* No condition of the tests, and none of the spans of the records
(:data:`ident.diagnosis.evidence.comparison.SPANS`), may lose beyond its error and by a hundredth of the explainable
power.

*Does it run freely?* The free run of a machine that is fitted over windows may not drift further beyond chance.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from math import sqrt

from ident.diagnosis.evidence.comparison import SPANS, Evidence
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.free_run import drives_away
from ident.words.message import Message, message
from ident.words.percent import PER_CENT


@dataclass(frozen=True)
class Question:
    """A question of the rule; `yes` answers it by the evidence, `refusal` is the reason for a reader where it is no.

    An effect that improves the model on the whole and fails a question that is `of_a_part` is tried with each other
    effect: another may be missing there. `shows` is whether the reason also says how the effect would show;
    `figure` is the name of the answer among the figures of the evidence, where it has one.
    """

    yes: Callable[[Evidence, EvidenceCriteria], bool]
    refusal: Callable[[Evidence], Message]
    of_a_part: bool = False
    shows: bool = False
    figure: str = ""


def matters(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model explains a share of the explainable power, or of the runs' means, that matters.

    It does so beyond the error of the share, or beyond that of the difference. The first is small where every block
    gains the same share, the second where some blocks, or some runs, gain more of it than others.
    """
    of_levels = evidence.level > criteria.level and evidence.level_share.above(criteria.share, criteria)
    of_difference = evidence.difference.above(criteria.share * evidence.explainable, criteria)
    return of_levels or of_difference or evidence.share.above(criteria.share, criteria)


def _too_little(evidence: Evidence) -> Message:
    share, error = PER_CENT * evidence.share.mean, PER_CENT * evidence.share.bound(EVIDENCE_CRITERIA)
    return message("why.little", share=share, error=error, least=PER_CENT * EVIDENCE_CRITERIA.share)


def generalises(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether no condition and no span loses beyond its error, and by a share of the explainable power that matters."""
    return losing_part(evidence, criteria) is None


def losing_part(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> Hashable | None:
    """The first condition or span that loses beyond its error by a share that matters; None where none does."""
    least, each = -criteria.share * evidence.explainable, criteria.of_several(len(evidence.parts))
    return next((name for name, part in evidence.parts.items() if part.below(least, each)), None)


def _loses(evidence: Evidence) -> Message:
    part = losing_part(evidence)
    return message("why.span", span=part) if part in SPANS else message("why.condition")


def runs_freely(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model, better over windows, does not drive the free run away beyond its uncertainty."""
    return evidence.free_runs is None or not drives_away(*evidence.free_runs, criteria)


def _drifts(evidence: Evidence) -> Message:
    assert evidence.free_runs is not None
    before, after = evidence.free_runs
    return message("why.free_run", before=sqrt(before.power), after=sqrt(after.power), expected=sqrt(after.expected))


QUESTIONS = (
    Question(matters, _too_little, shows=True),
    Question(generalises, _loses, of_a_part=True, figure="carries_over"),
    Question(runs_freely, _drifts, of_a_part=True),
)
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


_BY_CHANCE = Question(lambda *_: False, lambda _: message("why.chance"), shows=True)
"""The reason for an effect that passes all others: the sentences do not know the bar."""


def improves_on_the_whole(
    evidence: Evidence, bar: Callable[[], float], criteria: EvidenceCriteria = EVIDENCE_CRITERIA
) -> bool:  # fmt: skip
    """Whether the second model gains more than chance, and passes each question that is not of a part of the data."""
    asked = (question for question in QUESTIONS if not question.of_a_part)
    on_the_whole = may_be_real(evidence, criteria) and all(question.yes(evidence, criteria) for question in asked)
    return on_the_whole and is_real(evidence, bar, criteria)


def worth_adding(
    evidence: Evidence, bar: Callable[[], float] = lambda: float("inf"), criteria: EvidenceCriteria = EVIDENCE_CRITERIA
) -> bool:  # fmt: skip
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
    return next((question for question in QUESTIONS if not question.yes(evidence, EVIDENCE_CRITERIA)), _BY_CHANCE)
