"""The program `servoident`: its commands, and the exit status of each outcome."""

from __future__ import annotations

import io
import sys
from functools import cache
from importlib import metadata
from itertools import chain
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperGroup

from app.cli.annotate import annotate
from app.cli.approval import approve, withdraw
from app.cli.audit import audit
from app.cli.backup import backup, restore
from app.cli.bench import bench
from app.cli.check import check
from app.cli.compare import compare
from app.cli.control import control
from app.cli.delete import delete
from app.cli.demo import demo
from app.cli.diagnose import diagnose
from app.cli.effects import program as effects
from app.cli.export import export
from app.cli.failures import INTERRUPTED, UNREAD, logged, report
from app.cli.fit import fit
from app.cli.hybrid import hybrid
from app.cli.init import init
from app.cli.interrupts import heard
from app.cli.join import join
from app.cli.limits import limits
from app.cli.migrate import migrate
from app.cli.next import next_
from app.cli.plan import plan
from app.cli.profile import profile
from app.cli.query import query
from app.cli.regress import regress
from app.cli.report import report as write_report
from app.cli.retention import retention
from app.cli.revise import revise
from app.cli.search import search
from app.cli.serve import serve
from app.cli.sheet import sheet
from app.cli.signals import signals
from app.cli.simulate import simulate
from app.cli.statistics import statistics
from app.cli.tidy import tidy
from app.cli.token import program as token
from app.cli.track import track
from app.cli.upload import upload
from app.cli.verdict import verdict
from app.cli.webhook import program as webhook
from app.cli.whatif import whatif
from app.cli.worker import worker
from app.cli.workers import workers
from ident.words.display import show_in

GROUPS = {
    "Data": (simulate, init, join, check, signals),
    "Identification": (fit, compare, profile, diagnose, next_, plan, bench, write_report),
    "Applications": (track, control, hybrid, whatif, export),
    "Service": (
        serve,
        worker,
        workers,
        demo,
        upload,
        query,
        search,
        revise,
        annotate,
        delete,
        migrate,
        backup,
        restore,
        tidy,
        retention,
        audit,
    ),
    "Production line": (approve, withdraw, statistics, limits, verdict, sheet, regress),
}
"""Commands under the heading that the help lists them by."""
BELOW = {"Identification": ("effects",), "Service": ("token", "webhook")}
"""Commands that have commands of their own."""


class Grouped(TyperGroup):
    """Lists the commands by heading: forty of them in one list cannot be read."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:  # noqa: ARG002 - both of the click that typer brings
        """A section for each heading."""
        for heading, functions in GROUPS.items():
            names = [function.__name__.rstrip("_") for function in functions] + [*BELOW.get(heading, ())]
            limit = formatter.width - 6 - max(map(len, self.commands))
            with formatter.section(heading):
                formatter.write_dl([(name, self.commands[name].get_short_help_str(limit)) for name in names])


program = typer.Typer(
    name="servoident",
    cls=Grouped,
    help="Identify servo-hydraulic actuators from test data, and find effects that the model is missing.",
    epilog="Exit status: 0 done; 1 a check failed; 2 unusable input: one line says what, where, and the remedy.",
    rich_markup_mode=None,  # plain help: rich's takes half a second to import
)


def _version(asked: bool) -> None:
    if asked:
        print(f"servoident {metadata.version('servoident')}")
        raise typer.Exit


@program.callback()
def options(
    units: Annotated[
        str,
        typer.Option(
            "--units",
            metavar="UNITS",
            envvar="SERVOIDENT_UNITS",
            help="Display units of tables, figures and reports, separated by commas, such as bar,l/min,in.",
        ),
    ] = "",
    _: Annotated[bool, typer.Option("--version", help="Print the version.", callback=_version, is_eager=True)] = False,
) -> None:
    """What every command has in common."""
    show_in(unit.strip() for unit in units.split(",") if unit.strip())


for command in chain.from_iterable(GROUPS.values()):
    program.command(command.__name__.rstrip("_"))(command)
program.add_typer(effects, name="effects")
program.add_typer(token, name="token")
program.add_typer(webhook, name="webhook")


@cache
def commands() -> TyperGroup:
    """The commands with their arguments, made of all signatures once: that takes longer than many a command."""
    group = typer.main.get_command(program)
    assert isinstance(group, TyperGroup)
    return group


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
        with heard(), logged():
            status = commands()(given or ["--help"], prog_name="servoident", standalone_mode=False)
        if status == INTERRUPTED:
            raise KeyboardInterrupt
        sys.stdout.flush()
    except SystemExit as ended:  # typer ends so, with the status of a failed check, where the reader of a pipe has gone
        sys.exit(UNREAD if isinstance(ended.__context__, BrokenPipeError) else ended.code)
    except (Exception, KeyboardInterrupt) as error:
        sys.exit(report(error))
    sys.exit(status if isinstance(status, int) else 0)
