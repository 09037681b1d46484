"""Hybrid simulations: queue, look, list."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from app.context import Context
from app.errors import missing
from app.fits import service as fits
from app.hybrid import coupled_simulation, repository
from app.hybrid.at_condition import moved_to
from app.hybrid.controller_lookup import controller_of
from app.hybrid.earlier_loop import earlier_case, stated
from app.hybrid.request_parsing import AskedCase, asked_case, effects_of, specimen_of
from app.hybrid.spread import spread_of
from app.hybrid.stored_inputs import kept_controller, kept_text
from app.jobs import service as jobs
from app.paging import cursor, keys_of
from app.tables import HybridRow
from ident.design.at_condition import Moved
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import Controller, SampledController, name_of
from ident.hybrid.controller_lookup import FEEDFORWARD, linear
from ident.hybrid.coupled_case import CoupledCase, System, case_of_part
from ident.hybrid.machine import machine
from ident.plain import written
from schemas.fit import JobView
from schemas.hybrid import HybridRequest
from schemas.hybrid_result import HybridPage, HybridView

KIND = "hybrid simulation"
FIGURES = ("displacement", "response")
MOST_MAPPED = 500_000
"""Samples of a motion over which a map is made: minutes of computing."""


def submit(context: Context, request: HybridRequest, job: str) -> JobView:
    """Queue a hybrid simulation under the id decided for its job. Raises Unusable where it cannot be run."""
    row = fits.find(context, request.fit)
    own, asked = FitResult.from_json(row.result), asked_case(request.case, request.ground)
    system, effects = asked.system(), effects_of(request, own.model)
    if isinstance(system, CoupledCase):
        settings = coupled_simulation.settings(context, request, own, system, asked, effects)
        return jobs.record(context, job, row.matrix, settings, request.fit, KIND)
    moved = moved_to(context, own, request.at)
    fit, case = moved.fit, case_of_part(system, request.isolator_part)
    isolator = None if request.isolator is None else specimen_of(request.isolator, "isolator")
    given, stored = kept_controller(context, request.controller)
    chosen = controller_of(given, fit, case)
    _check(fit, case if isolator is None else case.with_isolator(isolator), effects, chosen, request.map)
    spread = spread_of(context, request.spread, fit.model)
    if spread is not None and given == FEEDFORWARD:
        case.not_a_table("spread")
    if spread is not None and given != FEEDFORWARD:
        linear(chosen, "spread")
    settings = {
        "model": fit.model,
        "effects": list(effects),
        "case": case.name,
        "controller": name_of(chosen),
        "ground": case.ground.name,
        "asked": {
            **asdict(asked),
            "text": kept_text(context, asked.text),
            "effects": effects,
            "map": request.map,
            "controller": given if isinstance(given, str) else kept_text(context, json.dumps(given)),
            "inline": not isinstance(given, str),
            "controller_id": stored,
            "spread": None if spread is None else written(spread),
            "moved": _moved(context, moved),
            "isolator": None if isolator is None else written(isolator),
            "before": _before(context, stated(request.before), fit, case),
        },
    }
    return jobs.record(context, job, row.matrix, settings, request.fit, KIND)


def _moved(context: Context, moved: Moved) -> dict[str, Any] | None:
    """The fit at another condition, under the name of a blob, and how it came there; None where it was not moved."""
    if not moved.text:
        return None
    return {"fit": kept_text(context, json.dumps(moved.fit.to_json())), "notes": moved.text}


def _before(context: Context, given: dict[str, Any] | None, fit: FitResult, case: Case) -> dict[str, Any] | None:
    """The loop when it was stable, its fit under the name of a blob. Raises Unusable, and Failure 404."""

    def find(other: str) -> FitResult:
        return FitResult.from_json(fits.find(context, other).result)

    if earlier_case(given, fit, case, find) is None or given is None or "fit" not in given:
        return given
    return {**given, "fit": kept_text(context, json.dumps(find(given["fit"]).to_json()))}


def _check(fit: FitResult, case: Case, effects: dict[str, float], chosen: Controller, mapped: bool) -> None:
    """Raise Unusable where a simulation cannot be run, or would take too long."""
    samples = len(case.ground.samples(case.sample_rate))
    machine(fit, case, effects)
    if mapped:
        case.not_a_table("map")
    if mapped and samples > MOST_MAPPED:
        raise Unusable(
            "too-long",
            f"{samples} samples are too many for a map",
            "ground duration",
            f"give a motion of at most {MOST_MAPPED} samples",
        )
    if mapped and not isinstance(chosen, SampledController):
        raise Unusable("bad-option", "a map needs a linear controller", "map", "leave the map out, or give another")


def get(context: Context, simulation: str) -> HybridView:
    """A hybrid simulation by id; raises Failure 404."""
    with context.sessions() as session:
        row = repository.simulation(session, simulation)
    if row is None:
        raise missing("hybrid-simulation", simulation)
    return view(row)


def listed(context: Context, fit: str | None, after: str | None, limit: int) -> HybridPage:
    """A page of hybrid simulations, without their maps and curves."""
    with context.sessions() as session:
        rows = repository.simulations(session, fit, keys_of(after, 2), limit)
    following = cursor(rows[-1].created_at, rows[-1].id) if len(rows) == limit else None
    return HybridPage(
        items=[view(row).model_copy(update={"map": None, "feedforward": None, "delay_map": None}) for row in rows],
        next=following,
    )


def view(row: HybridRow) -> HybridView:
    """A hybrid simulation as it is sent."""
    held = row.result
    kept = any(one is not None and one["ended"] is None for one in (held["result"], held["without"]))
    names = [*(FIGURES if kept else FIGURES[:1]), *(name for name in ("map", "feedforward") if held.get(name))]
    names += ["acceleration"] if held["result"].get("acceleration") else []
    names += ["delay-map"] if held["result"].get("delay_map") else []
    return HybridView(
        **held["result"],
        id=row.id,
        fit=row.fit,
        matrix=row.matrix,
        serial=row.serial,
        created_at=row.created_at,
        controller_id=row.controller,
        without=held["without"],
        map=held["map"],
        feedforward=held.get("feedforward"),
        spread=held.get("spread"),
        figures=names,
    )


def system_of_row(row: HybridRow) -> System:
    """The case that was simulated, its motion without the record."""
    return AskedCase(row.asked["case"], row.asked["ground"]).system()


def with_records(context: Context, simulation: str) -> HybridRow:
    """A hybrid simulation with its records; raises Failure 404."""
    with context.sessions() as session:
        row = repository.simulation_with_records(session, simulation)
    if row is None:
        raise missing("hybrid-simulation", simulation)
    return row
