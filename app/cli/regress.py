"""`servoident regress`: recheck every approved actuator of this machine."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.data_options import Data, Database, settings
from app.cli.output import check_target, write_bytes
from app.cli.progress import shown
from ident.errors import Unusable

if TYPE_CHECKING:
    from app.regress.recheck import Recheck


def regress(
    data: Data = None,
    database: Database = "",
    tolerance: Annotated[float, typer.Option(help="Largest relative change of an error or a parameter.")] = 1e-3,
    junit: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the outcome for a build server.")] = None,
) -> None:
    """Recheck every approved actuator. Exit status 1 where an error or a parameter moved.

    The stored error is computed again, the fit is repeated with the stored settings, and both are compared with what
    was approved.
    """
    from app.regress.junit import junit as as_junit
    from app.regress.service import regress as rechecks_of

    check_target(junit)
    if not 0 <= tolerance < math.inf:
        raise Unusable("bad-number", f"{tolerance:g} is no tolerance", "--tolerance", "give 0 or a number above")
    with shown() as report:
        rechecks = list(rechecks_of(settings(data, database), tolerance, report))
    if junit is not None:
        write_bytes(as_junit(rechecks), junit)
    show(rechecks)
    if not all(one.passed for one in rechecks):
        raise typer.Exit(1)


def show(rechecks: list[Recheck]) -> None:
    """Print one line an actuator."""
    from app.cli.tables import output, table

    if not rechecks:
        print("no parameter set is approved yet: nothing to recheck")
        return
    rows = [(one.serial, "same" if one.passed else "failed" if one.failure else "moved", told(one)) for one in rechecks]
    output().print(table(("serial", "outcome", ""), rows, numbers=()))


def told(one: Recheck) -> str:
    """What moved, or the largest change."""
    if one.failure:
        return one.failure
    if one.moved:
        return "; ".join(f"{c.quantity} {c.before:.5g} → {c.after:.5g}" for c in one.moved)
    largest = one.largest
    return f"largest change {largest.relative:.1e} ({largest.quantity})" if largest else ""
