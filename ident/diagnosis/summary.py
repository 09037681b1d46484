"""The verdict in three lines: the missing effects with their probabilities, the change of the error, the next step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ident.diagnosis.result import Diagnosis, Suspect
from ident.diagnosis.sentences import has_two
from ident.diagnosis.verdict import is_improbable, is_rather_noise
from ident.diagnosis.verification import noise_on_validation_data
from ident.words.message import Message, message
from ident.words.result_tables import in_brief
from ident.words.run_name import run_name
from ident.words.titles import title

_USES = ("verify", "held_out", "fit")
"""The uses of data in the order in which their error is reported: the first one with an error."""


@in_brief.register
def summary(diagnosis: Diagnosis) -> tuple[str, ...]:
    """One or two sentences for each line, from the stored fields alone, so that a diagnosis of any version has them."""
    return tuple(map(str, summary_messages(diagnosis)))


def summary_messages(diagnosis: Diagnosis) -> tuple[Message, Message, Message]:
    """The three lines as messages."""
    return _missing(diagnosis), _error(diagnosis), next_step(diagnosis)


def _missing(diagnosis: Diagnosis) -> Message:
    verdict = diagnosis.verdict
    if diagnosis.lacks_input:
        return message("summary.missing_input", run=diagnosis.missing_inputs[0]["run"])
    if diagnosis.oscillates:
        return message("summary.oscillation", evidence=diagnosis.oscillation[0]["evidence"])
    if verdict.effects:
        named = [_named(diagnosis, name) for name in verdict.effects]
        if verdict.standing == "contradicted":
            return _contradicted(diagnosis)
        return _missing_and_helping(diagnosis, named)
    if verdict.suspects:
        return message("summary.label", run=verdict.suspects[0].run)
    if not diagnosis.complete:
        return message("summary.stopped" if diagnosis.candidates else "summary.unexamined")
    if verdict.by_chance:
        helping = [_named(diagnosis, name) for name in verdict.by_chance]
        return message("summary.helping_by_chance", helping=helping)
    if verdict.unconfirmed:
        return message("summary.unconfirmed", effects=[_strong(diagnosis, name) for name in verdict.unconfirmed])
    if verdict.unexplained and not is_rather_noise(verdict.probabilities):
        return _probable(diagnosis, "unlisted", "summary.unlisted", "summary.unlisted_probable")
    if _fails_on_validation_data(diagnosis):
        return message("summary.validation")
    if verdict.unexplained:
        correlated = verdict.noise_test is not None and verdict.noise_test.floor is None
        key = "summary.correlated" if correlated else "summary.above_floor"
        return message(key, probability=verdict.probabilities["nothing"])
    return _probable(diagnosis, "nothing", "summary.nothing", "summary.nothing_probable")


def _fails_on_validation_data(diagnosis: Diagnosis) -> bool:
    """Whether the model has far more than noise on validation data, where nothing is missing by estimation data."""
    verdict, steps = diagnosis.verdict, diagnosis.confirmed_ladder or (diagnosis.baseline,)
    if verdict.effects or (verdict.unexplained and not is_rather_noise(verdict.probabilities)):
        return False
    return noise_on_validation_data(steps[-1].error, diagnosis.noise_floor) is not None


def _contradicted(diagnosis: Diagnosis) -> Message:
    """The effects that validation data contradict, with those that were added on top of them, and those before.

    Without their probabilities, which know nothing of validation data.
    """
    named, against = diagnosis.verdict.effects, diagnosis.verdict.contradicted_by
    first = next((number for number, name in enumerate(named) if name in against), 0)
    before, effects = ([_strong(diagnosis, name) for name in part] for part in (named[:first], named[first:]))
    if not before:
        return message("summary.contradicted", effects=effects)
    return message("summary.contradicted_after", before=before, effects=effects)


def _missing_and_helping(diagnosis: Diagnosis, named: Sequence[Message]) -> Message:
    """The missing effects, and the effects that improve the model though they are less probable than not."""
    of_all = diagnosis.verdict.probabilities
    improbable = [is_improbable(_probability(diagnosis, name), of_all) for name in diagnosis.verdict.effects]
    missing = [effect for effect, doubted in zip(named, improbable, strict=True) if not doubted]
    helping = [effect for effect, doubted in zip(named, improbable, strict=True) if doubted]
    if not helping:
        remains = diagnosis.verdict.unexplained and not is_rather_noise(of_all)
        partly = diagnosis.verdict.standing == "stand_in" and remains
        return message("summary.missing_partly" if partly else "summary.missing", effects=missing)
    if not missing:
        return message("summary.helping_by_chance" if _may_be_chance(diagnosis) else "summary.helping", helping=helping)
    return message("summary.missing_and_helping", effects=missing, helping=helping)


def _may_be_chance(diagnosis: Diagnosis) -> bool:
    """Whether all named effects are improbable, and most probably nothing is missing."""
    verdict, of_all = diagnosis.verdict, diagnosis.verdict.probabilities
    improbable = all(is_improbable(_probability(diagnosis, name), of_all) for name in verdict.effects)
    return bool(verdict.effects) and improbable and of_all.get("nothing", 0.0) > of_all.get("unlisted", 0.0)


def _probability(diagnosis: Diagnosis, name: str) -> float | None:
    """The probability of an effect, or of its group; None where it is not known."""
    verdict = diagnosis.verdict
    group = _group(diagnosis, name)
    of_group = dict(zip(verdict.indistinguishable, verdict.group_probabilities, strict=False)).get(group)
    return verdict.probabilities.get(name) if of_group is None else of_group


def _group(diagnosis: Diagnosis, name: str) -> tuple[str, ...]:
    """The effects that the data cannot tell apart from one, itself included; none where there are no others."""
    return next((group for group in diagnosis.verdict.indistinguishable if name in group), ())


def _probable(diagnosis: Diagnosis, what: str, bare: str, with_probability: str) -> Message:
    probability = diagnosis.verdict.probabilities.get(what)
    return message(bare) if probability is None else message(with_probability, probability=probability)


def _named(diagnosis: Diagnosis, name: str) -> Message:
    """An effect or its group, with its strength and its probability."""
    probability = _probability(diagnosis, name)
    if probability is None:
        return _strong(diagnosis, name)
    names = _names(diagnosis, name)
    if len(names) > 1 and not has_two(_group(diagnosis, name), diagnosis.verdict.effects):
        return message("effect.one_of", names=names, probability=probability)
    strength = _strength(diagnosis, name) if len(names) == 1 else None
    if strength is None:
        return message("effect.probable", names=names, probability=probability)
    return message("effect.strength_probable", names=names, strength=strength, probability=probability)


def _strong(diagnosis: Diagnosis, name: str) -> Message:
    """An effect or its group, with its strength."""
    names = _names(diagnosis, name)
    strength = _strength(diagnosis, name) if len(names) == 1 else None
    return (
        message("effect", names=names)
        if strength is None
        else message("effect.strength", names=names, strength=strength)
    )


def _names(diagnosis: Diagnosis, name: str) -> list[str]:
    """The titles of an effect and of the others of its group that are not named themselves."""
    others = (other for other in _group(diagnosis, name) if other != name and other not in diagnosis.verdict.effects)
    return [title(name), *map(title, others)]


def _strength(diagnosis: Diagnosis, name: str) -> tuple[float, float, str] | None:
    """The strength on the last step, its standard error and unit; None where it is not known."""
    last = diagnosis.confirmed_ladder[-1].parameters if diagnosis.ladder else {}
    strength = next((p for parameter, p in last.items() if parameter.startswith(f"{name}.")), None)
    if strength is None or strength.std_error is None:
        return None
    return strength.value, strength.std_error, strength.unit


def _error(diagnosis: Diagnosis) -> Message:
    """The error on the first use of :data:`_USES` that has one, before and after, and the noise floor."""
    steps = diagnosis.confirmed_ladder or (diagnosis.baseline,)
    use = next((use for use in _USES if steps[0].error.get(use) is not None), _USES[-1])
    before, after = (step.error.get(use) for step in (steps[0], steps[-1]))
    floor = diagnosis.noise_floor.get(use) or diagnosis.noise_floor.get("fit")
    if before is None:
        return message("summary.error_unknown")
    if not diagnosis.verdict.effects or len(steps) == 1:
        if floor is None:
            return message("summary.error_floor_unknown", use=use, before=before)
        return message("summary.error", use=use, before=before, floor=floor)
    if floor is None:
        return message("summary.change_floor_unknown", use=use, before=before, after=after)
    return message("summary.change", use=use, before=before, after=after, floor=floor)


def next_step(diagnosis: Diagnosis) -> Message:
    """The next step."""
    verdict = diagnosis.verdict
    if diagnosis.lacks_input:
        return message("next.input")
    if diagnosis.oscillates:
        return message("next.oscillation", runs=[run_name(str(swing["run"])) for swing in diagnosis.oscillation])
    if verdict.suspects:
        return _correct(verdict.suspects[0], verdict.effects)
    if not diagnosis.complete:
        return message("next.time")
    if verdict.standing == "contradicted":
        return message("next.compare", effect=verdict.contradicted_by[0])
    if _may_be_chance(diagnosis):
        return message("next.then", then=_then(diagnosis))
    if verdict.indistinguishable and diagnosis.next_experiment is not None:
        return message("next.distinguish", group=verdict.indistinguishable[0])
    if not verdict.effects and (verdict.unconfirmed or _fails_on_validation_data(diagnosis)):
        return message("next.validation")
    if verdict.unexplained and diagnosis.max_effects and len(verdict.effects) >= diagnosis.max_effects:
        return message("next.more", most=2 * diagnosis.max_effects)
    if verdict.unexplained and verdict.effects:
        return message("next.add_and", effects=verdict.effects, then=_then(diagnosis))
    if verdict.unexplained:
        return message("next.then", then=_then(diagnosis))
    return message("next.add", effects=verdict.effects) if verdict.effects else message("next.use")


def _correct(suspect: Suspect, effects: Sequence[str]) -> Message:
    """The label to correct, with its value and the value by the data where both are known, and the missing effects."""
    if suspect.stated is None or suspect.found is None:
        if effects:
            return message("next.label_and", run=suspect.run, effects=effects)
        return message("next.label", run=suspect.run)
    stated, found = (suspect.stated, suspect.unit), (suspect.found, suspect.unit)
    values: dict[str, Any] = {"run": suspect.run, "what": suspect.what, "stated": stated, "found": found}
    if effects:
        return message("next.label_value_and", effects=effects, **values)
    return message("next.label_value", **values)


def _then(diagnosis: Diagnosis) -> list[Message]:
    """The ways to find further effects: the proposed terms and the next run, else the search that was not made."""
    terms = [message("then.terms")] if diagnosis.proposals else []
    run = [message("then.run")] if diagnosis.next_experiment is not None else []
    return [*terms, *run] or [message("then.search")]
