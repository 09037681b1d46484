"""`servoident regress`: recheck approved actuators, here or over the workers of a service."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.data_options import Data, Database, settings
from app.cli.nearest_names import tell_nearest
from app.cli.output import check_target, write_bytes
from app.cli.progress import shown
from app.cli.remote import Token, request
from ident.errors import Unusable

_LOOK = 1.0  # s between two looks at a regression that runs elsewhere


def regress(
    serial: Annotated[str | None, typer.Option(help="Serial number. Default: all.")] = None,
    batch: Annotated[str | None, typer.Option(help="Batch. Default: all.")] = None,
    model: Annotated[str | None, typer.Option(help="Model. Default: all.")] = None,
    data: Data = None,
    database: Database = "",
    server: Annotated[
        str | None, typer.Option(metavar="URL", help="Run on the workers of this service instead of locally.")
    ] = None,
    token: Token = "",
    tolerance: Annotated[float, typer.Option(help="Largest relative change of an error or a parameter.")] = 1e-3,
    junit: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write the outcome as JUnit XML for a build server.")
    ] = None,
) -> None:
    """Recheck approved actuators.

    Exit status 1 if an error or a parameter moved. It recomputes the stored error, repeats the fit from scratch with
    the stored settings, and compares both with the approved set. A parameter moved if it changed by more than the
    tolerance and by more than a tenth of its standard error.
    """
    check_target(junit)
    if not 0 <= tolerance < math.inf:
        raise Unusable("bad-number", f"{tolerance:g} is not a tolerance", "--tolerance", "give 0 or a number above")
    asked = {"serial": serial, "batch": batch, "model": model}
    if server is None:
        rows = _here(data, database, asked, tolerance, junit)
    else:
        rows = _there(server, token, {**asked, "tolerance": tolerance}, junit)
    if not rows:
        from ident.presets import PRESETS

        tell_nearest({"model": model}, lambda _: PRESETS)
    show(rows)
    if any(outcome != "same" for _, outcome, _ in rows):
        raise typer.Exit(1)


Row = tuple[str, str, str]
"""Serial number, outcome, what is told of it."""


def _here(
    data: Path | None, database: str, asked: dict[str, str | None], tolerance: float, junit: Path | None
) -> list[Row]:
    """One after the other, in this process."""
    from app.regress.junit import junit as as_junit
    from app.regress.repository import Asked
    from app.regress.service import regress as rechecks_of
    from app.regress.words import as_view, told

    with shown() as report:
        rechecks = list(rechecks_of(settings(data, database), Asked(**asked), tolerance, report))
    if junit is not None:
        write_bytes(as_junit(rechecks), junit)
    return [(one.serial, one.outcome, told(one)) for one in map(as_view, rechecks)]


def _there(server: str, token: str, asked: dict[str, Any], junit: Path | None) -> list[Row]:
    """A job an actuator, over all workers of a service."""
    from app.regress import words
    from schemas.regression import RegressionView

    body = {name: value for name, value in asked.items() if value is not None}
    found = RegressionView(**request(server, token, "POST", "/regressions", json=body).json())
    at = f"/regressions/{found.id}"
    while found.state == "running":
        time.sleep(_LOOK)
        found = RegressionView(**request(server, token, "GET", at).json())
    if junit is not None:
        write_bytes(request(server, token, "GET", at, params={"format": "junit"}).content, junit)
    return [(one.serial, one.outcome, text) for one, _, text in words.rows(found.rechecks)]


def show(rows: list[Row]) -> None:
    """Print one line an actuator."""
    from app.cli.tables import output, table

    if not rows:
        print("no parameter set is approved yet: nothing to recheck")
        return
    output().print(table(("serial", "outcome", ""), rows, numbers=()))
