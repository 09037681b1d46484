"""What a diagnosis says, in sentences."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from ident.diagnosis.candidate import Candidate
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.evidence.comparison import HALVES, Evidence, generalises, losing_part, matters
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.result import Explanation, Suspect
from ident.diagnosis.total_delay import TotalDelay
from ident.diagnosis.verification import Contradiction
from ident.effects.effect import Effect
from ident.fit.result import Combination
from ident.presets.record_units import SAMPLE
from ident.words.error import error_said, unstable_on
from ident.words.listed import all_of
from ident.words.percent import percent
from ident.words.probability import probability_said
from ident.words.run_name import run_name
from ident.words.titles import title

_BOUNDED = (
    "The strength of {} ended at the bound of its search: it may be larger, or stand for something else. Bounds of "
    "your own let it go farther."
)

_LOSES = "but it rises on {}: what only a part of the data asks for is not added."
_TOO_LITTLE = (
    "it explains {:.2g} ± {:.2g} % of what is above the noise, and that counts from {:.2g} % on, beyond the error. It "
    "would show as: {}."
)
_CHANCE = "no more than the best of all effects takes by chance. It would show as: {}."


def why(candidate: Candidate, effect: Effect, before: float, floor: float | None, best: bool) -> str:
    """Why the data speak for or against an effect; `before` is the held-out error without it."""
    if candidate.refit is None or candidate.evidence is None:
        share = 100 * candidate.prediction.reduction
        return f"Predicted to take {share:.2g} % off the error, less than others; it was not refitted."
    errors = before, candidate.refit.held_out.error
    return why_of_evidence(candidate.evidence, effect, errors, candidate.improves, floor, best)


def why_of_evidence(
    found: Evidence, effect: Effect, errors: tuple[float, float], improves: bool, floor: float | None, best: bool
) -> str:  # fmt: skip
    """The same of an effect that was refitted; `errors` are those on held-out data without it and with it."""
    change = "On data held out from the fit the error goes from {} to {}".format(*map(error_said, errors))
    if not matters(found):
        share, error = 100 * found.share.mean, 100 * found.share.bound(EVIDENCE_CRITERIA)
        return f"{change}: {_TOO_LITTLE.format(share, error, 100 * EVIDENCE_CRITERIA.share, effect.looks)}"
    if not generalises(found):
        return f"{change}, {_LOSES.format(_part_said(losing_part(found)))}"
    if not improves:
        return f"{change}: {_CHANCE.format(effect.looks)}"
    near = f", with the noise floor at {percent(floor)}" if floor is not None else ""
    first = "No other effect does better. " if best else ""
    return f"{change}{near}. {first}It shows as: {effect.looks}."


def _part_said(part: Hashable) -> str:
    """A part of the data in words: a half of the records, or one condition of the test."""
    return f"the {part} of the records" if part in HALVES else "one condition of the tests"


def evidence_figures(found: Evidence | None, effect: Effect, improves: bool) -> dict[str, Any]:
    """The figures behind an effect that was refitted, or only predicted."""
    if found is None:
        return {"confirmed": False, "looks": effect.looks}
    return {
        "confirmed": True, "nats": found.gain, "nats_without_best_run": found.without, "most_nats": found.most,
        "share": found.share.mean, "share_error": found.share.error if found.share.blocks > 1 else None,
        "distinct": found.distinct, "beyond_chance": improves, "carries_over": generalises(found),
        "looks": effect.looks, "meaning": effect.meaning,
    }  # fmt: skip


def verdict_text(
    added: Sequence[str], groups: Sequence[tuple[str, ...]], suspects: Sequence[Suspect], unexplained: bool,
    errors: Mapping[str, float | None], before: float, repeats: bool = True, floor: float | None = None,
    against: Sequence[Contradiction] = (), complete: bool = True, described: Callable[[str], str] = title,
    bounded: Sequence[str] = (), fewer: tuple[float, Sequence[str]] | None = None, unstable: Sequence[str] = (),
    probabilities: Mapping[str, float] = MappingProxyType({}),
) -> str:  # fmt: skip
    """The verdict in a few sentences, what speaks against it first.

    Without `repeats` nobody knows how much noise lies in the command's band. Not `complete`, the search was stopped.
    `described` tells what an effect is the first time that it is named; `bounded` are those whose strength ended at the
    bound of its search. `fewer` is the error on verify runs without the last of what was added, where it is
    smaller there; `unstable` are the verify runs on which the model is unstable with it. `probabilities` are those
    of effects, of "nothing" and of something "unlisted".
    """
    named = _described_once(described)
    parts = [one.sentence(named(one.effect)) for one in against]
    if not complete:
        parts.append("The search was not over: what else is missing, and what could stand in the place of what was "
                     "found, was not looked at.")  # fmt: skip
    if added:
        said = [_probable(named(name), name, probabilities) for name in added]
        parts.append(_improves(said, bool(against) or unexplained, before, errors, fewer, unstable))
    elif not complete:
        parts.append(f"No effect was confirmed that lowers the error of {error_said(before)}.")
    elif not unexplained and floor is None:
        parts.append(f"Nothing is seen to be missing: the residual, {error_said(before)}, has no memory from sample to "
                     "sample. How much of it is noise is not known.")  # fmt: skip
    elif not unexplained:
        parts.append(
            _probable("Nothing is missing", "nothing", probabilities)
            + f": the error of {error_said(before)} is the noise's."
        )
    else:
        parts.append(f"No effect of the catalogue lowers the error of {error_said(before)} beyond chance.")
    parts += [_BOUNDED.format(named(name)) for name in bounded]
    chance = "chance, or than what is left could have made" if unexplained else "chance"
    parts += [
        f"This matrix {cannot_distinguish(group, added, named)}; their refits differ by less than {chance}."
        for group in groups
    ]
    for suspect in suspects:
        parts.append(f"{run_name(suspect.run, begins=True)} is doubted ({suspect.what}): {suspect.evidence}.")
    if unexplained:
        left = "Something is left that none of the listed effects explains" if complete else "Something is left"
        parts.append(_probable(left, "unlisted", probabilities) + ".")
        if not repeats:
            parts.append("No command was measured twice: part of it may be noise in the command's band, "
                         "which a repeated run would tell.")  # fmt: skip
    return " ".join(parts)


def _probable(said: str, name: str, probabilities: Mapping[str, float]) -> str:
    """What is said, and how probable it is where that is known."""
    return f"{said} (probability {probability_said(probabilities[name])})" if name in probabilities else said


def cannot_distinguish(group: Sequence[str], added: Sequence[str], described: Callable[[str], str] = title) -> str:
    """What data cannot do of a group of effects of which one was added, or two that stand for two others as well."""
    what = "which two these are of" if len({*group} & {*added}) == 2 else "apart"
    return f"cannot tell {what}: {', '.join(map(described, group))}"


def _improves(
    named: Sequence[str], in_doubt: bool, before: float, errors: Mapping[str, float | None],
    fewer: tuple[float, Sequence[str]] | None, unstable: Sequence[str],
) -> str:  # fmt: skip
    names = all_of(named)
    them = "it" if len(named) == 1 else "them"
    lacks = "What helps on the fitted runs is" if in_doubt else "The model lacks"
    verify = errors.get("verify")
    said = "" if verify is None else f" ({error_said(verify)} on verify runs{_with_fewer(fewer)})"
    said = f" ({unstable_on(unstable)})" if unstable else said
    fell = f"from {error_said(before)} to {error_said(errors['fit'])}"
    return f"{lacks} {names}: with {them} the error falls {fell}{said}."


def _with_fewer(of: tuple[float, Sequence[str]] | None) -> str:
    return "" if of is None else f", {error_said(of[0])} without {', '.join(map(title, of[1]))}"


def alternative_sentences(elsewhere: Sequence[Explanation]) -> Iterator[str]:
    """What other models explain better, or as well, in a sentence each; nothing where there is none."""
    said = {better: [_alternative(one) for one in elsewhere if one.better is better] for better in (True, False)}
    if said[True]:
        yield f"Another model explains more: {', '.join(said[True])} (--model)."
    if said[False]:
        yield f"These data cannot tell it from other models: {', '.join(said[False])}."


def dispensable_sentence(names: Sequence[str]) -> Iterator[str]:
    """Which effects only stood for what a search proposes, in a sentence."""
    if names:
        needed = "are not needed: they stood" if len(names) > 1 else "is not needed: it stood"
        listed = all_of([*map(title, names)])
        yield f"Beside what a search proposes beyond the catalogue {listed} {needed} for that."


def horizon_sentence(fitted: float | None, horizon: float | None) -> Iterator[str]:
    """Over what errors are those of the diagnosis, where these are not the windows of the fit."""
    over = "whole runs" if horizon is None else f"windows of {horizon:.3g} s"
    yield (
        f"These are errors over {over}, where the fit was made over windows of {fitted or 0.0:.3g} s: chosen without "
        "what was found, those forgave what it adds up to."
    )


def delay_sentence(late: TotalDelay, described: Callable[[str], str] = title, without: Sequence[str] = ()) -> str:
    """How late the machine answers `without` some effects, and what the data cannot tell it from, in a sentence."""
    names = ", ".join((f"{late.parameter.name} ({late.parameter.meaning})", *map(described, late.in_place)))
    before = f", {_seconds(late.before)} by the fitted model" if late.before else ""
    begin = f"Without {', '.join(map(title, without))} a slow" if without else "A slow"
    return (
        f"{begin} command is answered {_seconds(late.fitted)} late{before}; "
        f"by which lag or delay these data cannot tell: {names}."
    )


def _seconds(of: Combination) -> str:
    return f"{of.value:.3g} ± {of.std_error:.2g} {'samples' if of.unit == SAMPLE else 's'}"


def _alternative(one: Explanation) -> str:
    name = f"{one.machine} with {title(one.effects[-1])}" if one.effects else one.machine
    return f"{name}, {error_said(one.error['fit'])}" if one.better else name


def proposed_text(terms: Sequence[Proposal]) -> str:
    """What a search beyond the catalogue proposes, in a sentence: no part of the verdict."""
    said = "; ".join(one.equation + (f" ({one.meaning})" if one.meaning else "") for one in terms)
    last = terms[-1]
    on_verify = last.error_of("verify")
    verify = f" ({on_verify.said()} on verify runs)" if on_verify.error is not None else ""
    verify = f" ({on_verify.said()})" if on_verify.is_unstable else verify
    doubt = ", a hypothesis" if any(one.hypothesis for one in terms) else ""
    doubt += ", at last a free curve" if any(one.free_curve for one in terms) else ""
    instead = f" in place of {', '.join(map(title, last.instead_of))}" if last.instead_of else ""
    it = "it" if len(terms) == 1 else "them"
    against = [
        one.contradicted.sentence(one.equation)
        for one in terms
        if one.contradicted and not _later_terms_correct(one, last)
    ]
    return " ".join([
        *against,
        f"Beyond the catalogue a search proposes{doubt}{instead}: {said}.",
        f"With {it} the error is {error_said(last.error['fit'])}{verify}.",
        *(_alone(one) for one in terms if _later_terms_correct(one, last)),
    ])  # fmt: skip


def _later_terms_correct(one: Proposal, last: Proposal) -> bool:
    """Whether the terms that came after one bring down the error on verify runs that it raised."""
    left = last.error.get("verify")
    return one.contradicted is not None and left is not None and left < one.contradicted.before


def _alone(one: Proposal) -> str:
    against = one.contradicted
    assert against is not None
    return f"With {one.equation} but without those after it {against.rise}."


def _described_once(described: Callable[[str], str]) -> Callable[[str], str]:
    """The name of an effect with what it is told by the first time, bare then."""
    said: set[str] = set()

    def named(effect: str) -> str:
        if effect in said:
            return title(effect)
        said.add(effect)
        return described(effect)

    return named
