"""`servoident diagnose`: what a fitted model lacks, which labels are doubted, and whether the residual is explained."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.fit_options import (
    Bounds,
    Effects,
    Load,
    MatrixPath,
    Method,
    Model,
    Options,
    Ranked,
    Seed,
    Values,
    modelled,
    settings,
)
from app.cli.input_files import read_fit
from app.cli.last_diagnosis import LAST, keep
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.preprocessing_options import (
    NoCommandOffset,
    NoForceSign,
    NoInitialState,
    NoRunExclusion,
    NoStrokeCentre,
    switches,
)
from app.cli.progress import shown
from ident.errors import Cancelled, TimeIsUp, Unusable

if TYPE_CHECKING:
    from ident.diagnosis.result import Diagnosis
    from ident.fit.result import FitResult


Limit = Annotated[
    float | None,
    typer.Option(
        metavar="S",
        help="Time limit in s. The search then stops with the results so far, and lists what it did not search.",
    ),
]
Most = Annotated[int | None, typer.Option(min=0, metavar="N", help="Largest number of effects to add.")]
Own = Annotated[bool, typer.Option("--own", help="Also rank your saved own effects.")]
Proposes = Annotated[
    bool | None,
    typer.Option(
        "--propose/--no-propose",
        help="Search for unknown equation terms. Default: only if no effect in the library explains the error.",
        show_default=False,
    ),
]
Target = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Write the diagnosis as JSON, updated after each step; - is stdout."),
]


def diagnose(
    matrix: MatrixPath,
    fit: Annotated[
        Path | None, typer.Option(metavar="FIT.json", help="File from `servoident fit --json`. Default: make a fit.")
    ] = None,
    model: Model = None,
    effect: Effects = None,
    custom: Ranked = None,
    own: Own = False,
    method: Method = "ga",
    bounds: Bounds = None,
    set_: Values = None,
    load: Load = "none",
    option: Options = None,
    max_effects: Most = None,
    propose: Proposes = None,
    seed: Seed = 0,
    time: Limit = None,
    no_run_exclusion: NoRunExclusion = False,
    no_force_sign: NoForceSign = False,
    no_command_offset: NoCommandOffset = False,
    no_stroke_centre: NoStrokeCentre = False,
    no_initial_state: NoInitialState = False,
    json: Target = None,
) -> None:
    """Find effects that the model is missing.

    The search ranks effects by their held-out error, and adds them while the error falls.
    """
    from app.cli.arguments import definitions
    from app.cli.local_effects import beside
    from ident.custom.definition import read_effect, together
    from ident.diagnosis.criteria import CRITERIA
    from ident.diagnosis.unfitted import unfitted
    from ident.fit.parameter_bounds import with_candidates_given
    from ident.fit.settings import Settings
    from ident.readers import read_matrix
    from ident.time_budget import TimeBudget
    from ident.workflows import diagnose as diagnosed

    check_target(json)
    off = switches(
        no_run_exclusion=no_run_exclusion, no_force_sign=no_force_sign, no_command_offset=no_command_offset,
        no_stroke_centre=no_stroke_centre, no_initial_state=no_initial_state,
    )  # fmt: skip
    budget = TimeBudget(time)
    records = read_matrix(matrix)
    given = None if fit is None else given_fit(fit, any((model, effect, option, method != "ga", load != "none", off)))
    try:
        with shown() as report, budget.running():
            named, choice = modelled(records, model if given is None else given.model, report, off)
    except TimeIsUp:
        _tell(
            unfitted(records, replace(Settings(), model="", seed=seed, preprocessing=off), budget.taken), matrix, json,
            time,
        )  # fmt: skip
        return
    chosen = settings(named, effect, method, bounds, set_, load, seed, option, preprocessing=off, candidates=True)
    given = choice.made(chosen) if given is None else with_candidates_given(given, chosen.bounds, chosen.fixed)
    defined = together((), definitions(custom or []))
    if given is not None:
        named, defined = given.model, together(given.settings.get("custom", ()), defined)
    defined = beside(defined, named) if own else defined
    given = None if given is None else given.with_custom(defined)
    most = CRITERIA.selection.usual if max_effects is None else max_effects
    effects = tuple(read_effect(definition, model=named) for definition in defined)
    with shown() as report, followed(json) as follow:
        found = diagnosed(
            choice.matrix, given, replace(chosen, custom=defined), most=most, custom=effects, report=report,
            seconds=time, budget=budget, found=follow, propose=propose,
        )  # fmt: skip
    _tell(found, matrix, json, time)


def _tell(found: Diagnosis, matrix: Path, target: Path | None, seconds: float | None) -> None:
    """Keep the diagnosis, write it, and show it with the commands that come next."""
    kept = keep(found)
    if target is not None:
        write_json(found.to_json(), target)
    if target != STANDARD_OUTPUT:
        from app.cli.diagnosis_tables import show_diagnosis

        show_diagnosis(found, matrix, target or (Path(LAST) if kept else None), seconds)


@contextmanager
def followed(target: Path | None) -> Iterator[Callable[[Diagnosis], None] | None]:
    """What writes a diagnosis to a file from its first step on; work that is stopped says that it is there."""
    if target is None or target == STANDARD_OUTPUT:
        yield None
        return
    steps = 0

    def write(found: Diagnosis) -> None:
        nonlocal steps
        write_json(found.to_json(), target)
        steps += 1

    try:
        yield write
    except (KeyboardInterrupt, Cancelled):
        if not steps:
            raise
        raise Cancelled(f"{target} holds what was found until then") from None


def given_fit(path: Path, other: bool) -> FitResult:
    """The fit of a file, which brings its own settings. Raises Unusable where options of an `other` one are given."""
    if other:
        what = "a fit is given together with options for another one"
        raise Unusable("bad-option", what, "--fit", "give --fit, or --model and what belongs to it, not both")
    return read_fit(path)
