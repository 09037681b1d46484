"""`servoident hybrid` of a case with several actuators: each part with its own fit, controller and figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.at_option import moved_to
from app.cli.before_option import Before, earlier_parts
from app.cli.figure_files import write_figures
from app.cli.input_files import read_fit
from app.cli.output import STANDARD_OUTPUT, write_json
from app.cli.progress import shown
from app.cli.spread_option import spread_in
from app.cli.whatif import isolator_of
from ident.errors import Unusable

if TYPE_CHECKING:
    from ident.fit.result import FitResult
    from ident.hybrid.controller import Controller
    from ident.hybrid.coupled_case import CoupledCase
    from ident.hybrid.coupled_simulation import CoupledResult


@dataclass(frozen=True)
class PartsAsked:
    """Options of the command, as they were given: they hold for every part."""

    controller: str
    effects: Mapping[str, float]
    mapped: bool
    isolator: str | None
    spread: list[str] | None
    at: str | None
    over: str
    sets: Path | None
    before: Before


def show_parts(
    fit: FitResult, of: CoupledCase, folder: Path, asked: PartsAsked, json: Path | None, out: Path | None
) -> bool:
    """Simulate a case of several actuators, write and show what came of it; whether it is stable.

    Parts name files in the `folder` of the case; others have the fit and the controller that are given.
    """
    from app.cli.tables import show
    from ident.hybrid.controller_lookup import linear
    from ident.hybrid.coupled_simulation import simulate_compared
    from ident.hybrid.drawn_simulations import drawn_coupled

    moved = [
        moved_to(read_fit(folder / part.fit) if part.fit else fit, asked.at, asked.over, asked.sets)
        for part in of.parts
    ]
    fits = [one.fit for one in moved]
    earlier, known = earlier_parts(fits, of, asked.before), of
    of = of if asked.isolator is None else of.with_isolator(*isolator_of(asked.isolator))
    acting, without = _controllers(fits, known, of, folder, asked.controller)
    spreads = [wide for one in fits if (wide := spread_in(asked.spread, one.model)) is not None]
    sampled = [linear(one, "spread") for one in acting] if spreads else []
    with shown() as report:
        found, alone = simulate_compared(
            fits,
            of,
            acting,
            asked.effects,
            without=without and out is not None,
            mapped=asked.mapped,
            report=report,
            before=earlier,
        )
        drawn = drawn_coupled(fits, of, sampled, asked.effects, spreads, report=report) if spreads else None
    found = found.with_notes([one.text for one in moved])
    if json is not None:
        write_json({**found.to_json(), **({"spread": drawn.to_json()} if drawn else {})}, json)
    if json != STANDARD_OUTPUT:
        show((*found.listings(), *(drawn.sentences() if drawn else ())))
    if out is not None:
        draw_parts(found, alone, out)
    return found.stable


def _controllers(
    fits: Sequence[FitResult], known: CoupledCase, of: CoupledCase, folder: Path, controller: str
) -> tuple[list[Controller], bool]:
    """The controller of each part, made for the case as it is known, and whether there is any.

    A feedforward follows the reference of the case `of` that is simulated.
    """
    from ident.hybrid.controller_lookup import FEEDFORWARD, NAMED, controller_called
    from ident.hybrid.substructure import reference

    names = [_inside(part.controller, folder, NAMED) or controller for part in of.parts]
    wanted = [
        reference(case, case.ground.samples(case.sample_rate)) if name == FEEDFORWARD else None
        for name, case in zip(names, of.cases, strict=True)
    ]
    given = zip(names, fits, known.cases, wanted, strict=True)
    return [controller_called(*one) for one in given], set(names) != {"none"}


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
