"""`servoident upload`: send a matrix to the service."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, write_json
from app.cli.remote import DEFAULT, Server, Token, request


def upload(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the answer as JSON; - is stdout.")] = None,
) -> None:
    """Upload a data set to the service.

    Identical files open the existing data set.
    """
    with ExitStack() as stack:
        parts = [("files", (name, stack.enter_context(path.open("rb")))) for name, path in files_of(matrix)]
        answer = request(server, token, "POST", "/matrices", files=parts)
    stored = answer.json()
    if json is not None:
        write_json(stored, json)
    if json != STANDARD_OUTPUT:
        known = "known already" if answer.status_code == 200 else "new"
        print(f"matrix {stored['id']} of {stored['serial']}: {len(stored['runs'])} runs, {known}")


def files_of(matrix: Path) -> list[tuple[str, Path]]:
    """The .zip, or the description and the files that it names, by their names inside the matrix.

    Raises Unusable where a file is not what reading the matrix here would accept: nothing else leaves this machine.
    """
    from ident.readers.archive import Archive
    from ident.readers.description import describe
    from ident.readers.limits import LIMITS
    from ident.readers.source import DESCRIPTION, Folder

    if not matrix.is_dir() and matrix.name != DESCRIPTION:
        Archive(matrix, matrix.name).close()
        return [(matrix.name, matrix)]
    folder = matrix if matrix.is_dir() else matrix.parent
    described = describe(Folder(folder).read(DESCRIPTION, LIMITS.description), LIMITS)
    names = {run.labels.file for run in described.runs} | ({described.limits} if described.limits else set())
    return [(name, own_file(folder, name)) for name in (DESCRIPTION, *sorted(names))]


def own_file(folder: Path, name: str) -> Path:
    """Where a file of a matrix folder lies. Raises Unusable for a link, for what is no file, and for a large one."""
    from ident.errors import Unusable
    from ident.readers.limits import LIMITS, check_size

    path = folder
    for part in name.split("/"):
        path = path / part
        if path.is_symlink():
            raise Unusable("symbolic-link", f"{part!r} is a symbolic link", name, "put the file itself there")
    if not path.is_file():
        raise Unusable("missing-file", "there is no such file", name, "add it or correct the name")
    check_size(path.stat().st_size, LIMITS.file, "the file", name)
    return path
