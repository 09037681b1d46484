"""`servoident effects`: the effects of the catalogue and those of one's own, which are kept and dropped here."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.remote import Token, items, request, segment
from ident.errors import Unusable
from ident.words.message import message

if TYPE_CHECKING:
    from app.own_effects.own_effect import OwnEffect

Where = Annotated[
    str, typer.Option("--server", metavar="URL", help="Use the own effects of this service instead of the local ones.")
]
program = typer.Typer(rich_markup_mode=None)


@program.callback(invoke_without_command=True)
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
            raise Unusable(
                "bad-option",
                f"an option is before the command {context.invoked_subcommand}",
                "effects",
                "write options after it",
            )
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
    from app.cli.local_effects import every
    from app.own_effects.own_effect import view

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


@program.command("keep")
def keep(
    source: Annotated[
        str,
        typer.Argument(metavar="EFFECT.yaml|D.json", help="File of an effect, or of a diagnosis made with --propose."),
    ],
    name: Annotated[str, typer.Option(metavar="NAME", help="Name of the effect; an effect file already has one.")] = "",
    proposal: Annotated[int, typer.Option(min=0, metavar="N", help="Number of the proposed term, from 0.")] = 0,
    server: Where = "",
    token: Token = "",
) -> None:
    """Save an effect under a name.

    Any later fit or diagnosis can use it by `--custom NAME`. With --server the service saves it, from a file, a local
    name, or the id of a diagnosis of the service.
    """
    if not server:
        from app.cli.local_effects import folder
        from app.cli.local_effects import keep as keep_here

        kept = given(Path(source), name, proposal)
        new = keep_here(kept)
        print(message("kept.saved" if new else "kept.already", name=kept.name, where=folder()))
        return
    answer = request(server, token, "POST", "/own-effects", json=body(source, name, proposal))
    stored = answer.json()
    new = answer.status_code == 201
    print(message("kept.saved_by" if new else "kept.already_by", name=stored["name"], where=server))


def given(file: Path, name: str, proposal: int) -> OwnEffect:
    """The effect of a file, or the term of a diagnosis, under a name. Raises Unusable."""
    from app.cli.arguments import is_diagnosis
    from app.cli.input_files import read_diagnosis
    from app.own_effects.own_effect import meaning_of, proposed, suggested, written_down
    from ident.custom.definition import definition_of

    if not is_diagnosis(file):
        definition = definition_of(file.read_bytes(), file.stem)
        return written_down(definition, name or str(definition["name"]))
    found = read_diagnosis(file)
    terms = found.proposals or ()
    if not name and proposal < len(terms):
        term = terms[proposal]
        fitting = suggested(meaning_of(term.meaning, term.place))
        raise Unusable("no-name", "a proposed term has no name yet", str(file), f"give one, as --name {fitting}")
    return proposed(found, proposal, name)


def body(source: str, name: str, proposal: int) -> dict[str, Any]:
    """What a service is asked to keep: a file's effect, one that is kept here, or a term of its own diagnosis."""
    from app.cli.local_effects import look

    kept = given(Path(source), name, proposal) if Path(source).exists() else look(source)
    if kept is not None:
        return {"name": name or kept.name, "definition": dict(kept.definition), "model": kept.model}
    if not name:
        raise Unusable(
            "no-name",
            "neither a file nor a saved effect; a term of a diagnosis has no name yet",
            source,
            "give a file, or the id of a diagnosis and --name",
        )
    return {"name": name, "diagnosis": source, "proposal": proposal}


@program.command("drop")
def drop(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of a saved effect.")],
    server: Where = "",
    token: Token = "",
) -> None:
    """Delete an own effect. Fits keep the effects that they were made with."""
    if server:
        request(server, token, "DELETE", f"/own-effects/{segment(name)}")
    else:
        from app.cli.local_effects import drop as drop_here

        drop_here(name)
    print(f"{name} is deleted")
