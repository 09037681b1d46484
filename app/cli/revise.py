"""`servoident revise`: mend labels, units or signs of a stored matrix."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.remote import DEFAULT, Server, Token, request, segment


def revise(
    matrix: Annotated[str, typer.Argument(metavar="MATRIX", help="Id of a stored data set.")],
    changes: Annotated[
        Path, typer.Argument(metavar="CHANGES.yaml", help="actuator: {…} and runs: {ID: {…}}, as in matrix.yaml.")
    ],
    server: Server = DEFAULT,
    token: Token = "",
) -> None:
    """Correct labels, units or signs of a stored data set.

    The raw files stay unchanged; the result is a new data set.
    """
    body = read_changes(changes)
    stored = request(server, token, "POST", f"/matrices/{segment(matrix)}/revisions", json=body).json()
    print(f"matrix {stored['id']} of {stored['serial']}: a revision of {stored['parent']}")


def read_changes(path: Path) -> dict[str, Any]:
    """The changes as plain data; raises Unusable where the file is no YAML mapping."""
    from ident.errors import Unusable
    from ident.readers.strict_yaml import read_yaml

    changes = read_yaml(path.read_bytes(), str(path))
    if not isinstance(changes, dict):
        remedy = "write runs: {RUN: {gain: 7}} or actuator: {batch: B1}"
        raise Unusable("bad-changes", "not a YAML mapping of changes", str(path), remedy)
    return changes
