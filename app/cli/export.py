"""`servoident export`: an identified machine as a file for another program."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.input_files import read_fit
from app.cli.output import check_target, write_bytes
from app.cli.whatif import OfSpecimen, specimen_of


def export(
    fit: Annotated[Path, typer.Argument(metavar="FIT.json", help="File from `servoident fit --json`.")],
    format_: Annotated[
        str,
        typer.Option(
            "--format",
            metavar="NAME",
            help="c: header; mat: state space of the linear part, or blocks of a bench; fmu: FMI 2.",
        ),
    ],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The file to write.")],
    gain: Annotated[
        float | None, typer.Option(metavar="KP", help="Loop gain. Default: that of the model, or 1.")
    ] = None,
    specimen: OfSpecimen = None,
    sample_rate: Annotated[str, typer.Option(metavar="HZ", help="Sample rate, such as '4096 Hz'.")] = "4096 Hz",
) -> None:
    """Export a model as C header, MAT file or FMU.

    The C header and the FMU contain the nonlinear model with its effects, from the equations of the simulator. The MAT
    file contains its linear part, with A, B, C, D for `ss` and for Simulink, or the blocks of an actuator of a bench.
    """
    from ident.export import as_file, exported, linear_part
    from ident.units.quantity import quantity

    check_target(out)
    rate = quantity(sample_rate, "frequency", "--sample-rate")
    machine = exported(read_fit(fit), specimen_of(specimen), gain, rate)
    write_bytes(as_file(machine, format_), out)
    print(f"wrote {out}: {machine.driven_by} in, {', '.join(machine.outputs)} out, at {rate:g} Hz")
    if format_ == "mat" and machine.preset.kind == "chain" and (left_out := linear_part(machine).left_out):
        print(f"note: the linear part is without {', '.join(left_out)}")
