"""Stability and score of a hybrid simulation over the shares of mass and stiffness that are physical."""

from __future__ import annotations

import altair as alt
import numpy as np

from ident.figures.chart_template import unchecked
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Row, datasets
from ident.figures.subjects import Simulated
from ident.figures.theme import Look
from ident.hybrid.case import Case
from ident.hybrid.share_map import ShareMap

_LEAST = 1e-4  # the colours of a score end here


def share_map_chart(found: ShareMap, case: Case, controller: str, look: Look) -> Chart:
    """`reference_rms` (measured against reference, %) in colour on a logarithmic scale; a cross: unstable."""
    with unchecked():
        tables = {"map": _rows(found)}
        x = alt.X("k:O", axis=alt.Axis(title="Physical share of the stiffness (%)", labelAngle=0, format=".0f"))
        y = alt.Y(
            "m:O",
            axis=alt.Axis(title="Physical share of the mass (%)", format=".0f", labelFlush=False),
            sort="descending",
        )
        scale = alt.Scale(type="log", range=list(look.ramp))
        base = alt.Chart(alt.NamedData("map"), width=look.across(520), height=look.across(440)).encode(x=x, y=y)
        colour = alt.Color("s:Q", scale=scale, legend=alt.Legend(title="Error (%)"))
        squares = base.transform_filter("datum.s != null").mark_rect().encode(color=colour)
        crosses = base.transform_filter("!datum.ok").mark_point(
            shape="cross", angle=45, size=60, color=look.ink, filled=True
        )
        count, whole = int(found.stable.sum()), found.stable.size
        told = [f"controller {controller}; stable at {count} of {whole} pairs of shares", "cross: unstable"]
        title = alt.TitleParams(f"{case.name} · measured against reference displacement", subtitle=told)
        chart: Chart = alt.layer(squares, crosses, title=title, datasets=datasets(tables)).configure(**look.config())
    return chart


def _rows(found: ShareMap) -> list[Row]:
    rows: list[Row] = []
    for i, m in enumerate(found.masses):
        for j, k in enumerate(found.stiffnesses):
            ok, score = bool(found.stable[i, j]), float(found.reference_rms[i, j])
            shown = float(f"{100 * max(score, _LEAST):.4g}") if ok and np.isfinite(score) else None
            rows.append({"m": round(100 * float(m), 2), "k": round(100 * float(k), 2), "s": shown, "ok": ok})
    return rows


def _drawn(of: Simulated, look: Look, _: Options) -> Chart:
    assert of.share_map is not None
    return share_map_chart(of.share_map, of.case, of.controller, look)


SHARE_MAP = Drawing(
    "map", "Stability over the physical share", Simulated, _drawn, there=lambda of: of.share_map is not None
)
