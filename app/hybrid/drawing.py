"""Figures of controllers, hybrid simulations, what-if and tracking, as bytes in every format."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from app.context import Context
from app.errors import Failure
from app.hybrid import controllers, service, tracking
from app.hybrid import what_if as asked_machines
from app.hybrid.records import unpacked
from app.hybrid.work import WITHOUT
from app.lru import LRU
from ident.figures import MEDIA, Chart, look, render
from ident.figures.closed_loop import closed_loop
from ident.figures.feedforward import feedforward_figure
from ident.figures.hybrid_response import hybrid_response
from ident.figures.hybrid_time import hybrid_time
from ident.figures.look import Look
from ident.figures.root_locus import root_locus
from ident.figures.share_map import share_map_chart
from ident.figures.tracking import tracking as tracking_chart
from ident.figures.what_if_response import what_if_response
from ident.hybrid.followed import Followed
from ident.hybrid.share_map import ShareMap
from schemas.hybrid import WhatIfRequest

_MOST = 64  # figures in memory, about 100 kB each
_figures: LRU[bytes] = LRU(_MOST)
Draw = Callable[[Look], Chart]
Style = tuple[str, float]
"""The theme, and the share of its usual width that a figure has."""


def of_controller(context: Context, controller: str, name: str, kind: str, style: Style) -> tuple[bytes, str]:
    """A figure of a controller: `closed-loop`."""

    def closed(style: Look) -> Chart:
        made, case = controllers.designed(context, controller)
        return closed_loop(made, style, f"case {case}")

    return _drawn(context, ("controller", controller), {"closed-loop": closed}, name, kind, style)


def of_simulation(context: Context, simulation: str, name: str, kind: str, style: Style) -> tuple[bytes, str]:
    """A figure of a hybrid simulation: `displacement`, `response`, and `map` and `feedforward` where it has them."""
    row = service.with_records(context, simulation)
    case, held = service.case_of_row(row), row.result
    results = {held["result"]["controller"]: held["result"]} | ({WITHOUT: held["without"]} if held["without"] else {})
    runs = unpacked(row.records, case, results)
    charts: dict[str, Draw] = {
        "displacement": lambda of: hybrid_time(runs, of),
        "response": lambda of: hybrid_response(runs, of),
    }
    if held["map"]:
        charts["map"] = lambda style: share_map_chart(_map(held["map"]), case, held["result"]["controller"], style)
    if worth := held.get("feedforward"):
        charts["feedforward"] = lambda style: feedforward_figure(Followed.from_json(worth), style)
    return _drawn(context, ("hybrid", simulation), charts, name, kind, style)


def of_what_if(
    context: Context, fit: str, request: WhatIfRequest, name: str, kind: str, style: Style
) -> tuple[bytes, str]:
    """A figure of a changed machine: `response`, and `root-locus` where it has a loop."""
    found = asked_machines.what_if(context, fit, request)
    charts: dict[str, Draw] = {"response": lambda style: what_if_response(found, style)}
    if found.locus is not None:
        charts["root-locus"] = lambda style: root_locus(found, style)
    return _drawn(context, ("what-if", fit, request.model_dump_json()), charts, name, kind, style)


def of_track(
    context: Context, matrix: str, run: str | None, noise: str | None, name: str, kind: str, style: Style
) -> tuple[bytes, str]:
    """The figure of a run that is followed: `tracking`."""

    def followed(style: Look) -> Chart:
        return tracking_chart(*tracking.track(context, matrix, run, noise), style)

    return _drawn(context, ("track", matrix, run or "", noise or ""), {"tracking": followed}, name, kind, style)


def _drawn(
    context: Context, of: tuple[str, ...], charts: Mapping[str, Draw], name: str, kind: str, style: Style
) -> tuple[bytes, str]:
    """A figure as bytes and their media type, from memory where it was drawn lately. Raises Failure 404, Unusable."""
    if name not in charts:
        raise Failure(404, "no-such-figure", f"no figure {name!r}", "figure", f"use {', '.join(charts)}")
    if kind not in MEDIA:
        raise Failure(404, "no-such-format", f"no figures as {kind!r}", "figure", f"use {', '.join(MEDIA)}")
    key = (str(context.storage.folder), *of, name, kind, *style)
    return _figures.get(key, lambda: render(charts[name](look(*style)), kind)), MEDIA[kind]


def _map(held: Mapping[str, list[object]]) -> ShareMap:
    """The map again, of its JSON."""
    tables = {name: np.array(held[name], dtype=float) for name in ("reference_rms", "tracking_rms", "critical_delay")}
    return ShareMap(np.array(held["mass"]), np.array(held["stiffness"]), np.array(held["stable"]), **tables)
