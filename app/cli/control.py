"""`servoident control`: a loop-shaping controller for an identified actuator, as files for a rig."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.at_option import At, Over, Sets, moved_to
from app.cli.before_option import CaseBefore, EarlierFit, EarlierGain, earlier_case
from app.cli.figure_files import FORMATS, write_figure
from app.cli.input_files import read_fit
from app.cli.output import write_bytes, write_json
from app.cli.rig_option import RigFile, rig_in
from app.cli.spread_option import SpreadGiven, spread_in
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.hybrid.controller_design import ControllerDesign
    from ident.hybrid.target_loop import Target

FILES = ("controller.json", "controller.mat", "controller.h", *(f"closed-loop.{kind}" for kind in FORMATS))


def control(
    fit: Annotated[Path, typer.Argument(metavar="FIT.json", help="File from `servoident fit --json`.")],
    case: Annotated[str, typer.Option(metavar="CASE", help="qian, benchmark2020, or a YAML file.")],
    out: Annotated[Path, typer.Option(metavar="DIR", help=f"Folder for {', '.join(FILES)}.")],
    target: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Open-loop target, YAML. Default: eq. (19) of Qian et al. 2014.")
    ] = None,
    part: Annotated[str | None, typer.Option(metavar="NAME", help="Part of a case with several actuators.")] = None,
    structure: Annotated[
        str, typer.Option(metavar="NAME", help="feedback or two-degree (two degrees of freedom).")
    ] = "feedback",
    seed: Annotated[int, typer.Option(min=0, max=2**31 - 1, help="Random seed of the draws from the covariance.")] = 0,
    at: At = None,
    over: Over = "temperature",
    sets: Sets = None,
    spread: SpreadGiven = None,
    before: EarlierFit = None,
    before_gain: EarlierGain = None,
    before_case: CaseBefore = None,
    rig: RigFile = None,
) -> None:
    """Design a tracking controller by H-infinity loop shaping.

    The design uses the linear part of the fit and the specimen, gain, sample rate and delay of the case. It is tested
    on 100 models drawn from the covariance of the fit, or from a stated spread. Exit status 1 if the case is unstable
    under it: cause and remedies are listed.
    """
    from dataclasses import replace

    from app.cli.tables import show
    from ident.hybrid.controller_design import design_controller, on_case
    from ident.hybrid.coupled_case import case_of_part
    from ident.hybrid.coupled_reading import read_system
    from ident.hybrid.target_loop import QIAN2014_TARGET

    moved, given = moved_to(read_fit(fit), at, over, sets), case_of_part(read_system(case), part)
    result = moved.fit
    earlier = earlier_case(result, given, before, before_gain, before_case)
    wanted = QIAN2014_TARGET if target is None else _target(target)
    made = design_controller(
        result,
        given.physical,
        sample_rate=given.sample_rate,
        gain=given.gain,
        piston_area=given.piston_area,
        delay=given.delay,
        target=wanted,
        structure=structure,
        seed=seed,
        before=earlier,
        spread=spread_in(spread, result.model),
    )
    made = on_case(made, result, given if rig is None else replace(given, rig=rig_in(rig)), earlier)
    made = replace(made, notes=(*moved.text, *made.notes))
    _write(made, out, given.name)
    show(made.listings())
    print(f"wrote {', '.join(FILES)} to {out}")
    if made.stability is not None and not made.stability.stable:
        raise typer.Exit(1)


def _target(path: Path) -> Target:
    from ident.hybrid.target_loop import read_target

    if not path.is_file():
        raise Unusable("no-such-file", "the file does not exist", str(path), "give its path")
    return read_target(path.read_bytes(), str(path))


def _write(made: ControllerDesign, out: Path, case: str) -> None:
    from ident.figures.subjects import Designed
    from ident.hybrid.export import as_header, as_mat

    out.mkdir(parents=True, exist_ok=True)
    controller = made.design.controller
    write_json(made.to_json(), out / FILES[0])
    write_bytes(as_mat(controller), out / FILES[1])
    write_bytes(as_header(controller).encode(), out / FILES[2])
    write_figure(Designed(made, case), "closed-loop", out)
