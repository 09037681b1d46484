"""`servoident hybrid` of a case with several actuators: each part with its own fit, controller and figures."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.figure_files import write_figures
from app.cli.given import read_fit
from app.cli.output import STANDARD_OUTPUT, write_json
from app.cli.progress import shown
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.fit.result import FitResult
    from ident.hybrid.coupled_case import CoupledCase
    from ident.hybrid.coupled_rig import CoupledResult


def refuse_options(**options: object) -> None:
    """Raise Unusable for an option, named as its parameter is, that is there for one actuator only."""
    from ident.hybrid.coupled_case import refuse_for_several

    refuse_for_several({f"--{name.replace('_', '-')}": value for name, value in options.items()})


def show_parts(
    fit: FitResult, of: CoupledCase, folder: Path, controller: str, effects: Mapping[str, float], mapped: bool,
    json: Path | None, out: Path | None,
) -> bool:  # fmt: skip
    """Simulate a case of several actuators, write and show what came of it; whether it is stable."""
    from app.cli.tables import show

    found, alone = simulate_parts(fit, of, folder, controller, effects, mapped, drawn=out is not None)
    if json is not None:
        write_json(found.to_json(), json)
    if json != STANDARD_OUTPUT:
        show(found.listings())
    if out is not None:
        draw_parts(found, alone, out)
    return found.stable


def simulate_parts(
    fit: FitResult, of: CoupledCase, folder: Path, controller: str, effects: Mapping[str, float], mapped: bool,
    drawn: bool,
) -> tuple[CoupledResult, CoupledResult | None]:  # fmt: skip
    """Simulate a case whose parts name files in its `folder`; others have the fit and the controller that are given.

    The same without a controller is simulated where it is `drawn` beside it.
    """
    from ident.hybrid.acting import NAMED, controller_called
    from ident.hybrid.coupled_rig import simulate_compared

    fits = [read_fit(folder / part.fit) if part.fit else fit for part in of.parts]
    named = [_inside(part.controller, folder, NAMED) or controller for part in of.parts]
    acting = [controller_called(name, one, part.case) for name, one, part in zip(named, fits, of.parts, strict=True)]
    without = drawn and set(named) != {"none"}
    with shown() as report:
        return simulate_compared(fits, of, acting, effects, without=without, mapped=mapped, report=report)


def _inside(given: object, folder: Path, names: Mapping[str, object]) -> str:
    """A controller that a part names: one by a name, or a file in the folder of the case; "" where it names none."""
    if not isinstance(given, str):
        raise Unusable("unknown-controller", "not a name or a file", "part controller", "give one of them")
    return str(folder / given) if given and given not in names else given


def draw_parts(found: CoupledResult, alone: CoupledResult | None, out: Path) -> None:
    """The figures of each part in a folder of its name, and those of the whole."""
    from ident.figures.subjects import Coupled, Simulated

    for name, one in found.parts.items():
        runs = {one.controller: one} | ({"no controller": alone.parts[name]} if alone else {})
        write_figures(Simulated(runs, one.case), out / _folder(name))
    if found.delay_map is not None:
        write_figures(Coupled(found.delay_map, found.case.name), out)


def _folder(name: str) -> str:
    """The name of a part as that of a folder."""
    return "".join(sign if sign.isalnum() or sign in "-_" else "-" for sign in name)
