"""`servoident limits`: what the parameters of a model have to keep to."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.arguments import number, split
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import DEFAULT, Server, Token, request, segment
from ident.errors import Unusable

FORM = '"NAME=LOWER:UPPER UNIT"'


def limits(
    model: Annotated[str, typer.Argument(metavar="MODEL", help="Name of the model.")],
    batch: Annotated[str, typer.Option(help="Batch. Default: all batches.")] = "",
    limit: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=LO:HI UNIT", help="Set the limits of a parameter; either side may be empty."),
    ] = None,
    clear: Annotated[bool, typer.Option("--clear", help="Delete all limits.")] = False,
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the limits as JSON; - is stdout.")] = None,
) -> None:
    """Show or set the limits of a model.

    They apply to one batch or to all. New limits replace the earlier ones.
    """
    check_target(json)
    at = f"/limits/{segment(model)}"
    if limit or clear:
        body = {"batch": batch, "limits": dict(read(text) for text in limit or ())}
        found = request(server, token, "PUT", at, json=body).json()
    else:
        found = request(server, token, "GET", at).json()
    if json is not None:
        write_json(found, json)
    if json != STANDARD_OUTPUT:
        show(found)


def read(text: str) -> tuple[str, dict[str, Any]]:
    """`NAME=LOWER:UPPER UNIT` as the name and the limit."""
    name, value = split(text, "--limit", FORM)
    ends, _, unit = value.partition(" ")
    lower, colon, upper = ends.partition(":")
    if not colon or not unit.strip():
        raise Unusable("bad-option", f"cannot read {text!r}", "--limit", f"write --limit {FORM}; unit 1 has none")
    both = {side: number(end, "--limit", FORM) for side, end in (("lower", lower), ("upper", upper)) if end}
    return name, {**both, "unit": unit.strip()}


def show(found: dict[str, Any]) -> None:
    """Print the limits as a table."""
    from app.cli.tables import output, table

    def shown(value: float | None) -> str:
        return "" if value is None else f"{value:.6g}"

    rows = [
        (each["batch"] or "every", name, shown(one["lower"]), shown(one["upper"]), one["unit"], one["who"])
        for each in found["batches"]
        for name, one in each["limits"].items()
    ]
    if not rows:
        print(f"no limits are set for {found['model']}")
        return
    output().print(table(("batch", "of", "lower", "upper", "unit", "set by"), rows, numbers=("lower", "upper")))
