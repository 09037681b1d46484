"""`servoident hybrid`: a real-time hybrid simulation on an identified actuator."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from app.cli.arguments import effect_values
from app.cli.at_option import At, Over, Sets, moved_to
from app.cli.before_option import Before, CaseBefore, EarlierFit, EarlierGain, earlier_case
from app.cli.figure_files import write_figures
from app.cli.hybrid_parts import PartsAsked, show_parts
from app.cli.input_files import read_fit
from app.cli.output import STANDARD_OUTPUT, check_target, write_bytes, write_json
from app.cli.progress import shown
from app.cli.rig_option import RigFile, rig_in
from app.cli.spread_option import SpreadGiven, spread_in
from app.cli.whatif import specimen_of

if TYPE_CHECKING:
    from ident.hybrid.case import Case
    from ident.hybrid.drawn_simulations import DrawnSimulations
    from ident.hybrid.feedforward_tracking import FeedforwardTracking
    from ident.hybrid.hybrid_simulation import HybridResult
    from ident.hybrid.parameter_samples import Spread
    from ident.hybrid.share_map import ShareMap


def hybrid(
    fit: Annotated[Path, typer.Argument(metavar="FIT.json", help="File from `servoident fit --json`.")],
    case: Annotated[str, typer.Option(metavar="CASE", help="qian, benchmark2020, or a YAML file.")],
    controller: Annotated[
        str, typer.Option(metavar="FILE|NAME", help="File from `servoident control`, or none, kalman, feedforward.")
    ] = "none",
    ground: Annotated[
        str | None,
        typer.Option(
            metavar="FILE|NAME", help="Ground motion: a record (text or YAML), blwn or sine. Default: that of the case."
        ),
    ] = None,
    effect: Annotated[
        list[str] | None, typer.Option(metavar="NAME[.PARAM=VALUE]", help="Effect to add; may be repeated.")
    ] = None,
    isolator: Annotated[
        str | None,
        typer.Option(
            metavar="KEY=VALUE,…",
            help="Isolator on the specimen, unknown to the controller: mass, stiffness, damping; part of several.",
        ),
    ] = None,
    shares: Annotated[
        bool,
        typer.Option(
            "--map",
            help="Also map stability over the physical share of the structure, or over delays of several actuators.",
        ),
    ] = False,
    at: At = None,
    over: Over = "temperature",
    sets: Sets = None,
    spread: SpreadGiven = None,
    before: EarlierFit = None,
    before_gain: EarlierGain = None,
    before_case: CaseBefore = None,
    rig: RigFile = None,
    json: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the scores as JSON; - is stdout.")] = None,
    out: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the figures: svg, png, pdf, json.")] = None,
) -> None:
    """Simulate a real-time hybrid simulation.

    It couples a numerical substructure, a controller, the identified actuator and a specimen. A case may have several
    parts, each with its own fit and controller. Exit status 1 if it is unstable: cause and remedies are listed.
    """
    from dataclasses import replace

    from ident.hybrid.controller import name_of
    from ident.hybrid.controller_lookup import FEEDFORWARD, controller_called
    from ident.hybrid.coupled_case import CoupledCase
    from ident.hybrid.coupled_reading import read_system
    from ident.hybrid.feedforward_tracking import followed_in
    from ident.hybrid.hybrid_simulation import simulate_hybrid
    from ident.hybrid.specimen_effects import wanted_in

    check_target(json)
    own, of = read_fit(fit), read_system(case)
    of = of if ground is None else of.with_ground(ground)
    if isinstance(of, CoupledCase):
        of, on = of if rig is None else of.changed(rig=rig_in(rig)), effect_values(effect or [], own.model)
        asked = PartsAsked(
            controller, on, shares, isolator, spread, at, over, sets, Before(before, before_gain, before_case)
        )
        raise typer.Exit(0 if show_parts(own, of, Path(case).parent, asked, json, out) else 1)
    moved = moved_to(own, at, over, sets)
    result = moved.fit
    of = of if rig is None else replace(of, rig=rig_in(rig))
    effects, wide = effect_values(effect or [], result.model), spread_in(spread, result.model)
    earlier = earlier_case(result, of, before, before_gain, before_case)
    known, beside = of, None if isolator is None else specimen_of(isolator, "--isolator")
    of = of if beside is None else of.with_isolator(beside)
    if wide is not None and controller == FEEDFORWARD:
        of.not_a_table("spread of its feedforward")
    ahead = wanted_in(result, of, effects) if controller == FEEDFORWARD else None
    acting = controller_called(controller, result, known, ahead)
    with shown() as report:
        found_here = simulate_hybrid(result, of, acting, effects, report, earlier)
        runs = {name_of(acting): replace(found_here, notes=(*moved.text, *found_here.notes))}
        if controller != "none" and out is not None:
            runs["no controller"] = simulate_hybrid(result, of, None, effects, report)
        found = _map(shares, acting, result, of, effects, report)
        drawn = None if controller == FEEDFORWARD else _drawn(wide, acting, result, of, effects, report)
    ahead_known = controller == FEEDFORWARD and known.table is None
    worth = followed_in(result, known, spread=wide, isolator=beside) if ahead_known else None
    main = next(iter(runs.values()))
    _tell(main, found, worth, drawn, json)
    if out is not None:
        _draw(runs, of, found, worth, out)
    if not main.stable:
        raise typer.Exit(1)


def _tell(
    main: HybridResult,
    found: ShareMap | None,
    worth: FeedforwardTracking | None,
    drawn: DrawnSimulations | None,
    json: Path | None,
) -> None:
    """Write the scores, and show them."""
    from app.cli.tables import show

    if json is not None:
        further = {"map": found, "feedforward": worth, "spread": drawn}
        write_json({**main.to_json(), **{name: one.to_json() for name, one in further.items() if one}}, json)
    if json != STANDARD_OUTPUT:
        show((*main.listings(), *(worth.listings() if worth else ()), *(drawn.sentences() if drawn else ())))


def _drawn(wide: Spread | None, acting: Any, *rest: Any) -> DrawnSimulations | None:
    """The same on machines drawn from a spread, where one is stated: of linear controllers."""
    from ident.hybrid.controller_lookup import linear
    from ident.hybrid.drawn_simulations import drawn_simulations

    if wide is None:
        return None
    fit, case, effects, report = rest
    return drawn_simulations(fit, case, linear(acting, "spread"), effects, wide, report=report)


def _draw(
    runs: dict[str, HybridResult], of: Case, found: ShareMap | None, worth: FeedforwardTracking | None, out: Path
) -> None:
    """The figures, and of a shaking table its command."""
    from ident.figures.subjects import Simulated

    if of.table is not None:
        write_command(next(iter(runs.values())), out)
    write_figures(Simulated(runs, of, found, worth), out)


def write_command(found: HybridResult, out: Path) -> None:
    """The command of a shaking table as a file for its rig: time and command, a row a sample."""
    from ident.hybrid.shaking_table import command_text

    out.mkdir(parents=True, exist_ok=True)
    write_bytes(command_text(found.command, found.sample_rate).encode(), out / "command.csv")


def _map(asked: bool, acting: Any, *rest: Any) -> ShareMap | None:
    """The map, where it is asked for: of linear controllers, which run side by side."""
    from ident.hybrid.controller_lookup import linear
    from ident.hybrid.share_map import share_map

    if not asked:
        return None
    fit, case, effects, report = rest
    return share_map(fit, case, linear(acting, "map"), effects, report=report)
