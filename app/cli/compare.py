"""`servoident compare`: a fitted model against a matrix, in figures and a table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.figure_files import write_figure
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
        draw(read, result, out, other)


def draw(matrix: Matrix, fit: FitResult, out: Path, candidate: FitResult | None = None) -> None:
    """Write every figure in every format to the folder `out`; curves also as `candidate` predicts them."""
    from ident.figures import figures_of
    from ident.workflows import study

    out.mkdir(parents=True, exist_ok=True)
    drawn, studied = [], study(matrix, fit)
    for name in figures_of(fit):
        options: dict[str, Any] = {"candidate": candidate} if name == "residual-curve" and candidate is not None else {}
        try:
            write_figure(studied, name, out, **options)
        except Unusable as error:
            if error.code != "unstable-model":
                raise
            print(f"{name} cannot be drawn: {error.what}")
            continue
        drawn.append(name)
    print(f"wrote {', '.join(drawn)} to {out}")
