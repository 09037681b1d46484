"""Effects of one's own that are kept on this machine: a file each, in the folder `effects` of the data."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ident.errors import Unusable
from ident.words.nearest import did_you_mean

if TYPE_CHECKING:
    from app.own_effects.own_effect import OwnEffect


def folder() -> Path:
    """Where they are: in SERVOIDENT_DATA, or the data folder of this user."""
    from app.settings import default_data

    return default_data() / "effects"


def every() -> list[OwnEffect]:
    """All of them by name. Raises Unusable for a file that holds none."""
    return [_read(file) for file in sorted(folder().glob("*.json"))]


def look(name: str) -> OwnEffect | None:
    """The effect of a name, None where none is kept."""
    from ident.custom.definition import is_name

    return find(name) if is_name(name) and _file(name).is_file() else None


def defined_here() -> dict[str, Mapping[str, Any]]:
    """The definitions of all of them by name. Raises Unusable for a file that holds none."""
    return {kept.name: kept.definition for kept in every()}


def beside(definitions: Sequence[Mapping[str, Any]], model: str) -> tuple[Mapping[str, Any], ...]:
    """These definitions, and of those that are kept under other names all that a model can take."""
    from app.own_effects.own_effect import usable_on

    names = {definition["name"] for definition in definitions}
    return (*definitions, *(kept.definition for kept in usable_on(every(), model) if kept.name not in names))


def find(name: str) -> OwnEffect:
    """The effect of a name. Raises Unusable where none is kept."""
    file = _file(name)
    if not file.is_file():
        remedy = "see `servoident effects` for the names, or name a file that is there"
        kept = (one.stem for one in sorted(folder().glob("*.json")))
        raise Unusable("no-such-effect", "no effect is saved under this name", name, did_you_mean(name, kept, remedy))
    return _read(file)


def keep(kept: OwnEffect) -> bool:
    """Keep an effect under its name; False where it is kept already. Raises Unusable where another one has the name."""
    from app.cli.output import write_json
    from ident.plain import written

    file = _file(kept.name)
    if file.is_file():
        if _read(file).definition != kept.definition:
            raise Unusable(
                "name-in-use",
                f"another effect is saved as {kept.name}",
                str(file),
                f"give it another --name, or `servoident effects drop {kept.name}` first",
            )
        return False
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    moment = datetime.now(UTC).isoformat(timespec="seconds")
    write_json(written(replace(kept, created_at=moment)), file)
    return True


def drop(name: str) -> None:
    """Remove an effect. Raises Unusable where none is kept under the name."""
    find(name)
    _file(name).unlink()


def _file(name: str) -> Path:
    from ident.custom.definition import is_name

    if not is_name(name):
        raise Unusable(
            "bad-name", f"{name!r} is not a name of an effect", "name", "see `servoident effects` for the names"
        )
    return folder() / f"{name}.json"


def _read(file: Path) -> OwnEffect:
    from app.own_effects.own_effect import OwnEffect
    from ident.plain import Misfit, read

    try:
        found = read(OwnEffect, json.loads(file.read_bytes()))
    except (ValueError, RecursionError, Misfit):
        found = None
    if found is None or found.name != file.stem:
        raise Unusable("not-an-effect", "not a saved effect", str(file), "remove the file, and save the effect again")
    return found
