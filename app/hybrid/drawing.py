"""Figures of controllers, hybrid simulations, what-if and tracking, as bytes in every format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from app.context import Context
from app.errors import Failure
from app.hybrid import controllers, position_loop, service, tracking
from app.hybrid import what_if as asked_machines
from app.hybrid.records import command_of, of_part, unpacked
from app.hybrid.work import WITHOUT
from app.lru import LRU
from ident.figures import MEDIA, drawings, figure, render
from ident.figures.delay_map import DELAY_MAP
from ident.figures.subjects import Coupled, Designed, Simulated, Tracked
from ident.hybrid.coupled_case import CoupledCase, case_of_part
from ident.hybrid.coupled_stability import DelayMap
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.hybrid.shaking_table import command_text
from ident.hybrid.share_map import ShareMap
from schemas.hybrid import PositionLoopRequest, WhatIfRequest

_MOST = 64  # figures in memory, about 100 kB each
_figures: LRU[bytes] = LRU(_MOST)
Style = tuple[str, float]
"""The theme, and the share of its usual width that a figure has."""


def of_controller(context: Context, controller: str, name: str, kind: str, style: Style) -> tuple[bytes, str]:
    """A figure of a controller."""
    asked = ("controller", controller)
    return _drawn(context, asked, lambda: Designed(*controllers.designed(context, controller)), name, kind, style)


def of_simulation(
    context: Context, simulation: str, name: str, kind: str, style: Style, part: str | None = None
) -> tuple[bytes, str]:
    """A figure of a hybrid simulation; of several actuators that of a `part`, or of the whole."""

    def subject() -> Simulated | Coupled:
        row = service.with_records(context, simulation)
        case, held = service.system_of_row(row), row.result
        if isinstance(case, CoupledCase):
            return _of_parts(case, held, row.records, name, part)
        if part:
            case_of_part(case, part)
        main, without, worth = held["result"], held["without"], held.get("feedforward")
        results = {main["controller"]: main} | ({WITHOUT: without} if without else {})
        return Simulated(
            unpacked(row.records, case, results),
            case,
            _map(held["map"]) if held["map"] else None,
            FeedforwardTracking.from_json(worth) if worth else None,
        )

    return _drawn(context, ("hybrid", simulation, part or ""), subject, name, kind, style)


def command_of_table(context: Context, simulation: str) -> str:
    """The command of a shaking table as a table. Raises Failure 404 where the simulation has none."""
    row = service.with_records(context, simulation)
    case = service.system_of_row(row)
    command = None if isinstance(case, CoupledCase) else command_of(row.records)
    if command is None:
        raise Failure(
            404, "no-command", "the simulation is of no shaking table", "simulation", "simulate a case with a payload"
        )
    return command_text(command, case.sample_rate)


def _of_parts(case: CoupledCase, held: Any, records: bytes, name: str, part: str | None) -> Simulated | Coupled:
    """A part of a simulation with several actuators, the first where none is named; the whole for what is of it."""
    main, without = held["result"], held["without"]
    if name == DELAY_MAP.name and main.get("delay_map"):
        return Coupled(DelayMap.from_json(main["delay_map"]), case.name)
    chosen = case.part(part) if part else case.parts[0]
    number = case.parts.index(chosen)
    result = main["parts"][number]
    results = {result["controller"]: result} | ({WITHOUT: without["parts"][number]} if without else {})
    return Simulated(unpacked(of_part(records, number), chosen.case, results), chosen.case)


def of_what_if(
    context: Context, fit: str, request: WhatIfRequest, name: str, kind: str, style: Style
) -> tuple[bytes, str]:
    """A figure of a changed machine."""
    asked = ("what-if", fit, request.model_dump_json())
    return _drawn(context, asked, lambda: asked_machines.what_if(context, fit, request), name, kind, style)


def of_position_loop(
    context: Context, fit: str, request: PositionLoopRequest, name: str, kind: str, style: Style
) -> tuple[bytes, str]:
    """A figure of a position loop."""
    asked = ("position-loop", fit, request.model_dump_json())
    return _drawn(context, asked, lambda: position_loop.position_loop(context, fit, request), name, kind, style)


def of_track(
    context: Context, matrix: str, run: str | None, noise: str | None, name: str, kind: str, style: Style
) -> tuple[bytes, str]:
    """A figure of a run that is followed."""
    asked = ("track", matrix, run or "", noise or "")
    return _drawn(context, asked, lambda: Tracked(*tracking.track(context, matrix, run, noise)), name, kind, style)


def _drawn(
    context: Context, of: tuple[str, ...], subject: Callable[[], object], name: str, kind: str, style: Style
) -> tuple[bytes, str]:
    """A figure as bytes and their media type, from memory where it was drawn lately. Raises Failure 404, Unusable."""
    if kind not in MEDIA:
        raise Failure(404, "no-such-format", f"no figures as {kind!r}", "figure", f"use {', '.join(MEDIA)}")

    def drawn() -> bytes:
        found = subject()
        there = drawings(found)
        if name not in there:
            raise Failure(404, "no-such-figure", f"no figure {name!r}", "figure", f"use {', '.join(there)}")
        return render(figure(name, found, *style), kind)

    return _figures.get((str(context.storage.folder), *of, name, kind, *style), drawn), MEDIA[kind]


def _map(held: Mapping[str, list[object]]) -> ShareMap:
    """The map again, of its JSON."""
    tables = {name: np.array(held[name], dtype=float) for name in ("reference_rms", "tracking_rms", "critical_delay")}
    return ShareMap(np.array(held["mass"]), np.array(held["stiffness"]), np.array(held["stable"]), **tables)
