"""`servoident compare`: a fitted model against a matrix, in figures and a table."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.figure_files import draw_study, given_options, study_figures
from app.cli.input_files import read_fit
from app.cli.output import STANDARD_OUTPUT, check_target, write_json


def compare(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    fit: Annotated[
        list[Path],
        typer.Option(
            metavar="FIT.json", help="File from `servoident fit --json`; several give one table, and one figure of all."
        ),
    ],
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the errors as JSON; - is stdout.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figures: svg, png, pdf, json.")] = None,
    candidate: Annotated[
        Path | None, typer.Option(metavar="FIT.json", help="A second fit, drawn over the residual curves.")
    ] = None,
    figure: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Write only this figure; may be repeated.")
    ] = None,
    option: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=VALUE", help="Option of the figures that take it: run=r1, theme=dark; repeatable."),
    ] = None,
) -> None:
    """Compare a fitted model with every run of a data set.

    It shows the errors, where the model fails, and the error budget.
    """
    from app.cli.tables import show
    from ident.readers import read_matrix
    from ident.residuals.survey import survey
    from ident.workflows import compare as compared

    check_target(json)
    if len(fit) > 1:
        from app.cli.compare_several import compare_several

        of_all = figure or (), given_options(option or ())
        compare_several(read_matrix(matrix), [read_fit(one) for one in fit], json, out, *of_all)
        return
    result, other = read_fit(fit[0]), None if candidate is None else read_fit(candidate)
    read, chosen = read_matrix(matrix), given_options(option or ()) | ({} if other is None else {"candidate": other})
    asked = None if out is None else study_figures(read, result, figure or (), chosen)
    comparison = compared(read, result)
    found = survey(comparison)
    if json is not None:
        names = ("error", "offset", "error_with_mean", "fit_percent", "rmse")
        means = {name: dict(getattr(comparison, name)) for name in names}
        write_json({**means, "runs": comparison.records(), **found.to_json()}, json)
    if json != STANDARD_OUTPUT:
        show((*comparison.listings(), *found.listings()))
    if out is not None and asked is not None:
        draw_study(*asked, out)
