"""A hybrid simulation with several actuators: what its job keeps of each part, and the simulation itself."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from app.context import Context
from app.fits import service as fits
from app.hybrid.acting import acting
from app.hybrid.asked import AskedCase
from app.hybrid.keeping import kept_controller, kept_text
from ident.fit.result import FitResult
from ident.hybrid.controller import Controller, name_of
from ident.hybrid.coupled_case import CoupledCase, refuse_for_several
from ident.hybrid.coupled_rig import CoupledResult, machines_of, simulate_compared
from ident.hybrid.coupled_stability import with_poles
from ident.progress import Report
from schemas.hybrid import HybridRequest


def settings(
    context: Context, request: HybridRequest, fit: FitResult, case: CoupledCase, asked: AskedCase,
    effects: dict[str, float],
) -> dict[str, Any]:  # fmt: skip
    """What the job of a request keeps. Raises Unusable where it cannot be run, and Failure 404."""
    refuse_for_several(
        {"at": request.at, "spread": request.spread, "before": request.before, "isolator": request.isolator}
    )
    parts, chosen, own = [], [], []
    for part in case.parts:
        of = FitResult.from_json(fits.find(context, part.fit).result) if part.fit else fit
        given, _ = kept_controller(context, dict(part.controller) if isinstance(part.controller, Mapping) else
                                   part.controller or request.controller)  # fmt: skip
        own.append(of)
        chosen.append(acting(given, of, part.case))
        parts.append({
            "fit": kept_text(context, json.dumps(of.to_json())) if part.fit else "",
            "controller": given if isinstance(given, str) else kept_text(context, json.dumps(given)),
            "inline": not isinstance(given, str),
        })  # fmt: skip
    case.ground.samples(case.sample_rate)
    machines = machines_of(own, case, effects)
    if request.map:
        with_poles(machines, chosen)
    return {
        "model": fit.model, "effects": list(effects), "case": case.name, "ground": case.ground.name,
        "controller": ", ".join(dict.fromkeys(map(name_of, chosen))),
        "asked": {**asdict(asked), "text": kept_text(context, asked.text), "effects": effects, "map": request.map,
                  "controller_id": None, "parts": parts},
    }  # fmt: skip


def simulated(
    asked: Mapping[str, Any], fit: FitResult, case: CoupledCase, blob: Callable[[str], str], report: Report
) -> tuple[CoupledResult, CoupledResult | None]:
    """What a job simulates, and the same without a controller; `blob` reads what it kept."""
    kept = asked["parts"]
    own = [FitResult.from_json(json.loads(blob(one["fit"]))) if one["fit"] else fit for one in kept]
    given: list[Any] = [json.loads(blob(one["controller"])) if one["inline"] else one["controller"] for one in kept]
    chosen: list[Controller] = [
        acting(one, of, part.case) for one, of, part in zip(given, own, case.parts, strict=True)
    ]
    controlled = any(one != "none" for one in given)
    return simulate_compared(
        own, case, chosen, asked["effects"], without=controlled, mapped=asked["map"], report=report
    )
