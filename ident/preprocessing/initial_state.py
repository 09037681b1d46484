"""How each run begins, which says what of its first state a model has to find."""

from __future__ import annotations

from dataclasses import replace

from ident import beginning
from ident.preprocessing.step import Prepared, Step, Threshold
from ident.run import USES, Run
from ident.words.run_name import run_name
from ident.words.sentence import first_of

THRESHOLDS = (
    Threshold(
        beginning.LOOKED_AT,
        "s",
        "the time over which the first speed and the first value are told, by at least four samples",
        "a servo-hydraulic machine needs longer to follow a jump of its command",
    ),
    Threshold(
        beginning.SLOW,
        "of the typical speed of the record",
        "a slower output stands still",
        "of records in motion about one in a thousand passes it by chance",
    ),
    Threshold(
        beginning.AT_ZERO,
        "of the record's standard deviation",
        "an output nearer to zero is at zero",
        "what a first state of that size adds to the error is below the noise of a usual record",
    ),
    Threshold(
        beginning.ERRORS,
        "standard errors",
        "a value or a speed within them is nothing",
        "chance goes beyond four in one of sixteen thousand records",
    ),
    Threshold(
        beginning.MOST_NOISE,
        "of the record's standard deviation",
        "the most that is taken for noise",
        "differences of a record with few samples a second hold its motion too, which would excuse any beginning",
    ),
    Threshold(
        beginning.DRIVEN,
        "of the command's standard deviation",
        "a first command beyond it is a step at the first sample",
        "what follows in the output is the answer to it, not what acted before the record",
    ),
    Threshold(
        beginning.STEP_ANSWER,
        "of the record's standard deviation",
        "a record of a single step that begins nearer to zero begins at rest",
        "its deviation is that of the answer alone, so that noise is a larger share of it than of a long record",
    ),
    Threshold(
        beginning.LEAST_HELD,
        "samples",
        "a command that is held for fewer does not tell that the output stands",
        "it may be a step that has not arrived yet",
    ),
)


def _act(prepared: Prepared) -> tuple[Prepared, tuple[str, ...]]:
    """Say which runs do not begin at rest: :attr:`ident.run.Run.begins` tells it of each as its samples show."""
    if prepared.model.kind != "chain":
        return prepared, ()
    runs = [run for run in prepared.matrix.runs if run.use in USES and "command" in run.channels]
    told = [*_said(runs, "moving", "in motion"), *_said(runs, "standing", "standing away from zero")]
    return prepared, tuple(told)


def _said(runs: list[Run], how: str, words: str) -> list[str]:
    ids = [run.id for run in runs if run.begins == how]
    if not ids:
        return []
    if len(ids) == 1:
        return [f"{run_name(ids[0], begins=True)} begins {words}, not at rest: its first state is found from its data."]
    return [f"Runs {first_of(ids)} begin {words}, not at rest: their first states are found from their data."]


def _off(prepared: Prepared) -> Prepared:
    """Take every run to begin at rest."""
    runs = tuple(replace(run, assumed_beginning="at rest") for run in prepared.matrix.runs)
    return replace(prepared, matrix=replace(prepared.matrix, runs=runs))


INITIAL_STATE = Step(
    name="initial_state",
    does="finds the first state of a run from its data",
    applies="a run does not begin at rest: it stands away from zero, or what acted before the record still shows",
    without="every run is taken to begin at rest at zero",
    thresholds=THRESHOLDS,
    act=_act,
    off=_off,
    noted=False,
)
