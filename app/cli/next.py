"""`servoident next`: the run that the lab should add, with its command signal."""

from __future__ import annotations

import json as json_format
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from ident.errors import Unusable

LARGEST = 50_000_000  # bytes of a diagnosis


def next_(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Folder, its matrix.yaml, or a .zip.")],
    diagnosis: Annotated[Path, typer.Option(metavar="D.json", help="What `servoident diagnose --json` wrote.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for command.csv, command.mat, experiment.json.")],
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Seed of the command signal.")] = 0,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the proposal as JSON; - is stdout.")] = None,
) -> None:
    """Propose the next run. It is the one that best tells apart the effects that a diagnosis leaves in question."""
    from ident.design.proposal import propose
    from ident.design.rivals import floor_of, rivals, trusted
    from ident.readers import read_matrix

    check_target(json)
    found = read_diagnosis(diagnosis)
    proposal = propose(rivals(found), trusted(found, read_matrix(matrix)), floor_of(found), seed)
    proposal.write(out)
    if json is not None:
        write_json(proposal.to_json(), json)
    if json != STANDARD_OUTPUT:
        print(proposal.text)
        print(f"wrote command.csv, command.mat and experiment.json to {out}")


def read_diagnosis(path: Path) -> dict[str, Any]:
    """A diagnosis from its JSON file; raises Unusable where it is not one."""
    remedy = "give the file that `servoident diagnose --json FILE` wrote"
    try:
        data = json_format.loads(path.read_bytes()) if path.stat().st_size <= LARGEST else None
    except (ValueError, RecursionError):
        data = None
    if not isinstance(data, dict):
        raise Unusable("bad-diagnosis", "not the JSON of a diagnosis", str(path), remedy)
    return data
