"""`servoident signals`: what was measured, before any fit: signals over time, spectra, coherence."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.figure_files import write_figure
from app.cli.fit_options import MatrixPath


def signals(
    matrix: MatrixPath,
    out: Annotated[Path, typer.Option(metavar="DIR", help="Write the figures: svg, png, pdf, json.")],
    run: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="Run to draw, up to eight. Default: the first. May be repeated."),
    ] = None,
    start: Annotated[float | None, typer.Option(metavar="S", help="First second to draw. Default: 0.")] = None,
    seconds: Annotated[
        float | None, typer.Option(metavar="S", help="Length to draw. Default: the whole record.")
    ] = None,
) -> None:
    """Draw the measured signals and their spectra.

    It needs no fit.
    """
    from ident.figures import Recorded
    from ident.readers import read_matrix

    read = read_matrix(matrix)
    recorded = Recorded(read.runs, read.actuator)
    write_figure(recorded, "signals", out, run=run, start=start, seconds=seconds)
    write_figure(recorded, "spectra", out, run=run)
    print(f"wrote signals, spectra to {out}")
