"""`servoident profile`: how well parameters of a fit are known, without the curvature that standard errors assume."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.figure_files import write_figure
from app.cli.input_files import read_fit
from app.cli.output import STANDARD_OUTPUT, check_target, write_json

if TYPE_CHECKING:
    from ident.comparison.profile import Profile
    from ident.fit.result import FitResult
    from ident.matrix import Actuator


def profile(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    fit: Annotated[Path, typer.Option(metavar="FIT.json", help="File from `servoident fit --json`.")],
    parameter: Annotated[list[str], typer.Option(metavar="NAME", help="Parameter; may be repeated.")],
    points: Annotated[int, typer.Option(help="Number of values, 5 to 101.")] = 15,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the profiles as JSON; - is stdout.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figures: svg, png, pdf, json.")] = None,
) -> None:
    """Compute profile likelihoods of parameters.

    They give 95 % confidence intervals, also for estimates that are skewed or at a bound. At each value all other
    parameters are refitted. With effects each value needs a refit by simulation.
    """
    from app.cli.progress import shown
    from app.cli.tables import show
    from ident.comparison.profile import profile as profiled
    from ident.plain import written
    from ident.readers import read_matrix

    check_target(json)
    result, read = read_fit(fit), read_matrix(matrix)
    with shown() as report:
        found = [profiled(read, result, name, points, report) for name in parameter]
    if json is not None:
        write_json({"profiles": written(found)}, json)
    if json != STANDARD_OUTPUT:
        for one in found:
            show(one.listings())
    if out is not None:
        draw(found, result, read.actuator, out)


def draw(found: list[Profile], fit: FitResult, actuator: Actuator, out: Path) -> None:
    """Write a figure a parameter, in every format, to the folder `out`."""
    from ident.figures.subjects import Profiled

    for one in found:
        write_figure(Profiled(one, actuator, fit), "profile", out, f"profile-{one.parameter.replace('/', '-')}")
    print(f"wrote {', '.join(f'profile-{one.parameter}' for one in found)} to {out}")
