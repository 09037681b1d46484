"""`servoident query`: the parameter sets of a production line."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import islice
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.arguments import split
from app.cli.output import STANDARD_OUTPUT, write_bytes, write_json
from app.cli.remote import DEFAULT, Server, Token, items, request

LISTED = "/parameter-sets"
_MOST = 1000  # actuators whose names are looked at


def query(
    serial: Annotated[str | None, typer.Option(help="Serial number.")] = None,
    batch: Annotated[str | None, typer.Option(help="Batch.")] = None,
    model: Annotated[str | None, typer.Option(help="Model.")] = None,
    range_: Annotated[
        list[str] | None,
        typer.Option("--range", metavar="NAME=MIN:MAX", help="Range of a parameter in SI; may be repeated."),
    ] = None,
    approved_after: Annotated[str | None, typer.Option(metavar="DATE", help="Approved after, ISO 8601.")] = None,
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the sets as JSON; - is stdout.")] = None,
    csv: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the sets as CSV; - is stdout.")] = None,
) -> None:
    """List parameter sets.

    Select by serial number, batch, model, date, and range of any parameter.
    """
    given = {"serial": serial, "batch": batch, "model": model, "approved_after": approved_after}
    params = {name: value for name, value in given.items() if value is not None} | limits(range_ or [])
    if csv is not None:
        content = request(server, token, "GET", LISTED, params=params | {"format": "csv"}).content
        if csv == STANDARD_OUTPUT:
            print(content.decode(), end="")
        else:
            write_bytes(content, csv)
        return
    sets = list(items(server, token, LISTED, params))
    if not sets:
        _tell_nearest(given, range_ or [], server, token)
    if json is not None:
        write_json(sets, json)
    if json != STANDARD_OUTPUT:
        show(sets)


def _tell_nearest(given: dict[str, str | None], ranges: list[str], server: str, token: str) -> None:
    """Say which known name is nearest to one that was asked for: of a model, of a parameter, of an actuator."""
    from app.cli.nearest_names import tell_nearest
    from ident.presets import PRESETS, parameter_names

    def known(where: str) -> Iterable[str]:
        if where in ("serial", "batch"):
            return (str(one[where]) for one in islice(items(server, token, "/actuators", {}), _MOST))
        return PRESETS if where == "model" else parameter_names()

    named = {where: given[where] for where in ("model", "serial", "batch")}
    tell_nearest(named, known)
    for text in ranges:
        tell_nearest({"parameter": split(text, "--range", "NAME=MIN:MAX")[0]}, known)


def limits(texts: list[str]) -> dict[str, str]:
    """`NAME=MIN:MAX` as the query's NAME.min and NAME.max; either side may be empty."""
    found: dict[str, str] = {}
    for text in texts:
        name, value = split(text, "--range", "NAME=MIN:MAX")
        lower, _, upper = value.partition(":")
        found |= {f"{name}.{side}": limit.strip() for side, limit in (("min", lower), ("max", upper)) if limit.strip()}
    return found


def show(sets: list[dict[str, Any]]) -> None:
    """Print the sets as a table."""
    from app.cli.tables import output, table
    from app.parameters.error import error_of
    from ident.words.engineering import quantity
    from schemas.parameters import ParameterSetView

    header = ("serial", "fit", "model", "approved", "current", "error fit", "verify", "parameters")
    rows = []
    for one in sets:
        parameters = ", ".join(
            f"{name} {quantity(entry['value'], entry['unit'])}" for name, entry in one["parameters"].items()
        )
        approved = (one["approved_at"] or "–")[:10]
        said = ParameterSetView.model_validate(one)
        errors = (error_of(said, "fit").said(), error_of(said, "verify").said())
        rows.append(
            (one["serial"], one["id"], one["model"], approved, "yes" if one["current"] else "", *errors, parameters)
        )
    output().print(table(header, rows, numbers=("error fit", "verify")))
