"""`servoident fit`: identify the parameters of a model from a matrix, or from each matrix of a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.fit_options import (
    AlsoSearch,
    Bounds,
    Budget,
    Custom,
    Effects,
    Load,
    MatrixPath,
    Method,
    Model,
    Options,
    Profiled,
    Seed,
    StartFile,
    Terms,
    Values,
    modelled,
    settings,
)
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
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.comparison.profile import Profile
    from ident.fit.result import FitResult
    from ident.progress import Report


def fit(
    matrix: MatrixPath,
    start: StartFile = None,
    search: AlsoSearch = False,
    model: Model = None,
    effect: Effects = None,
    custom: Custom = None,
    terms: Terms = None,
    method: Method = "ga",
    bounds: Bounds = None,
    set_: Values = None,
    load: Load = "none",
    seed: Seed = 0,
    option: Options = None,
    budget: Budget = None,
    profile: Profiled = None,
    no_run_exclusion: NoRunExclusion = False,
    no_force_sign: NoForceSign = False,
    no_command_offset: NoCommandOffset = False,
    no_stroke_centre: NoStrokeCentre = False,
    no_initial_state: NoInitialState = False,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the fit as JSON; - is stdout.")] = None,
) -> None:
    """Identify the parameters of a model.

    It gives standard errors, and the errors on estimation and validation data. With a folder of data sets it fits each
    of them and prints one table.
    """
    from app.cli.start import Searched, StartOptions
    from ident.readers import read_matrix
    from ident.workflows import identify

    check_target(json)
    off = switches(
        no_run_exclusion=no_run_exclusion, no_force_sign=no_force_sign, no_command_offset=no_command_offset,
        no_stroke_centre=no_stroke_centre, no_initial_state=no_initial_state,
    )  # fmt: skip
    begun = None
    if start is not None:
        others = {"--model": model, "--custom": custom, "--bounds": bounds, "--set": set_, "--load": load != "none",
                  **{f"--no-{name.replace('_', '-')}": True for name in off}}  # fmt: skip
        how = Searched(method, seed, tuple(option or ()), budget)
        begun = StartOptions(start, tuple(effect or ()), terms, search, how, others)
        begun.check()
    elif search:
        raise Unusable("bad-option", "--search needs --start, which is not given", "--search", "give --start FILE.json")

    def fitted(path: Path, report: Report) -> FitResult:
        records = read_matrix(path)
        if begun is not None:
            return identify(records, begun.settings(records), report)
        named, choice = modelled(records, model, report, off)
        chosen = settings(named, effect, method, bounds, set_, load, seed, option, custom, budget, terms, off)
        result = choice.made(chosen) or identify(choice.matrix, chosen, report)
        return replace(result, structures=choice.structures)

    from app.cli.fit_folder import fit_each, matrices_in

    several = matrices_in(matrix)
    if several and profile:
        raise Unusable("bad-option", "a folder of matrices has no profile", "--profile", "name one matrix")
    if several:
        fit_each(several, fitted, json)
    else:
        _fit_one(matrix, fitted, profile or [], json)


def _fit_one(
    matrix: Path, fitted: Callable[[Path, Report], FitResult], profiled: Sequence[str], json: Path | None
) -> None:
    """The fit of one matrix, with the profiles that are asked for."""
    from ident.comparison.profile import profile
    from ident.readers import read_matrix

    with shown() as report:
        result = fitted(matrix, report)
        profiles = [profile(read_matrix(matrix), result, name, report=report) for name in profiled]
    _tell(result, profiles, json)


def _tell(result: FitResult, profiles: Sequence[Profile], json: Path | None) -> None:
    """Write the fit, its profiles beside it, and show them."""
    from app.cli.tables import show, show_fit
    from ident.plain import written

    if json is not None:
        write_json(result.to_json() | ({"profiles": written(profiles)} if profiles else {}), json)
    if json != STANDARD_OUTPUT:
        show_fit(result)
        for one in profiles:
            show(one.listings())
