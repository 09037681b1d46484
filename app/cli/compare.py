"""`servoident compare`: a fitted model against a matrix, in figures and a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.figure_files import given_options, with_options, write_figure
from app.cli.given import read_fit
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.fit.result import FitResult
    from ident.matrix import Matrix


def compare(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    fit: Annotated[
        list[Path], typer.Option(metavar="FIT.json", help="File from `servoident fit --json`; several give one table.")
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

        compare_several(read_matrix(matrix), [read_fit(one) for one in fit], json, out)
        return
    result, other = read_fit(fit[0]), None if candidate is None else read_fit(candidate)
    read = read_matrix(matrix)
    comparison = compared(read, result)
    found = survey(comparison)
    if json is not None:
        names = ("error", "offset", "error_with_mean", "fit_percent", "rmse")
        means = {name: dict(getattr(comparison, name)) for name in names}
        write_json({**means, "runs": comparison.records(), **found.to_json()}, json)
    if json != STANDARD_OUTPUT:
        show((*comparison.listings(), *found.listings()))
    if out is not None:
        chosen: dict[str, Any] = {**given_options(option or ()), **({} if other is None else {"candidate": other})}
        draw(read, result, out, figure or (), chosen)


def draw(
    matrix: Matrix, fit: FitResult, out: Path, names: Sequence[str] = (),
    options: Mapping[str, Any] = MappingProxyType({}),
) -> None:  # fmt: skip
    """Write figures in every format to the folder `out`, all or those of these names, each with the options it takes.

    Raises Unusable for a figure that the fit does not have, and for an option that none of the figures takes.
    """
    from ident.workflows import study

    drawn, studied = [], study(matrix, fit)
    for name, taken in with_options(studied, names, options).items():
        try:
            write_figure(studied, name, out, **taken)
        except Unusable as error:
            if error.code != "unstable-model":
                raise
            print(f"{name} cannot be drawn: {error.what}")
            continue
        drawn.append(name)
    print(f"wrote {', '.join(drawn)} to {out}")
