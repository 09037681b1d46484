"""The verdict in three lines: what is missing and how sure that is, what it does to the error, what to do next."""

from __future__ import annotations

from ident.diagnosis.result import Diagnosis
from ident.words.error import error_said
from ident.words.listed import all_of
from ident.words.percent import percent
from ident.words.plus_minus import plus_minus
from ident.words.probability import probability_said
from ident.words.run_name import run_name
from ident.words.shown import in_brief
from ident.words.titles import title

_USES = (("verify", "validation data"), ("held_out", "held-out data"), ("fit", "estimation data"))


@in_brief.register
def summary(found: Diagnosis) -> tuple[str, str, str]:
    """A sentence or two each; from what is stored alone, so that a diagnosis of any version has them."""
    return _missing(found), _error(found), f"Next: {_next(found)}"


def _missing(found: Diagnosis) -> str:
    verdict = found.verdict
    if verdict.effects:
        names = all_of([_named(found, name) for name in verdict.effects])
        doubt = ", but validation data contradict it" if verdict.standing == "contradicted" else ""
        return f"Missing: {names}{doubt}."
    if not found.complete:
        return "Nothing was found so far: the search was stopped."
    if verdict.unexplained:
        return f"Missing: something that no listed effect explains{_sure(found, 'unlisted')}."
    return f"Nothing is missing{_sure(found, 'nothing')}."


def _named(found: Diagnosis, name: str) -> str:
    """An effect or its group, with its strength and its probability."""
    verdict = found.verdict
    group = next((group for group in verdict.indistinguishable if name in group), ())
    others = [title(other) for other in group if other != name and other not in verdict.effects]
    probability = dict(zip(verdict.indistinguishable, verdict.group_probabilities, strict=False)).get(group)
    probability = verdict.probabilities.get(name) if probability is None else probability
    said = [_strength(found, name)] if not others else []
    said += [] if probability is None else [f"probability {probability_said(probability)}"]
    return " or ".join([title(name), *others]) + (f" ({', '.join(filter(None, said))})" if any(said) else "")


def _strength(found: Diagnosis, name: str) -> str:
    """The strength on the last step; nothing where it was not told."""
    last = found.ladder[-1].parameters if found.ladder else {}
    strength = next((p for parameter, p in last.items() if parameter.startswith(f"{name}.")), None)
    if strength is None or strength.std_error is None:
        return ""
    return plus_minus(strength.value, strength.std_error, strength.unit)


def _sure(found: Diagnosis, what: str) -> str:
    probability = found.verdict.probabilities.get(what)
    return "" if probability is None else f" (probability {probability_said(probability)})"


def _error(found: Diagnosis) -> str:
    """The error on the data that say most, before and after, and the noise floor."""
    steps = found.ladder or (found.baseline,)
    use, data = next(((use, data) for use, data in _USES if steps[0].error.get(use) is not None), _USES[-1])
    before, after = (error_said(step.error.get(use)) for step in (steps[0], steps[-1]))
    floor = found.noise_floor.get(use) or found.noise_floor.get("fit")
    noise = "the noise floor is not known" if floor is None else f"the noise floor is {percent(floor)}"
    if not found.verdict.effects or len(steps) == 1:
        return f"The error on {data} is {before}; {noise}."
    return f"The error on {data} goes from {before} to {after}; {noise}."


def _next(found: Diagnosis) -> str:
    verdict = found.verdict
    them = "it" if len(verdict.effects) == 1 else "them"
    if verdict.suspects:
        return f"correct the label of {run_name(verdict.suspects[0].run)}, and fit again."
    if not found.complete:
        return "search again with more time."
    if verdict.standing == "contradicted":
        return f"compare the validation runs with and without {title(verdict.contradicted_by[0])}."
    if verdict.indistinguishable and found.next_experiment is not None:
        return "record the proposed run, which tells apart what these data do not."
    if verdict.unexplained:
        added = f"add {them}, and " if verdict.effects else ""
        return f"{added}look at the proposed terms, or record the proposed run."
    return f"add {them} to the model, and compare the fits." if verdict.effects else "use the model as it is."
