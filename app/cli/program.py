"""The program `servoident`: its commands, and the exit status of each outcome."""

from __future__ import annotations

import io
import sys
from importlib import metadata
from typing import Annotated, NoReturn

import typer

from app.cli.approve import approve
from app.cli.audit import audit
from app.cli.backup import backup, restore
from app.cli.bench import bench
from app.cli.check import check
from app.cli.compare import compare
from app.cli.control import control
from app.cli.demo import demo
from app.cli.diagnose import diagnose
from app.cli.drop import drop
from app.cli.effects import effects
from app.cli.export import export
from app.cli.failures import INTERRUPTED, UNREAD, logged, report
from app.cli.fit import fit
from app.cli.hybrid import hybrid
from app.cli.init import init
from app.cli.interrupts import heard
from app.cli.join import join
from app.cli.keep import keep
from app.cli.limits import limits
from app.cli.migrate import migrate
from app.cli.next import next_
from app.cli.profile import profile
from app.cli.query import query
from app.cli.regress import regress
from app.cli.report import report as write_report
from app.cli.retention import retention
from app.cli.revise import revise
from app.cli.serve import serve
from app.cli.simulate import simulate
from app.cli.statistics import statistics
from app.cli.tidy import tidy
from app.cli.token import token
from app.cli.token_list import list_
from app.cli.token_new import new
from app.cli.token_revoke import revoke
from app.cli.track import track
from app.cli.upload import upload
from app.cli.verdict import verdict
from app.cli.webhook import webhook
from app.cli.webhook_deliveries import deliveries
from app.cli.webhook_list import list_ as list_webhooks
from app.cli.webhook_new import new as new_webhook
from app.cli.webhook_revoke import revoke as revoke_webhook
from app.cli.whatif import whatif
from app.cli.withdraw import withdraw
from app.cli.worker import worker
from app.cli.workers import workers

LOCAL = (simulate, init, join, check, fit, compare, profile, diagnose, next_, bench, write_report, track, control,
         hybrid, whatif, export)  # fmt: skip
SERVICE = (serve, worker, demo, migrate, backup, restore, tidy, retention, regress, audit)
CLIENT = (upload, approve, withdraw, query, statistics, limits, verdict, revise, workers)

program = typer.Typer(
    name="servoident",
    help="Identify servo-hydraulic actuators from a measured test matrix, and see where the model fails.",
    epilog="Exit status: 0 done, 1 a check failed, 2 unusable input (one line on standard error says what and where).",
    rich_markup_mode=None,  # plain help: rich's takes half a second to import
)


def _version(asked: bool) -> None:
    if asked:
        print(f"servoident {metadata.version('servoident')}")
        raise typer.Exit


@program.callback()
def options(
    _: Annotated[bool, typer.Option("--version", help="Print the version.", callback=_version, is_eager=True)] = False,
) -> None:
    """What every command has in common."""


for command in (*LOCAL, *SERVICE, *CLIENT):
    program.command(command.__name__.rstrip("_"))(command)
catalogue = typer.Typer(rich_markup_mode=None)
catalogue.callback(invoke_without_command=True)(effects)
catalogue.command("keep")(keep)
catalogue.command("drop")(drop)
program.add_typer(catalogue, name="effects")
tokens = typer.Typer(rich_markup_mode=None)
tokens.callback(invoke_without_command=True)(token)
tokens.command("new")(new)
tokens.command("list")(list_)
tokens.command("revoke")(revoke)
program.add_typer(tokens, name="token")
webhooks = typer.Typer(rich_markup_mode=None)
webhooks.callback(invoke_without_command=True)(webhook)
webhooks.command("new")(new_webhook)
webhooks.command("list")(list_webhooks)
webhooks.command("revoke")(revoke_webhook)
webhooks.command("deliveries")(deliveries)
program.add_typer(webhooks, name="webhook")


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
            status = program(given or ["--help"], prog_name="servoident", standalone_mode=False)
        if status == INTERRUPTED:
            raise KeyboardInterrupt
        sys.stdout.flush()
    except SystemExit as ended:  # typer ends so, with the status of a failed check, where the reader of a pipe has gone
        sys.exit(UNREAD if isinstance(ended.__context__, BrokenPipeError) else ended.code)
    except (Exception, KeyboardInterrupt) as error:
        sys.exit(report(error))
    sys.exit(status if isinstance(status, int) else 0)
