"""`servoident compare`: a fitted model against a matrix, in figures and a table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.given import read_fit
from app.cli.output import STANDARD_OUTPUT, check_target, write_bytes, write_json
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.fit.result import FitResult
    from ident.matrix import Matrix

FORMATS = ("svg", "png", "pdf", "json")


def compare(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Folder, its matrix.yaml, or a .zip.")],
    fit: Annotated[Path, typer.Option(metavar="FIT.json", help="What `servoident fit --json` wrote.")],
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the errors as JSON; - is stdout.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figures: svg, png, pdf, json.")] = None,
    candidate: Annotated[
        Path | None, typer.Option(metavar="FIT.json", help="A second fit, drawn over the curves of the residual.")
    ] = None,
) -> None:
    """Compare a fitted model with every run of a matrix: error, where it fails, and what the error is made of."""
    from app.cli.survey_tables import show_survey
    from ident.readers import read_matrix
    from ident.residuals.survey import survey
    from ident.workflows import compare as compared

    check_target(json)
    result, other = read_fit(fit), None if candidate is None else read_fit(candidate)
    read = read_matrix(matrix)
    comparison = compared(read, result)
    found = survey(comparison)
    rows = [(run.run.id, run.run.use, run.error, run.offset) for run in comparison.runs]
    if json is not None:
        runs = [dict(zip(("id", "use", "error", "offset"), row, strict=True)) for row in rows]
        means = {"error": dict(comparison.error), "offset": dict(comparison.offset)}
        write_json({**means, "runs": runs, **found.to_json()}, json)
    if json != STANDARD_OUTPUT:
        show(rows, comparison.error)
        show_survey(found)
    if out is not None:
        draw(read, result, out, other)


def show(rows: list[tuple[str, str, float, float]], error: Any) -> None:
    """Print the error of every run and the means."""
    from app.cli.tables import output, table
    from ident.words.percent import percent

    lines = [(name, use, percent(of_run), percent(offset)) for name, use, of_run, offset in rows]
    lines += [("mean", use, percent(mean), "") for use, mean in error.items() if mean is not None]
    output().print(table(("run", "use", "error", "offset"), lines, numbers=("error", "offset")))


def draw(matrix: Matrix, fit: FitResult, out: Path, candidate: FitResult | None = None) -> None:
    """Write every figure in every format to the folder `out`; curves also as `candidate` predicts them."""
    from ident.figures import figures_of, render
    from ident.workflows import figure

    out.mkdir(parents=True, exist_ok=True)
    drawn = []
    for name in figures_of(fit):
        options: dict[str, Any] = {"candidate": candidate} if name == "residual-curve" and candidate is not None else {}
        try:
            chart = figure(name, matrix, fit, **options)
        except Unusable as error:
            if error.code != "unstable-model":
                raise
            print(f"{name} cannot be drawn: {error.what}")
            continue
        for format_ in FORMATS:
            write_bytes(render(chart, format_), out / f"{name}.{format_}")
        drawn.append(name)
    print(f"wrote {', '.join(drawn)} to {out}")
