"""The messages of a diagnosis, whose text is in :mod:`ident.words.verdict_messages`, and their sentences."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isfinite, sqrt
from types import MappingProxyType
from typing import Any

from ident.diagnosis.candidate import Candidate
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.discovery.proposal import Proposal
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.evidence import Evidence
from ident.diagnosis.evidence.free_run import FreeRun, drifts
from ident.diagnosis.evidence.rule import QUESTIONS, refusing
from ident.diagnosis.result import Explanation, Suspect
from ident.diagnosis.run_consistency import InconsistentParameter
from ident.diagnosis.slip_forces import SlipForces
from ident.diagnosis.total_delay import TotalDelay
from ident.diagnosis.verdict import is_improbable, is_rather_noise
from ident.diagnosis.verification import Contradiction, VerifyChange
from ident.effects.effect import Effect
from ident.fit.result import Combination
from ident.presets.record_units import SAMPLE
from ident.words.message import Message, message, said
from ident.words.percent import PER_CENT
from ident.words.titles import title


def why(candidate: Candidate, effect: Effect, before: float, floor: float | None, best: bool) -> str:
    """The evidence for or against an effect, in words; `before` is the held-out error without it."""
    if candidate.refit is None or candidate.evidence is None:
        return str(message("why.predicted", share=PER_CENT * candidate.prediction.reduction))
    errors = before, candidate.refit.held_out.error
    return why_of_evidence(candidate.evidence, effect, errors, candidate.worth_adding, floor, best)


def why_of_evidence(
    evidence: Evidence, effect: Effect, errors: tuple[float, float], worth_adding: bool, floor: float | None, best: bool
) -> str:
    """The same of an effect that was refitted; `errors` are those on held-out data without it and with it."""
    return said(list(_reasons(evidence, effect, errors, worth_adding, floor, best)))


def _reasons(
    evidence: Evidence, effect: Effect, errors: tuple[float, float], worth_adding: bool, floor: float | None, best: bool
) -> Iterator[Message]:
    (before, after), refusal = errors, refusing(evidence, worth_adding)
    if refusal is None and floor is not None:
        yield message("why.change_floor", before=before, after=after, floor=floor)
    else:
        yield message("why.change", before=before, after=after)
    if refusal is not None:
        yield refusal.reason(evidence)
        if refusal.shows:
            yield message("why.would_show", looks=effect.looks)
    else:
        if best:
            yield message("why.best")
        yield message("why.shows", looks=effect.looks)


def evidence_figures(evidence: Evidence | None, effect: Effect, worth_adding: bool) -> dict[str, Any]:
    """The figures behind an effect that was refitted, or only predicted."""
    if evidence is None:
        return {"confirmed": False, "looks": effect.looks}
    return {
        "confirmed": True,
        "nats": evidence.gain,
        "nats_without_best_run": evidence.without,
        "most_nats": evidence.most,
        "share": evidence.share.mean,
        "share_error": _known(evidence.share.error),
        "weighted_share": evidence.weighted_share.mean,
        "weighted_share_error": _known(evidence.weighted_share.error),
        "distinct": evidence.distinct,
        "beyond_chance": worth_adding,
        **{asked.figure: asked.yes(evidence, EVIDENCE_CRITERIA) for asked in QUESTIONS if asked.figure},
        "looks": effect.looks,
        "meaning": effect.meaning,
    }


def _known(error: float) -> float | None:
    return error if isfinite(error) else None


def verdict_text(
    added: Sequence[str],
    groups: Sequence[tuple[str, ...]],
    suspects: Sequence[Suspect],
    unexplained: bool,
    errors: Mapping[str, float | None],
    before: float,
    in_band: bool = True,
    floor: float | None = None,
    against: Sequence[Contradiction] = (),
    complete: bool = True,
    described: Callable[[str], str] = title,
    bounded: Sequence[str] = (),
    fewer: tuple[float, Sequence[str]] | None = None,
    unstable: Sequence[str] = (),
    probabilities: Mapping[str, float] = MappingProxyType({}),
    group_probabilities: Sequence[float] = (),
    limit: int | None = None,
    unconfirmed: Sequence[VerifyChange] = (),
    by_prediction: bool = False,
    noise_there: float | None = None,
    by_chance: tuple[Sequence[str], float | None] | None = None,
) -> str:
    """The verdict in a few sentences, contradictions first.

    `in_band` is false where the noise in the band of the command is not known, `complete` where the search was stopped.
    `described` gives the description of an effect for its first mention; `bounded` are effects whose strength ended at
    the bound of its search. `fewer` is the validation error without the last added effects, where it is smaller, and
    these effects; `unstable` are the validation runs on which the model is unstable with them. `probabilities` has the
    effects, "nothing" and something "unlisted", `group_probabilities` has one for each group. `limit` is the largest
    number of effects, where it ended the search. `unconfirmed` are the changes of the validation error by added effects
    that are not named. `by_prediction`: whether a prediction of the residual by the inputs decided whether it is noise.
    `noise_there` is the error that noise makes on validation data, where the model has far more of it there than on
    estimation data. `by_chance` are the added effects that are more probably chance, and the error with them.
    """
    named = _described_once(described)
    found = [one.message(named(one.effect)) for one in against]
    if not complete:
        found.append(message("verdict.stopped"))
    if added:
        of_groups = dict(zip(map(tuple, groups), group_probabilities, strict=False))
        if against:  # a probability knows nothing of validation data, and the error there is said already
            effects = [message("effect", names=[named(name)]) for name in added]
            change = message("change", before=before, after=errors["fit"])
        else:
            effects = [_lacking(name, added, of_groups, probabilities, named) for name in added]
            change = _change(before, errors, fewer, unstable)
        improbable = any(is_improbable(effect.values.get("probability"), probabilities) for effect in effects)
        found.append(_falls(added, effects, change, bool(against) or unexplained, improbable))
    elif by_chance is not None:
        change = message("change", before=before, after=by_chance[1])
        effects = [message("effect", names=[named(name)]) for name in by_chance[0]]
        found.append(message("verdict.by_chance", probability=probabilities["nothing"], effects=effects, change=change))
    elif not complete or unconfirmed:
        found.append(message("verdict.unconfirmed", before=before))
    else:
        found.append(_nothing(unexplained, floor, by_prediction, probabilities, before))
    if noise_there is not None and not against and (not unexplained or is_rather_noise(probabilities)):
        found.append(message("verdict.validation", error=errors["verify"], noise=noise_there))
    found += [_shows_nothing(named(change.effect), change) for change in unconfirmed]
    found += [message("verdict.bounded", effect=named(name)) for name in bounded]
    found += [_group(group, added, named, unexplained) for group in groups]
    if not against and (others := _others(added, groups, probabilities)):
        found.append(message("verdict.others", others=others))
    found += [message("verdict.label", run=one.run, what=one.what, evidence=one.evidence) for one in suspects]
    if unexplained:
        found += _remaining(complete, limit, probabilities, in_band, floor, by_prediction)
    return said(found)


def _nothing(
    unexplained: bool, floor: float | None, by_prediction: bool, probabilities: Mapping[str, float], before: float
) -> Message:
    """The message that no effect lowers the error, and whether the residual is noise."""
    if unexplained:
        return message("verdict.none", before=before)
    if floor is None:
        return message("verdict.white", before=before)
    key = "verdict.unpredicted" if by_prediction else "verdict.nothing"
    return _probable(key, "nothing", probabilities, before=before)


def _shows_nothing(named: str, change: VerifyChange) -> Message:
    """The message that validation data show nothing of an effect, by the errors that decide.

    An effect that changes the output by more than the error foretells no error there.
    """
    first = change.with_mean[0] if change.with_mean else change.before
    last = first + change.rise
    if change.shown >= first:
        return message("verdict.changes_more", named=named, before=first, after=last, shown=change.shown)
    return message("verdict.shows_nothing", named=named, before=first, after=last, due=first - change.due)


def _falls(
    added: Sequence[str], effects: Sequence[Message], change: Message, partly: bool, improbable: bool
) -> Message:
    """The message that the error falls with the added effects, and its meaning for the model."""
    if partly:
        return message("verdict.partly", effects=effects, change=change)
    if improbable:
        return message("verdict.may_lack", effects=effects, change=change)
    if any(effect.key == "effect.one_of" for effect in effects):
        return message("verdict.lacks_one_of", effects=effects, change=change, added=added)
    return message("verdict.lacks", effects=effects, change=change)


def _remaining(
    complete: bool,
    limit: int | None,
    probabilities: Mapping[str, float],
    in_band: bool,
    floor: float | None,
    predicted: bool,
) -> Iterator[Message]:
    """The messages that the residual is more than noise, and why a part of it may be noise or a further effect."""
    examined = complete and limit is None
    if is_rather_noise(probabilities):
        key = "verdict.correlated" if floor is None else "verdict.above_floor"
        yield message(key, probability=probabilities["unlisted"])
    else:
        yield _probable("verdict.unlisted" if examined else "verdict.remains", "unlisted", probabilities)
    if limit is not None:
        yield message("verdict.limited", limit=limit)
    if predicted:
        yield message("verdict.predicted")
    if not in_band:
        yield message("verdict.not_repeated_floor_unknown" if floor is None else "verdict.not_repeated")


_PROBABLE: Mapping[str, str] = {
    "effect": "effect.probable",
    "verdict.nothing": "verdict.nothing_probable",
    "verdict.unpredicted": "verdict.unpredicted_probable",
    "verdict.unlisted": "verdict.unlisted_probable",
    "verdict.remains": "verdict.remains_probable",
}
"""For each message the message with a probability."""


def _probable(key: str, name: str, probabilities: Mapping[str, float], **values: object) -> Message:
    """The message, with its probability where it is known."""
    if name not in probabilities:
        return message(key, **values)
    return message(_PROBABLE[key], probability=probabilities[name], **values)


def _lacking(
    name: str,
    added: Sequence[str],
    of_groups: Mapping[tuple[str, ...], float],
    probabilities: Mapping[str, float],
    named: Callable[[str], str],
) -> Message:
    """An effect and its probability; for an effect of a group, the whole group and the group's probability."""
    group = next((group for group in of_groups if name in group and not has_two(group, added)), ())
    if not group:
        return _probable("effect", name, probabilities, names=[named(name)])
    names = [name, *(other for other in group if other != name)]
    return message("effect.one_of", names=list(map(named, names)), probability=of_groups[group])


