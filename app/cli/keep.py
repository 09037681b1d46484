"""`servoident effects keep`: an effect of one's own, or what a diagnosis proposes, under a name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.effects import Where
from app.cli.remote import Token, request
from ident.errors import Unusable
from ident.words.message import message

if TYPE_CHECKING:
    from app.own_effects.kept import Kept


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
        from app.cli.kept_here import folder
        from app.cli.kept_here import keep as keep_here

        kept = given(Path(source), name, proposal)
        new = keep_here(kept)
        print(message("kept.saved" if new else "kept.already", name=kept.name, where=folder()))
        return
    answer = request(server, token, "POST", "/own-effects", json=body(source, name, proposal))
    stored = answer.json()
    new = answer.status_code == 201
    print(message("kept.saved_by" if new else "kept.already_by", name=stored["name"], where=server))


def given(file: Path, name: str, proposal: int) -> Kept:
    """The effect of a file, or the term of a diagnosis, under a name. Raises Unusable."""
    from app.cli.arguments import is_diagnosis
    from app.cli.given import read_diagnosis
    from app.own_effects.kept import meaning_of, proposed, suggested, written_down
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
    from app.cli.kept_here import look

    kept = given(Path(source), name, proposal) if Path(source).exists() else look(source)
    if kept is not None:
        return {"name": name or kept.name, "definition": dict(kept.definition), "model": kept.model}
    if not name:
        raise Unusable("no-name", "neither a file nor a saved effect; a term of a diagnosis has no name yet", source,
                       "give a file, or the id of a diagnosis and --name")  # fmt: skip
    return {"name": name, "diagnosis": source, "proposal": proposal}
