"""A hybrid simulation with several actuators: what its job keeps of each part, and the simulation itself."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from app.context import Context
from app.fits import service as fits
from app.hybrid.at_condition import moved_to
from app.hybrid.controller_lookup import controller_of
from app.hybrid.earlier_loop import earlier_parts, stated
from app.hybrid.request_parsing import AskedCase, specimen_of
from app.hybrid.spread import kept, spread_of
from app.hybrid.stored_inputs import kept_controller, kept_text
from ident.cached import cached_property
from ident.fit.result import FitResult
from ident.hybrid.controller import Controller, name_of
from ident.hybrid.controller_lookup import FEEDFORWARD, linear
from ident.hybrid.coupled_case import CoupledCase
from ident.hybrid.coupled_loop import EarlierParts
from ident.hybrid.coupled_simulation import CoupledResult, machines_of, simulate_compared
from ident.hybrid.coupled_stability import with_poles
from ident.hybrid.drawn_simulations import DrawnSimulations, drawn_coupled
from ident.hybrid.parameter_samples import Spread
from ident.hybrid.substructure import reference
from ident.plain import read, written
from ident.progress import Report
from ident.run import Specimen
from schemas.hybrid import HybridRequest

Given = str | dict[str, Any]
"""A controller by a name that stands for one, or what its JSON holds."""


def settings(
    context: Context,
    request: HybridRequest,
    fit: FitResult,
    case: CoupledCase,
    asked: AskedCase,
    effects: dict[str, float],
) -> dict[str, Any]:
    """What the job of a request keeps. Raises Unusable where it cannot be run, and Failure 404."""

    def find(name: str) -> FitResult:
        return FitResult.from_json(fits.find(context, name).result)

    moved = [moved_to(context, find(part.fit) if part.fit else fit, request.at) for part in case.parts]
    given = [
        kept_controller(
            context,
            dict(part.controller) if isinstance(part.controller, Mapping) else part.controller or request.controller,
        )[0]
        for part in case.parts
    ]
    own, isolator = [one.fit for one in moved], None
    if request.isolator is not None:
        isolator = {"of": written(specimen_of(request.isolator, "isolator")), "part": request.isolator_part}
    before = earlier_parts(stated(request.before), own, case, find)
    simulation = Simulation(own, case, isolated(case, isolator), given)
    spreads = [wide for one in own if (wide := spread_of(context, request.spread, one.model)) is not None]
    simulation.check(effects, mapped=request.map, spread=bool(spreads))
    parts = [
        {
            "fit": kept_text(context, json.dumps(one.fit.to_json())),
            "notes": one.text,
            "controller": name if isinstance(name, str) else kept_text(context, json.dumps(name)),
            "inline": not isinstance(name, str),
        }
        for one, name in zip(moved, given, strict=True)
    ]
    return {
        "model": fit.model,
        "effects": list(effects),
        "case": case.name,
        "ground": case.ground.name,
        "controller": ", ".join(dict.fromkeys(map(name_of, simulation.controllers))),
        "asked": {
            **asdict(asked),
            "text": kept_text(context, asked.text),
            "effects": effects,
            "map": request.map,
            "controller_id": None,
            "parts": parts,
            "isolator": isolator,
            "spread": [written(s) for s in spreads],
            "before": _kept_before(context, request, before),
        },
    }


def _kept_before(context: Context, request: HybridRequest, before: EarlierParts | None) -> dict[str, Any] | None:
    """The case when its loop was stable, its fits under the names of blobs; None where nothing is said of it."""
    given = stated(request.before)
    if given is None or before is None:
        return None
    of_each = [kept_text(context, json.dumps(one.to_json())) for one in before.fits]
    return {**given, "fits": of_each}


def isolated(case: CoupledCase, given: Mapping[str, Any] | None) -> CoupledCase:
    """The case with the isolator that a job keeps. Raises Unusable for a part that there is not."""
    return case if given is None else case.with_isolator(read(Specimen, given["of"]), given["part"])


@dataclass(frozen=True)
class Simulation:
    """The fits of the parts, the case as the controllers know it and as it is, the controllers as they are given."""

    fits: Sequence[FitResult]
    known: CoupledCase
    case: CoupledCase
    given: Sequence[Given]

    @cached_property
    def controllers(self) -> list[Controller]:
        """A controller for each part; a feedforward follows the reference of the case as it is. Raises Unusable."""
        ground = self.case.ground.samples(self.case.sample_rate)
        wanted = [
            reference(of, ground) if name == FEEDFORWARD else None
            for name, of in zip(self.given, self.case.cases, strict=True)
        ]
        return [controller_of(*one) for one in zip(self.given, self.fits, self.known.cases, wanted, strict=True)]

    def check(self, effects: Mapping[str, float], *, mapped: bool, spread: bool) -> None:
        """Raise Unusable where it cannot be run."""
        machines, controllers = machines_of(self.fits, self.case, effects), self.controllers
        if mapped:
            with_poles(machines, controllers)
        for one in controllers if spread else ():
            linear(one, "spread")

    def run(
        self,
        effects: Mapping[str, float],
        before: EarlierParts | None,
        spreads: Sequence[Spread],
        mapped: bool,
        report: Report,
    ) -> tuple[CoupledResult, CoupledResult | None, DrawnSimulations | None]:
        """What came of it, of the same without controllers, and over machines drawn from spreads."""
        without = any(one != "none" for one in self.given)
        main, alone = simulate_compared(
            self.fits,
            self.case,
            self.controllers,
            effects,
            without=without,
            mapped=mapped,
            report=report,
            before=before,
        )
        if not spreads:
            return main, alone, None
        sampled = [linear(one, "spread") for one in self.controllers]
        return main, alone, drawn_coupled(self.fits, self.case, sampled, effects, spreads, report=report)


def simulated(
    asked: Mapping[str, Any], fit: FitResult, case: CoupledCase, blob: Callable[[str], str], report: Report
) -> tuple[CoupledResult, CoupledResult | None, DrawnSimulations | None]:
    """What a job simulates, the same without a controller, and over its spread; `blob` reads what it kept."""

    def find(name: str) -> FitResult:
        return FitResult.from_json(json.loads(blob(name))) if name else fit

    parts = asked["parts"]
    own = [find(one["fit"]) for one in parts]
    given: list[Given] = [json.loads(blob(one["controller"])) if one["inline"] else one["controller"] for one in parts]
    simulation = Simulation(own, case, isolated(case, asked.get("isolator")), given)
    before = _before(asked.get("before"), case, find)
    spreads = [wide for one in asked.get("spread", ()) if (wide := kept(one)) is not None]
    main, alone, drawn = simulation.run(asked["effects"], before, spreads, asked["map"], report)
    return main.with_notes([one.get("notes", ()) for one in parts]), alone, drawn


def _before(
    given: Mapping[str, Any] | None, case: CoupledCase, find: Callable[[str], FitResult]
) -> EarlierParts | None:
    """The case when its loop was stable, as a job keeps it."""
    if given is None:
        return None
    then = AskedCase(given["case"], None).system() if "case" in given else case
    assert isinstance(then, CoupledCase)
    return EarlierParts([find(one) for one in given["fits"]], then).with_gain(given.get("gain"))
