"""The pipeline: the steps in their order, applied to a matrix and a model before anything is fitted."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from ident.errors import Unusable
from ident.matrix import APPLIED, NOT_NEEDED, OFF, Matrix, StepOutcome, StepState
from ident.preprocessing.command_offset import COMMAND_OFFSET
from ident.preprocessing.force_sign import FORCE_SIGN
from ident.preprocessing.initial_state import INITIAL_STATE
from ident.preprocessing.run_exclusion import RUN_EXCLUSION
from ident.preprocessing.step import Prepared, Step
from ident.preprocessing.stroke_centre import STROKE_CENTRE
from ident.presets.preset import Preset
from ident.words.nearest import did_you_mean

STEPS: tuple[Step, ...] = (RUN_EXCLUSION, FORCE_SIGN, COMMAND_OFFSET, STROKE_CENTRE, INITIAL_STATE)
"""Every step, in the order in which they are applied: each sees the data as the ones before it left them."""
NAMES = tuple(step.name for step in STEPS)
Switches = Mapping[str, bool]
"""Steps by name: false switches one off. A step that is not named is on."""
ALL_ON: Switches = {}


def off_steps(given: Switches) -> dict[str, bool]:
    """The steps that are switched off, each with false, in the order of the pipeline.

    Raises Unusable for a name that no step has, and for what is neither true nor false.
    """
    for name, on in given.items():
        if name not in NAMES:
            raise Unusable(
                "unknown-step", f"no step {name!r} of preprocessing", "preprocessing", did_you_mean(name, NAMES)
            )
        if not isinstance(on, bool):
            raise Unusable("bad-option", f"{name} is {on!r}", "preprocessing", "give true or false")
    return {name: False for name in NAMES if not given.get(name, True)}


def screen(matrix: Matrix, switches: Switches = ALL_ON) -> Matrix:
    """The matrix after the steps that need no model; as it is where they were applied before. Raises Unusable."""
    steps = [step for step in STEPS if not step.needs_model and step.name not in _done(matrix)]
    return _applied(steps, Prepared(matrix), off_steps(switches)).matrix


def prepare(preset: Preset, matrix: Matrix, load: str = "none", switches: Switches = ALL_ON) -> tuple[Preset, Matrix]:
    """The model as it suits a matrix, and the matrix as the model is fitted to it, after every step.

    `load` "force": the measured force takes the place of the specimen's equation. A matrix that was prepared for
    another model before may be given. Raises Unusable where the model does not suit the matrix, the force was not
    measured or the model has no specimen, and for an unknown step.
    """
    suited, driven = preset.for_matrix(screen(matrix, switches), load)
    steps = [step for step in STEPS if step.needs_model]
    prepared = _applied(steps, Prepared(driven, suited), off_steps(switches))
    model = prepared.model.with_measured_load(prepared.matrix) if load == "force" else prepared.model
    return model, prepared.matrix


def _applied(steps: Iterable[Step], prepared: Prepared, off: Switches) -> Prepared:
    """The matrix and the model after some steps, with the outcome of each and the notices of those that are noted."""
    for step in steps:
        told: tuple[str, ...] = (off_said(step),)
        if step.name in off:
            prepared, state = step.off(prepared), OFF
        else:
            prepared, told = step.act(prepared)
            state = APPLIED if told else NOT_NEEDED
        prepared = replace(prepared, matrix=_with(prepared.matrix, step, state, told))
    return prepared


def _with(matrix: Matrix, step: Step, state: StepState, told: tuple[str, ...]) -> Matrix:
    """The matrix with the outcome of a step; what an earlier pass over the same data said of it stays."""
    known = {one.step: one for one in matrix.preprocessing}
    if state != NOT_NEEDED or step.name not in known:
        known[step.name] = StepOutcome(step.name, state, " ".join(told))
    new = tuple(one for one in told if one not in matrix.notices) if step.noted or state == OFF else ()
    notices = (*new, *matrix.notices) if step.needs_model else (*matrix.notices, *new)
    return replace(matrix, preprocessing=tuple(known.values()), notices=notices)


def _done(matrix: Matrix) -> set[str]:
    return {one.step for one in matrix.preprocessing}


def off_said(step: Step) -> str:
    """What is said of a step that is switched off."""
    return f"The step {step.name} of preprocessing is switched off: {step.without}."


def outcome_sentences(outcomes: Sequence[StepOutcome], notes: Sequence[str] = ()) -> Iterator[str]:
    """A sentence or more for each step that changed something or is switched off, where the notes do not have it."""
    noted = " ".join(notes)
    for outcome in outcomes:
        if outcome.told and outcome.told not in noted:
            yield outcome.told
