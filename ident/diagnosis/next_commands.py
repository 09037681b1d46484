"""The commands that a diagnosis ends with, in a sentence each: the one that its next step needs comes first."""

from __future__ import annotations

from typing import Any

from ident.diagnosis.recommended import end_of_ladder, recommended
from ident.diagnosis.result import Diagnosis
from ident.diagnosis.sentences import has_two
from ident.diagnosis.summary import next_step
from ident.words.message import Message, message, said

_NO_RUN = (
    "next.input",
    "next.oscillation",
    "next.label",
    "next.label_and",
    "next.label_value",
    "next.label_value_and",
    "next.compare",
)
"""Steps that come before any run, because they change the models in question."""
_RUN_FIRST = ("next.distinguish", "next.then")
_RUN_NAMED = (*_RUN_FIRST, "next.add_and")
"""Steps that name the proposed run; with any other it is optional."""


def next_commands(diagnosis: Diagnosis, file: str, matrix: str, seconds: float | None = None) -> tuple[str, ...]:
    """The commands of a diagnosis, in the order in which they are needed.

    `file` is the file of the diagnosis and `matrix` the folder of its data, both as a shell takes them; `seconds` is
    the time limit of the search, None where it had none.
    """
    fit, run = next_command(diagnosis, file, matrix), next_run_command(diagnosis, file, matrix)
    ordered = (run, fit) if next_step(diagnosis).key in _RUN_FIRST else (fit, run)
    first = (_again(diagnosis, matrix, seconds), _compared(diagnosis, file, matrix))
    return tuple(filter(None, (*(str(command) for command in first if command), *ordered)))


def next_command(diagnosis: Diagnosis, file: str = "D.json", matrix: str = "MATRIX") -> str:
    """The command that makes the recommended fit, in sentences; "" where a diagnosis has nothing to add.

    `file` is that of the diagnosis and `matrix` that of its data, both as a shell takes them.

    It is also "" where validation data contradict its effects, where a label is to be corrected first, or where an
    earlier version did not write the ends of its refits.
    """
    if diagnosis.verdict.suspects or not (diagnosis.proposals or end_of_ladder(diagnosis)):
        return ""
    end = recommended(diagnosis)
    if not end.added or (diagnosis.verdict.standing == "contradicted" and not end.custom):
        return ""
    values: dict[str, Any] = {"matrix": matrix, "file": file, "effects": end.added, "error": end.error.get("fit")}
    groups = [group for group in diagnosis.verdict.indistinguishable if not has_two(group, diagnosis.verdict.effects)]
    taken = next((name for name in end.added if any(name in group for group in groups)), None)
    if taken is None:
        command = message("recommended", **values)
    else:
        command = message("recommended.one_of", taken=taken, **values)
    return said([command, *([message("recommended.terms")] if end.custom else [])])


def next_run_command(diagnosis: Diagnosis, file: str = "D.json", matrix: str = "MATRIX") -> str:
    """The command that writes the proposed run, and the purpose of the run; "" where none is proposed, or not yet."""
    key, verdict = next_step(diagnosis).key, diagnosis.verdict
    if diagnosis.next_experiment is None or key in _NO_RUN:
        return ""
    if key == "next.distinguish":
        group = verdict.indistinguishable[0]
        return str(message("recommended.run_distinguishes", matrix=matrix, file=file, group=group))
    if key not in _RUN_NAMED:
        return str(message("recommended.run_optional", matrix=matrix, file=file))
    several = not verdict.effects and diagnosis.next_experiment.separation is not None
    return str(message("recommended.run_differs" if several else "recommended.run", matrix=matrix, file=file))


def _again(diagnosis: Diagnosis, matrix: str, seconds: float | None) -> Message | None:
    """The command that searches again, with twice the time or the effects; None where another step is next."""
    step = next_step(diagnosis)
    if step.key == "next.more":
        return message("recommended.more", matrix=matrix, most=step.values["most"])
    if step.key == "next.time" and seconds is not None:
        return message("recommended.time", matrix=matrix, seconds=max(round(2 * seconds), 1))
    return None


def _compared(diagnosis: Diagnosis, file: str, matrix: str) -> Message | None:
    """The commands that compare the fits with and without the effects that validation data contradict."""
    added = end_of_ladder(diagnosis)
    if next_step(diagnosis).key != "next.compare" or diagnosis.proposals or not added:
        return None
    options = [f"--model {diagnosis.model}", *(f"--effect {name}" for name in diagnosis.effects)]
    return message("recommended.compare", matrix=matrix, file=file, options=options, effects=added)