def _group(group: Sequence[str], added: Sequence[str], named: Callable[[str], str], unexplained: bool) -> Message:
    """The message that the data do not distinguish the effects of a group."""
    if has_two(group, added):
        key = "verdict.two_unexplained" if unexplained else "verdict.two"
    else:
        key = "verdict.group_unexplained" if unexplained else "verdict.group"
    return message(key, group=list(map(named, group)))


def _others(added: Sequence[str], groups: Sequence[Sequence[str]], probabilities: Mapping[str, float]) -> list[Message]:
    """The effects that are neither named nor in a group, and at least half as probable as a named one.

    An effect that is hardly probable has no alternatives, and is none.
    """
    said = {*added, *(name for group in groups for name in group), "nothing", "unlisted"}
    worth = CRITERIA.evidence.chance
    named = [probabilities[name] for name in added if probabilities.get(name, 0.0) >= worth]
    least = max(min(named, default=2.0) / 2, worth)
    others = [name for name, probability in probabilities.items() if name not in said and probability >= least]
    others.sort(key=probabilities.__getitem__, reverse=True)
    return [_probable("effect", name, probabilities, names=[title(name)]) for name in others]


def has_two(group: Sequence[str], added: Sequence[str]) -> bool:
    """Whether two effects of a group were added: two others explain the data as well."""
    return len({*group} & {*added}) == 2


