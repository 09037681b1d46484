"""`--no-NAME`: the options that switch a step of preprocessing off, for every command that fits or diagnoses."""

from __future__ import annotations

from typing import Annotated

import typer

NoRunExclusion = Annotated[
    bool, typer.Option("--no-run-exclusion", help="Keep runs that do not respond to their command.")
]
NoForceSign = Annotated[
    bool,
    typer.Option(
        "--no-force-sign", help="Do not correct the sign of a force, or of a motion that seems to go against its force."
    ),
]
NoCommandOffset = Annotated[
    bool, typer.Option("--no-command-offset", help="Do not subtract the neutral offset of the command.")
]
NoStrokeCentre = Annotated[
    bool, typer.Option("--no-stroke-centre", help="Do not move the position origin to the centre of the stroke.")
]
NoInitialState = Annotated[
    bool, typer.Option("--no-initial-state", help="Assume that every run starts at rest at zero.")
]


def switches(**no: bool) -> dict[str, bool]:
    """What is given for `no_NAME`, as the library and the service take it: false for each step that is switched off."""
    return {name.removeprefix("no_"): False for name, given in no.items() if given}
