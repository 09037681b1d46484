"""`servoident check`: what a data set contains, and the errors, warnings and notes of the data check."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.output import STANDARD_OUTPUT, check_target, write_json
from app.cli.preprocessing_options import NoRunExclusion, switches
from app.cli.rig_option import RigFile, on_rig
from ident.words.number import count
from ident.words.run_name import run_name, without_name
from ident.words.severity import level, levels
from ident.words.titles import data

if TYPE_CHECKING:
    from ident.checks.finding import Finding
    from ident.matrix import Actuator, Matrix
    from ident.run import Run


def check(
    matrix: Annotated[Path, typer.Argument(metavar="MATRIX", help="Data set: a folder, its matrix.yaml, or a .zip.")],
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the findings as JSON; - is stdout.")] = None,
    rig: RigFile = None,
    no_run_exclusion: NoRunExclusion = False,
) -> None:
    """List and check the contents of a data set.

    Exit status 1 if the check finds an error.
    """
    from dataclasses import asdict

    from ident.checks.check import check as findings_of
    from ident.preprocessing import screen
    from ident.readers import read_matrix

    check_target(json)
    read = screen(on_rig(read_matrix(matrix), rig), switches(no_run_exclusion=no_run_exclusion))
    findings = findings_of(read)
    if json is not None:
        write_json([asdict(finding) for finding in findings], json)
    if json != STANDARD_OUTPUT:
        print("\n".join(description(read)))
        for finding in findings:
            print(line(finding))
        print(levels([finding.severity for finding in findings], all_of=True))
    if any(finding.severity == "fault" for finding in findings):
        raise typer.Exit(1)


def line(finding: Finding) -> str:
    """ "warning: run r1: … [gaps]": the form in which editors and build servers read the lines of a compiler.

    The run is named once, in front.
    """
    text = f"{run_name(finding.run)}: {without_name(finding.text, finding.run)}" if finding.run else finding.text
    return f"{level(finding.severity)}: {text} [{finding.code}]"


def description(matrix: Matrix) -> list[str]:
    """The actuator, the runs by use, and the notices of reading, a line each."""
    lines = [actuator_line(matrix.actuator)]
    for use in ("fit", "verify"):
        runs = matrix.of_use(use)
        said = runs_line(runs) if runs else "no runs"
        lines.append(f"{data(use)}: {said}")
    return lines + [f"notice: {notice}" for notice in matrix.notices]


def actuator_line(actuator: Actuator) -> str:
    """The machine in a line."""
    area = "area not stated" if actuator.piston_area is None else f"piston area {1e6 * actuator.piston_area:.4g} mm²"
    return ", ".join(part for part in (f"actuator {actuator.serial}", actuator.name, area) if part)


def runs_line(runs: tuple[Run, ...]) -> str:
    """Number, kinds, gains, specimens and total length of some runs."""
    kinds = ", ".join(sorted({run.kind for run in runs}))
    gains = ", ".join(f"{gain:g}" for gain in sorted({run.gain for run in runs if run.gain is not None}))
    specimens = len({run.specimen for run in runs if run.specimen is not None})
    unit = runs[0].time_unit.replace("sample", "samples")
    parts = [
        f"{count(len(runs), 'run')} ({kinds})",
        f"Kp {gains}" if gains else "gain not stated",
        count(specimens, "specimen") if specimens else "specimen not stated",
        f"{sum(run.duration for run in runs):.4g} {unit} in all",
    ]
    return ", ".join(parts)