def cannot_distinguish(group: Sequence[str], added: Sequence[str]) -> str:
    """The sentence that data cannot distinguish the effects of a group, one or two of which were added."""
    return str(message("group.two" if has_two(group, added) else "group", group=list(map(title, group))))


def _change(
    before: float,
    errors: Mapping[str, float | None],
    fewer: tuple[float, Sequence[str]] | None,
    unstable: Sequence[str],
) -> Message:
    """The change of the error on estimation data, and the error on validation data."""
    after, verify = errors["fit"], errors.get("verify")
    if unstable:
        return message("change.unstable", before=before, after=after, runs=unstable)
    if verify is None:
        return message("change", before=before, after=after)
    if fewer is None:
        return message("change.verify", before=before, after=after, verify=verify)
    return message("change.fewer", before=before, after=after, verify=verify, fewer=fewer[0], without=fewer[1])


def alternative_sentences(elsewhere: Sequence[Explanation]) -> Iterator[str]:
    """A sentence on the other models that explain the data better, and one on those that explain them as well."""
    for better, key in ((True, "alternative.better"), (False, "alternative.equal")):
        if models := [_alternative(one) for one in elsewhere if one.better is better]:
            yield str(message(key, models=models))


def dispensable_sentence(names: Sequence[str]) -> Iterator[str]:
    """A sentence on the effects that are redundant with the proposed terms."""
    if names:
        yield str(message("dispensable.several" if len(names) > 1 else "dispensable.one", effects=names))


def horizon_sentence(fitted: float | None, horizon: float | None) -> Iterator[str]:
    """A sentence on the horizon of the errors of a diagnosis, where it is not the fit's."""
    if horizon is None:
        yield str(message("horizon.runs", fitted=fitted or 0.0))
    else:
        yield str(message("horizon.windows", horizon=horizon, fitted=fitted or 0.0))


