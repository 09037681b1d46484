"""`servoident track`: a run followed as if it came in now: time constant and gain of its loop over time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.figure_files import write_figures
from app.cli.fit_options import MatrixPath
from app.cli.output import STANDARD_OUTPUT, check_target, write_json


def track(
    matrix: MatrixPath,
    run: Annotated[str | None, typer.Option(metavar="ID", help="Run to track. Default: the first.")] = None,
    noise: Annotated[
        str | None,
        typer.Option(
            metavar="VALUE", help="Standard deviation of the sensor noise, such as 0.12 mm. Default: estimated."
        ),
    ] = None,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the track as JSON; - is stdout.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figure: svg, png, pdf, json.")] = None,
) -> None:
    """Track the time constant and gain of a first-order loop.

    A Kalman filter follows a run, and tests whether a first-order loop is valid.
    """
    from app.cli.tables import show
    from ident.hybrid.tracked_run import chosen
    from ident.hybrid.tracked_run import track as tracked
    from ident.readers import read_matrix

    check_target(json)
    read = read_matrix(matrix)
    followed = chosen(read, run)
    found = tracked(followed, _size(noise, followed.units.get(followed.output, "m")))
    if json is not None:
        write_json(found.to_json(), json)
    if json != STANDARD_OUTPUT:
        show(found.listings())
    if out is not None:
        from ident.figures.subjects import Tracked

        write_figures(Tracked(found, read.actuator), out)


def _size(noise: str | None, unit: str) -> float | None:
    from ident.units.quantity import parameter_value

    return None if noise is None else parameter_value(noise, unit, "--noise")
