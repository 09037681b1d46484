"""`servoident fit`: identify the parameters of a model from a matrix."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.arguments import bounds as read_bounds
from app.cli.arguments import definitions, method_options
from app.cli.arguments import values as read_values
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.progress import shown
from ident.fit.settings import METHODS


def fit(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Folder, its matrix.yaml, or a .zip.")],
    model: Annotated[str, typer.Option(help="Model to identify.")] = "qian2014",
    effect: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Effect to add to the model; may be repeated.")
    ] = None,
    custom: Annotated[
        list[Path] | None,
        typer.Option(metavar="EFFECT.yaml", help="Own effect to add, defined in a file; may be repeated."),
    ] = None,
    method: Annotated[str, typer.Option(help=f"One of {', '.join(METHODS)}.")] = "ga",
    bounds: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=LO:HI", help="Bounds of a parameter, SI or with units; may be repeated."),
    ] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="Hold a parameter, SI or with unit; may be repeated."),
    ] = None,
    load: Annotated[str, typer.Option(help="force: drive the load by the measured force; none: do not.")] = "none",
    seed: Annotated[
        int, typer.Option(min=0, max=2**31 - 1, help="Seed of the search: the same seed gives the same result.")
    ] = 0,
    option: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="Setting of the method, such as keep=0.5; may be repeated."),
    ] = None,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the fit as JSON; - is stdout.")] = None,
) -> None:
    """Identify the parameters of a model. With standard errors, and the error on runs that no fit saw."""
    from ident.custom import preset_with
    from ident.fit.identification import identify
    from ident.fit.settings import Settings
    from ident.readers import read_matrix

    check_target(json)
    own = definitions(custom or [])
    effects = (*(effect or []), *(definition["name"] for definition in own))
    preset = preset_with(model, effects, own)
    settings = Settings(
        model=model,
        effects=effects,
        method=method,
        bounds=read_bounds(bounds or [], preset),
        fixed=read_values(set_ or [], preset),
        load=load,
        seed=seed,
        options=method_options(option or []),
        custom=own,
    )
    with shown() as report:
        result = identify(read_matrix(matrix), settings, report)
    if json is not None:
        write_json(result.to_json(), json)
    if json != STANDARD_OUTPUT:
        from app.cli.tables import show_fit

        show_fit(result)