def free_run_sentence(free: FreeRun) -> Iterator[str]:
    """A sentence on a free run that drifts further than windows explain."""
    if drifts(free):
        yield str(message("free_run", error=sqrt(free.power), expected=sqrt(free.expected)))


def slip_sentence(found: SlipForces | None) -> Iterator[str]:
    """The sentence that friction with a constant force is also friction that differs each way."""
    if found is not None:
        sizes = {"forward": found.forward, "backward": found.backward}
        sizes |= {"friction": found.friction, "constant": found.constant}
        yield str(message("slip_forces", **{name: (size, found.unit) for name, size in sizes.items()}))


def delay_sentence(late: TotalDelay, described: Callable[[str], str] = title, without: Sequence[str] = ()) -> str:
    """A sentence on the total delay `without` some effects, and on the lags and delays the data cannot distinguish."""
    constant = message("parameter", name=late.parameter.name, meaning=late.parameter.meaning)
    values = {"time": _seconds(late.fitted), "names": [constant, *map(described, late.in_place)]}
    if late.before and without:
        return str(message("delay.without_before", before=_seconds(late.before), without=without, **values))
    if late.before:
        return str(message("delay.before", before=_seconds(late.before), **values))
    return str(message("delay.without", without=without, **values) if without else message("delay", **values))


def _seconds(of: Combination) -> Message:
    return message("late.samples" if of.unit == SAMPLE else "late.seconds", value=of.value, error=of.std_error)


def _alternative(one: Explanation) -> Message:
    if one.better and one.effects:
        return message("machine.effect_error", machine=one.machine, effect=one.effects[-1], error=one.error["fit"])
    if one.better:
        return message("machine.error", machine=one.machine, error=one.error["fit"])
    if one.effects:
        return message("machine.effect", machine=one.machine, effect=one.effects[-1])
    return message("machine", machine=one.machine)


def inconsistent_sentence(parameters: Sequence[InconsistentParameter], moved: bool) -> Iterator[str]:
    """The sentence that runs alone give different parameters; none where they agree.

    `moved` is whether a recorded motion drives the machine: then no drive stands between the command and the machine.
    """
    if parameters:
        listed = [
            message("inconsistent.parameter", name=p.name, least=(p.least, p.unit), most=(p.most, p.unit))
            for p in parameters
        ]
        cause = message("inconsistent.moved" if moved else "inconsistent.driven")
        yield str(message("inconsistent", parameters=listed, names=[p.name for p in parameters], cause=cause))


def proposed_text(terms: Sequence[Proposal]) -> str:
    """The sentences on the proposed terms, which are no part of the verdict."""
    return said(list(_proposed(terms)))


def _proposed(terms: Sequence[Proposal]) -> Iterator[Message]:
    last, listed = terms[-1], [_term(one) for one in terms]
    for one in terms:
        if one.contradicted and not one.corrected_by(last):
            yield one.contradicted.message(one.equation)
    if last.instead_of:
        yield message("proposed.instead", instead=last.instead_of, terms=listed)
    else:
        yield message("proposed", terms=listed)
    if any(one.hypothesis for one in terms):
        yield message("proposed.hypothesis")
    if any(one.free_curve for one in terms):
        yield message("proposed.free_curve")
    error, on_verify = last.error["fit"], last.error_of("verify")
    if on_verify.is_unstable:
        yield message("proposed.error_unstable", terms=terms, error=error, runs=on_verify.unstable)
    elif on_verify.error is not None:
        yield message("proposed.error_verify", terms=terms, error=error, verify=on_verify.said())
    else:
        yield message("proposed.error", terms=terms, error=error)
    for one in terms:
        if one.contradicted and one.corrected_by(last):
            yield _alone(one.equation, one.contradicted)


def _term(one: Proposal) -> Message:
    if one.meaning:
        return message("term.meaning", equation=one.equation, meaning=one.meaning)
    return message("term", equation=one.equation)


def _alone(equation: str, against: Contradiction) -> Message:
    if against.after is None:
        return message("alone.unstable", equation=equation, runs=against.unstable, before=against.before)
    return message("alone.rises", equation=equation, before=against.before, after=against.after)


def _described_once(described: Callable[[str], str]) -> Callable[[str], str]:
    """The names of effects, with a description at the first mention only."""
    seen: set[str] = set()

    def named(effect: str) -> str:
        if effect in seen:
            return title(effect)
        seen.add(effect)
        return described(effect)

    return named
