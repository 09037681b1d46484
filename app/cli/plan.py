"""`servoident plan`: command files of a program of runs for a rig, kept inside its limits."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.input_files import read_fit
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.progress import shown
from app.cli.rig_option import RigFile, rig_in
from app.cli.spread_option import stated_spread


def plan(
    program: Annotated[
        str, typer.Option(metavar="NAME|FILE", help="qian, kononykhin, or a YAML file with your own lists.")
    ],
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for commands/, matrix.yaml and plan.json.")],
    fit: Annotated[
        Path | None,
        typer.Option(
            metavar="FIT.json", help="File from `servoident fit --json`; the fitted model predicts the peaks."
        ),
    ] = None,
    rig: RigFile = None,
    format_: Annotated[
        list[str] | None,
        typer.Option("--format", metavar="csv|mat|tdms", help="Format of the command files; may be repeated."),
    ] = None,
    seconds: Annotated[float | None, typer.Option(help="Length of each run in s; default: 30.")] = None,
    ramp: Annotated[
        float | None,
        typer.Option(help="Time in s of fade-in and of fade-out of each command. Default: 2 % of the run."),
    ] = None,
    spread: Annotated[
        list[str] | None,
        typer.Option(metavar="SHARE|NAME=SHARE", help="Uncertainty of the parameters. Default: 20 %. May be repeated."),
    ] = None,
    least: Annotated[
        float, typer.Option(help="Smallest share of its amplitude to which a run is scaled; with 1 no run is scaled.")
    ] = 0.1,
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Seed of the commands.")] = 0,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the plan as JSON; - is stdout.")] = None,
) -> None:
    """Plan the runs of a test program for a rig.

    It writes the command files, and a matrix.yaml for the measured records. Each command is checked against the limits
    of the rig, and scaled to stay inside them. Exit status 1 if a run is refused.
    """
    from app.cli.tables import show
    from ident.planning.plan import plan as planned

    check_target(json)
    result, limits, wide = None if fit is None else read_fit(fit), rig_in(rig), stated_spread(spread or [])
    with shown() as report:
        made = planned(program, result, limits, seconds, ramp, seed, wide, least, report)
        made.write(out, tuple(format_ or ("csv",)), report)
    if json is not None:
        write_json(made.to_json(), json)
    if json != STANDARD_OUTPUT:
        show(made.listings())
        print(
            f"wrote {out / 'matrix.yaml'} and commands of {len(made.runs)} runs; put what is measured at {out / 'runs'}"
        )
    if made.refused:
        raise typer.Exit(1)
