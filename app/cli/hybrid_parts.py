"""`servoident hybrid` of a case with several actuators: each part with its own fit, controller and figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Parts:
    """What was simulated, and the same without a controller where that is drawn."""

    parts: CoupledResult
    alone: CoupledResult | None = None


def refuse_for_several(**options: object) -> None:
    """Raise Unusable for an option that is there for one actuator only."""
    if given := [name.replace("_", "-") for name, value in options.items() if value]:
        raise Unusable("bad-option", "a case of several parts has none", f"--{given[0]}", "leave it out")


def show_parts(
    fit: FitResult, of: CoupledCase, folder: Path, controller: str, effects: Mapping[str, float], mapped: bool,
    json: Path | None, out: Path | None,
) -> bool:  # fmt: skip
    """Simulate a case of several actuators, write and show what came of it; whether it is stable."""
    from app.cli.tables import show

    found = simulate_parts(fit, of, folder, controller, effects, mapped, drawn=out is not None)
    if json is not None:
        write_json(found.parts.to_json(), json)
    if json != STANDARD_OUTPUT:
        show(found.parts.listings())
    if out is not None:
        draw_parts(found, out)
    return found.parts.stable


def simulate_parts(
    fit: FitResult, of: CoupledCase, folder: Path, controller: str, effects: Mapping[str, float], mapped: bool,
    drawn: bool,
) -> Parts:  # fmt: skip
    """Simulate a case whose parts name files in its `folder`; others have the fit and the controller that are given."""
    from dataclasses import replace

    from ident.hybrid.acting import NAMED, controller_called
    from ident.hybrid.controller import no_controller
    from ident.hybrid.coupled_rig import machines_of, simulate_coupled
    from ident.hybrid.coupled_stability import delay_map, with_poles

    fits = [read_fit(folder / part.fit) if part.fit else fit for part in of.parts]
    named = [_inside(part.controller, folder, NAMED) or controller for part in of.parts]
    acting = [controller_called(name, one, part.case) for name, one, part in zip(named, fits, of.parts, strict=True)]
    machines = machines_of(fits, of, effects)
    if mapped:
        with_poles(machines, acting)
    with shown() as report:
        found = simulate_coupled(fits, of, acting, effects, report)
        alone = None
        if drawn and set(named) != {"none"}:
            nothing = [no_controller(of.sample_rate)] * len(fits)
            alone = simulate_coupled(fits, of, nothing, effects, report)
        if mapped:
            mapping = delay_map(machines, of, acting, report=report)
            found = replace(found, delay_map=mapping)
    return Parts(found, alone)


def _inside(given: object, folder: Path, names: Mapping[str, object]) -> str:
    """A controller that a part names: one by a name, or a file in the folder of the case; "" where it names none."""
    if not isinstance(given, str):
        raise Unusable("unknown-controller", "not a name or a file", "part controller", "give one of them")
    return str(folder / given) if given and given not in names else given


def draw_parts(found: Parts, out: Path) -> None:
    """The figures of each part in a folder of its name, and those of the whole."""
    from ident.figures.subjects import Coupled, Simulated

    for name, one in found.parts.parts.items():
        runs = {one.controller: one} | ({"no controller": found.alone.parts[name]} if found.alone else {})
        write_figures(Simulated(runs, one.case), out / _folder(name))
    if found.parts.delay_map is not None:
        write_figures(Coupled(found.parts.delay_map, found.parts.case.name), out)


def _folder(name: str) -> str:
    """The name of a part as that of a folder."""
    return "".join(sign if sign.isalnum() or sign in "-_" else "-" for sign in name)
