"""`servoident effects`: the effects of the catalogue and those of one's own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import Token, items, request
from ident.errors import Unusable

Where = Annotated[
    str, typer.Option("--server", metavar="URL", help="Use the own effects of this service instead of the local ones.")
]


def effects(
    context: typer.Context,
    server: Where = "",
    token: Token = "",
    signals: Annotated[
        str, typer.Option("--signals", metavar="MODEL", help="List the signals that an equation can use instead.")
    ] = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the lists as JSON; - is stdout.")] = None,
) -> None:
    """List your own effects and those of the library.

    Own effects are in the folder `effects` of your data folder (SERVOIDENT_DATA), or on a service.
    """
    if context.invoked_subcommand is not None:
        if server or signals or json is not None:
            raise Unusable("bad-option", f"an option is before the command {context.invoked_subcommand}", "effects",
                           "write options after it")  # fmt: skip
        return
    check_target(json)
    if signals:
        list_signals(signals, json)
        return
    found = _of_service(server, token) if server else _here()
    if json is not None:
        write_json(found, json)
    if json != STANDARD_OUTPUT:
        show(found)


def _here() -> dict[str, Any]:
    from app.catalogue.service import effects as catalogue
    from app.cli.kept_here import every
    from app.own_effects.kept import view

    own = [view(kept).model_dump(by_alias=True) for kept in every()]
    return {"own": own, "catalogue": [effect.model_dump() for effect in catalogue()]}


def _of_service(server: str, token: str) -> dict[str, Any]:
    own = list(items(server, token, "/own-effects", {}))
    return {"own": own, "catalogue": request(server, token, "GET", "/effects").json()}


def show(found: dict[str, Any]) -> None:
    """Print both lists as tables."""
    from app.cli.tables import output, table

    console = output()
    if found["own"]:
        header = ("own effect", "place", "equation", "meaning", "origin", "model")
        console.print(table(header, own_rows(found["own"]), numbers=()))
    else:
        console.print("no own effects yet; save one by: servoident effects keep EFFECT.yaml", markup=False)
    rows = ((one["name"], one["place"], equations(one), one["meaning"]) for one in found["catalogue"])
    console.print(table(("effect library", "place", "equation", "meaning"), rows, numbers=()))


def list_signals(model: str, json: Path | None) -> None:
    """Print the signals of a model as a table, or write them. Raises Unusable for an unknown model."""
    from app.catalogue.service import signals
    from app.cli.tables import output, table
    from ident.presets import preset

    found = signals(preset(model))
    if json is not None:
        write_json([one.model_dump() for one in found], json)
    if json != STANDARD_OUTPUT:
        header = ("signal", "unit", "place", "meaning", "without effects", "changed by")
        rows = ((one.name, one.unit, one.place, one.meaning, one.equation, ", ".join(one.changed_by)) for one in found)
        output().print(table(header, rows, numbers=()))


def own_rows(own: list[dict[str, Any]]) -> Iterator[tuple[str, ...]]:
    """One row an own effect; of one that this version cannot read, why."""
    for one in own:
        said = one["refused"] or equations(one)
        yield one["name"], one["place"], said, one["meaning"], one["origin"], one["model"] or "any"


def equations(one: dict[str, Any]) -> str:
    """The lines of an effect in one."""
    return "; ".join(str(line["text"]) for line in one["equations"])
