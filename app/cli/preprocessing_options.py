"""`--no-NAME`: the options that switch a step of preprocessing off, for every command that fits or diagnoses."""

from __future__ import annotations

from typing import Annotated

import typer

NoRunExclusion = Annotated[
    bool, typer.Option("--no-run-exclusion", help="Fit or verify runs that do not respond to their command, too.")
]
NoForceSign = Annotated[
    bool, typer.Option("--no-force-sign", help="Take a force as recorded where the specimen would give work back.")
]
NoCommandOffset = Annotated[
    bool, typer.Option("--no-command-offset", help="Take the command as recorded where the machine has a neutral.")
]
NoStrokeCentre = Annotated[
    bool, typer.Option("--no-stroke-centre", help="Let effects of position act about the transducer's zero.")
]
NoInitialState = Annotated[bool, typer.Option("--no-initial-state", help="Take every run to begin at rest at zero.")]


def switches(**no: bool) -> dict[str, bool]:
    """What is given for `no_NAME`, as the library and the service take it: false for each step that is switched off."""
    return {name.removeprefix("no_"): False for name, given in no.items() if given}
