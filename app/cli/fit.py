"""`servoident fit`: identify the parameters of a model from a matrix."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from app.cli.fit_options import (
    Bounds,
    Custom,
    Effects,
    Load,
    MatrixPath,
    Method,
    Model,
    Options,
    Seed,
    Values,
    modelled,
    settings,
)
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.progress import shown


def fit(
    matrix: MatrixPath,
    model: Model = None,
    effect: Effects = None,
    custom: Custom = None,
    method: Method = "ga",
    bounds: Bounds = None,
    set_: Values = None,
    load: Load = "none",
    seed: Seed = 0,
    option: Options = None,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the fit as JSON; - is stdout.")] = None,
) -> None:
    """Identify the parameters of a model. With standard errors, and the error on runs that no fit saw."""
    from ident.readers import read_matrix
    from ident.workflows import identify

    check_target(json)
    with shown() as report:
        named, choice = modelled(read_matrix(matrix), model, report)
        chosen = settings(named, effect, method, bounds, set_, load, seed, option, custom)
        result = choice.made(chosen) or identify(choice.matrix, chosen, report)
        result = replace(result, structures=choice.structures)
    if json is not None:
        write_json(result.to_json(), json)
    if json != STANDARD_OUTPUT:
        from app.cli.tables import show_fit

        show_fit(result)
