"""`servoident next`: the run that the lab should add, with its command signal."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.input_files import read_diagnosis
from app.cli.last_diagnosis import found_file
from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.rig_option import RigFile, on_rig


def next_(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    diagnosis: Annotated[
        Path,
        typer.Option(metavar="D.json|last", help="File from `servoident diagnose --json`, or last: the latest kept."),
    ],
    out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for command.csv, command.mat, experiment.json.")],
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Seed of the command signal.")] = 0,
    rig: RigFile = None,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the proposal as JSON; - is stdout.")] = None,
) -> None:
    """Propose the next run to record.

    It is the run that best separates the effects between which a diagnosis cannot decide.
    """
    from ident.design.proposal import propose
    from ident.diagnosis.competing_models import competing_models
    from ident.readers import read_matrix

    check_target(json)
    records = read_matrix(matrix)
    in_question = competing_models(read_diagnosis(found_file(diagnosis, records)))
    proposal = propose(in_question, on_rig(records, rig), seed)
    proposal.write(out)
    if json is not None:
        write_json(proposal.to_json(), json)
    if json != STANDARD_OUTPUT:
        print(proposal.text)
        print(f"wrote command.csv, command.mat and experiment.json to {out}")
