"""`servoident upload`: send a matrix to the service."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, write_json
from app.cli.remote import DEFAULT, Server, Token, request


def upload(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Folder, its matrix.yaml, or a .zip.")],
    server: Server = DEFAULT,
    token: Token = "",
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the answer as JSON; - is stdout.")] = None,
) -> None:
    """Send a matrix to the service. The same bytes again give the same matrix."""
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
    """The .zip, or the description and the files that it names, by their names inside the matrix."""
    import yaml

    from ident.errors import Unusable

    if matrix.is_dir():
        matrix = matrix / "matrix.yaml"
    if matrix.suffix == ".zip":
        return [(matrix.name, matrix)]
    try:
        description = yaml.safe_load(matrix.read_bytes())
        names = {str(run["file"]) for run in description["runs"]}
    except (yaml.YAMLError, ValueError, TypeError, KeyError):
        remedy = "see what `servoident check` says about it"
        raise Unusable("bad-description", "not a description of runs with a file each", str(matrix), remedy) from None
    limits = {str(description["limits"])} if description.get("limits") else set()
    return [("matrix.yaml", matrix), *((name, matrix.parent / name) for name in sorted(names | limits))]
