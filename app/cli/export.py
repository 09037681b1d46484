"""`servoident export`: an identified machine as a file for another program."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.cli.given import read_fit
from app.cli.output import check_target, write_bytes
from app.cli.whatif import OfSpecimen, specimen_of


def export(
    fit: Annotated[Path, typer.Argument(metavar="FIT.json", help="What `servoident fit --json` wrote.")],
    format_: Annotated[
        str,
        typer.Option("--format", metavar="NAME", help="c: header; mat: state space of the linear part; fmu: FMI 2."),
    ],
    out: Annotated[Path, typer.Option(metavar="FILE", help="The file to write.")],
    gain: Annotated[float | None, typer.Option(metavar="KP", help="Gain of its loop; that of the model, or 1.")] = None,
    specimen: OfSpecimen = None,
    sample_rate: Annotated[str, typer.Option(metavar="HZ", help="Samples a second, as in '4096 Hz'.")] = "4096 Hz",
) -> None:
    """Write an identified machine as C, as state space or as a functional mock-up unit.

    The C header and the FMU are the nonlinear machine with its effects, in the very equations that are simulated here;
    the MAT file is its linear part, with A, B, C, D for `ss` and for Simulink.
    """
    from ident.export import as_file, exported, linear_part
    from ident.units.quantity import quantity

    check_target(out)
    rate = quantity(sample_rate, "frequency", "--sample-rate")
    machine = exported(read_fit(fit), specimen_of(specimen), gain, rate)
    write_bytes(as_file(machine, format_), out)
    print(f"wrote {out}: {machine.driven_by} in, {', '.join(machine.outputs)} out, at {rate:g} Hz")
    if format_ == "mat" and (left_out := linear_part(machine).left_out):
        print(f"note: the linear part is without {', '.join(left_out)}")
