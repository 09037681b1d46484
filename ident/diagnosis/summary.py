"""The verdict in three lines: the missing effects with their probabilities, the change of the error, the next step."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ident.diagnosis.evidence.probability import is_improbable
from ident.diagnosis.result import Diagnosis, Suspect
from ident.diagnosis.sentences import has_two
from ident.words.message import Message, message
from ident.words.run_name import run_name
from ident.words.shown import in_brief
from ident.words.titles import title

_USES = ("verify", "held_out", "fit")
"""The uses of data in the order in which their error is reported: the first one with an error."""


@in_brief.register
def summary(found: Diagnosis) -> tuple[str, ...]:
    """One or two sentences for each line, from the stored fields alone, so that a diagnosis of any version has them."""
    return tuple(map(str, summary_messages(found)))


def summary_messages(found: Diagnosis) -> tuple[Message, Message, Message]:
    """The three lines as messages."""
    return _missing(found), _error(found), next_step(found)


def _missing(found: Diagnosis) -> Message:
    verdict = found.verdict
    if found.lacks_input:
        return message("summary.missing_input", run=found.missing_inputs[0]["run"])
    if found.oscillates:
        return message("summary.oscillation", evidence=found.oscillation[0]["evidence"])
    if verdict.effects:
        named = [_named(found, name) for name in verdict.effects]
        if verdict.standing == "contradicted":  # a probability knows nothing of validation data
            return message("summary.contradicted", effects=[_strong(found, name) for name in verdict.effects])
        return _missing_and_helping(found, named)
    if verdict.suspects:
        return message("summary.label", run=verdict.suspects[0].run)
    if not found.complete:
        return message("summary.stopped" if found.candidates else "summary.unexamined")
    if verdict.unexplained:
        return _probable(found, "unlisted", "summary.unlisted", "summary.unlisted_probable")
    return _probable(found, "nothing", "summary.nothing", "summary.nothing_probable")


def _missing_and_helping(found: Diagnosis, named: Sequence[Message]) -> Message:
    """The missing effects, and the effects that improve the model though they are less probable than not."""
    of_all = found.verdict.probabilities
    improbable = [is_improbable(_probability(found, name), of_all) for name in found.verdict.effects]
    missing = [effect for effect, doubted in zip(named, improbable, strict=True) if not doubted]
    helping = [effect for effect, doubted in zip(named, improbable, strict=True) if doubted]
    if not helping:
        partly = found.verdict.standing == "stand_in" and found.verdict.unexplained
        return message("summary.missing_partly" if partly else "summary.missing", effects=missing)
    if not missing:
        return message("summary.helping_by_chance" if _by_chance(found) else "summary.helping", helping=helping)
    return message("summary.missing_and_helping", effects=missing, helping=helping)


def _by_chance(found: Diagnosis) -> bool:
    """Whether all named effects are improbable, and most probably nothing is missing."""
    verdict, of_all = found.verdict, found.verdict.probabilities
    improbable = all(is_improbable(_probability(found, name), of_all) for name in verdict.effects)
    return bool(verdict.effects) and improbable and of_all.get("nothing", 0.0) > of_all.get("unlisted", 0.0)


def _probability(found: Diagnosis, name: str) -> float | None:
    """The probability of an effect, or of its group; None where it is not known."""
    verdict = found.verdict
    group = _group(found, name)
    of_group = dict(zip(verdict.indistinguishable, verdict.group_probabilities, strict=False)).get(group)
    return verdict.probabilities.get(name) if of_group is None else of_group


def _group(found: Diagnosis, name: str) -> tuple[str, ...]:
    """The effects that the data cannot tell apart from one, itself included; none where there are no others."""
    return next((group for group in found.verdict.indistinguishable if name in group), ())


def _probable(found: Diagnosis, what: str, bare: str, with_probability: str) -> Message:
    probability = found.verdict.probabilities.get(what)
    return message(bare) if probability is None else message(with_probability, probability=probability)


def _named(found: Diagnosis, name: str) -> Message:
    """An effect or its group, with its strength and its probability."""
    probability = _probability(found, name)
    if probability is None:
        return _strong(found, name)
    names = _names(found, name)
    if len(names) > 1 and not has_two(_group(found, name), found.verdict.effects):
        return message("effect.one_of", names=names, probability=probability)
    strength = _strength(found, name) if len(names) == 1 else None
    if strength is None:
        return message("effect.probable", names=names, probability=probability)
    return message("effect.strength_probable", names=names, strength=strength, probability=probability)


def _strong(found: Diagnosis, name: str) -> Message:
    """An effect or its group, with its strength."""
    names = _names(found, name)
    strength = _strength(found, name) if len(names) == 1 else None
    return (
        message("effect", names=names)
        if strength is None
        else message("effect.strength", names=names, strength=strength)
    )


def _names(found: Diagnosis, name: str) -> list[str]:
    """The titles of an effect and of the others of its group that are not named themselves."""
    others = (other for other in _group(found, name) if other != name and other not in found.verdict.effects)
    return [title(name), *map(title, others)]


def _strength(found: Diagnosis, name: str) -> tuple[float, float, str] | None:
    """The strength on the last step, its standard error and unit; None where it is not known."""
    last = found.confirmed_ladder[-1].parameters if found.ladder else {}
    strength = next((p for parameter, p in last.items() if parameter.startswith(f"{name}.")), None)
    if strength is None or strength.std_error is None:
        return None
    return strength.value, strength.std_error, strength.unit


def _error(found: Diagnosis) -> Message:
    """The error on the first use of :data:`_USES` that has one, before and after, and the noise floor."""
    steps = found.confirmed_ladder or (found.baseline,)
    use = next((use for use in _USES if steps[0].error.get(use) is not None), _USES[-1])
    before, after = (step.error.get(use) for step in (steps[0], steps[-1]))
    floor = found.noise_floor.get(use) or found.noise_floor.get("fit")
    if before is None:
        return message("summary.error_unknown")
    if not found.verdict.effects or len(steps) == 1:
        if floor is None:
            return message("summary.error_floor_unknown", use=use, before=before)
        return message("summary.error", use=use, before=before, floor=floor)
    if floor is None:
        return message("summary.change_floor_unknown", use=use, before=before, after=after)
    return message("summary.change", use=use, before=before, after=after, floor=floor)


def next_step(found: Diagnosis) -> Message:
    """The next step."""
    verdict = found.verdict
    if found.lacks_input:
        return message("next.input")
    if found.oscillates:
        return message("next.oscillation", runs=[run_name(str(swing["run"])) for swing in found.oscillation])
    if verdict.suspects:
        return _correct(verdict.suspects[0], verdict.effects)
    if not found.complete:
        return message("next.time")
    if verdict.standing == "contradicted":
        return message("next.compare", effect=verdict.contradicted_by[0])
    if _by_chance(found):
        return message("next.then", then=_then(found))
    if verdict.indistinguishable and found.next_experiment is not None:
        return message("next.distinguish", group=verdict.indistinguishable[0])
    if verdict.unexplained and found.max_effects and len(verdict.effects) >= found.max_effects:
        return message("next.more", most=2 * found.max_effects)
    if verdict.unexplained and verdict.effects:
        return message("next.add_and", effects=verdict.effects, then=_then(found))
    if verdict.unexplained:
        return message("next.then", then=_then(found))
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


def _then(found: Diagnosis) -> list[Message]:
    """The ways to find further effects: the proposed terms and the next run, else the search that was not made."""
    terms = [message("then.terms")] if found.proposals else []
    run = [message("then.run")] if found.next_experiment is not None else []
    return [*terms, *run] or [message("then.search")]
