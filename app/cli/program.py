"""The program `servoident`: its commands, and the exit status of each outcome."""

from __future__ import annotations

import sys
from typing import NoReturn

import typer

from app.cli.check import check
from app.cli.compare import compare
from app.cli.failures import INTERRUPTED, report
from app.cli.fit import fit
from app.cli.simulate import simulate

COMMANDS = (simulate, check, fit, compare)

program = typer.Typer(
    name="servoident",
    help="Identify servo-hydraulic actuators from a measured test matrix, and see where the model fails.",
    epilog="Exit status: 0 done, 1 a check failed, 2 unusable input (one line on standard error says what and where).",
    add_completion=False,
    rich_markup_mode=None,  # plain help: rich's takes half a second to import
)
for command in COMMANDS:
    program.command()(command)


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run a command and leave with its exit status; every failure is one line on standard error."""
    try:
        given = sys.argv[1:] if arguments is None else arguments
        status = program(given or ["--help"], prog_name="servoident", standalone_mode=False)
        if status == INTERRUPTED:
            raise KeyboardInterrupt
    except (Exception, KeyboardInterrupt) as error:
        sys.exit(report(error))
    sys.exit(status if isinstance(status, int) else 0)
