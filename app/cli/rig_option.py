"""The limits of a rig, for the commands that keep to them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from ident.matrix import Matrix
    from ident.rig.limits import RigLimits

RigFile = Annotated[
    Path | None,
    typer.Option(
        "--rig",
        metavar="FILE",
        help="YAML file with the limits of the rig, by themselves or under rig:.",
    ),
]


def rig_in(file: Path | None) -> RigLimits | None:
    """The limits in the file of `--rig`; None without one. Raises Unusable."""
    from ident.readers.rig import read_rig

    return None if file is None else read_rig(file)


def on_rig(matrix: Matrix, file: Path | None) -> Matrix:
    """The matrix with the limits in the file of `--rig` in place of its own. Raises Unusable."""
    from dataclasses import replace

    if file is None:
        return matrix
    return replace(matrix, actuator=replace(matrix.actuator, rig=rig_in(file)))
