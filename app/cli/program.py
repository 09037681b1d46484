"""The program `servoident`: its commands, and the exit status of each outcome."""

from __future__ import annotations

import io
import sys
from typing import NoReturn

import typer

from app.cli.approve import approve
from app.cli.bench import bench
from app.cli.check import check
from app.cli.compare import compare
from app.cli.control import control
from app.cli.demo import demo
from app.cli.diagnose import diagnose
from app.cli.drop import drop
from app.cli.effects import effects
from app.cli.failures import INTERRUPTED, UNREAD, report
from app.cli.fit import fit
from app.cli.hybrid import hybrid
from app.cli.interrupts import heard
from app.cli.keep import keep
from app.cli.migrate import migrate
from app.cli.next import next_
from app.cli.query import query
from app.cli.regress import regress
from app.cli.report import report as write_report
from app.cli.revise import revise
from app.cli.serve import serve
from app.cli.simulate import simulate
from app.cli.token import token
from app.cli.track import track
from app.cli.upload import upload
from app.cli.whatif import whatif
from app.cli.worker import worker

LOCAL = (simulate, check, fit, compare, diagnose, next_, bench, write_report, track, control, hybrid, whatif)
SERVICE = (serve, worker, demo, token, migrate, regress)
CLIENT = (upload, approve, query, revise)

program = typer.Typer(
    name="servoident",
    help="Identify servo-hydraulic actuators from a measured test matrix, and see where the model fails.",
    epilog="Exit status: 0 done, 1 a check failed, 2 unusable input (one line on standard error says what and where).",
    add_completion=False,
    rich_markup_mode=None,  # plain help: rich's takes half a second to import
)
for command in (*LOCAL, *SERVICE, *CLIENT):
    program.command(command.__name__.rstrip("_"))(command)
catalogue = typer.Typer(rich_markup_mode=None)
catalogue.callback(invoke_without_command=True)(effects)
catalogue.command("keep")(keep)
catalogue.command("drop")(drop)
program.add_typer(catalogue, name="effects")


def speak() -> None:
    """Results hold Greek letters and arrows: pipes and files get UTF-8, a terminal without them its own signs."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper) and stream.encoding.lower() not in ("utf-8", "utf8"):
            stream.reconfigure(encoding=stream.encoding if stream.isatty() else "utf-8", errors="replace")


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run a command and leave with its exit status; every failure is one line on standard error."""
    speak()
    try:
        given = sys.argv[1:] if arguments is None else arguments
        with heard():
            status = program(given or ["--help"], prog_name="servoident", standalone_mode=False)
        if status == INTERRUPTED:
            raise KeyboardInterrupt
        sys.stdout.flush()
    except SystemExit as ended:  # typer ends so, with the status of a failed check, where the reader of a pipe has gone
        sys.exit(UNREAD if isinstance(ended.__context__, BrokenPipeError) else ended.code)
    except (Exception, KeyboardInterrupt) as error:
        sys.exit(report(error))
    sys.exit(status if isinstance(status, int) else 0)
