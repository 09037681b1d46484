"""Stability of a hybrid simulation with several actuators over the delays of two of them."""

from __future__ import annotations

import altair as alt

from ident.figures.chart_template import unchecked
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Row, datasets
from ident.figures.subjects import Coupled
from ident.figures.theme import Look
from ident.hybrid.coupled_stability import DelayMap


def delay_map_chart(found: DelayMap, case: str, look: Look) -> Chart:
    """A filled square where the sampled loop is stable, a cross where it is not; delays in samples."""
    with unchecked():
        x = alt.X("b:O", axis=alt.Axis(title=f"Delay of {found.names[1]} (samples)", labelAngle=0))
        y = alt.Y(
            "a:O", axis=alt.Axis(title=f"Delay of {found.names[0]} (samples)", labelFlush=False), sort="descending"
        )
        base = alt.Chart(alt.NamedData("map"), width=look.across(520), height=look.across(440)).encode(x=x, y=y)
        squares = base.transform_filter("datum.ok").mark_rect(color=look.series[0])
        crosses = base.transform_filter("!datum.ok").mark_point(
            shape="cross", angle=45, size=60, color=look.ink, filled=True
        )
        told = [
            f"stable at {int(found.stable.sum())} of {found.stable.size} pairs of delays",
            "filled: stable; cross: unstable",
        ]
        title = alt.TitleParams(f"{case} · stability over the delays of the commands", subtitle=told)
        tables = {"map": _rows(found)}
        chart: Chart = alt.layer(squares, crosses, title=title, datasets=datasets(tables)).configure(**look.config())
    return chart


def _rows(found: DelayMap) -> list[Row]:
    return [
        {"a": int(a), "b": int(b), "ok": bool(found.stable[i, j])}
        for i, a in enumerate(found.first)
        for j, b in enumerate(found.second)
    ]


def _drawn(of: Coupled, look: Look, _: Options) -> Chart:
    return delay_map_chart(of.delay_map, of.case, look)


DELAY_MAP = Drawing("delay-map", "Stability over the delays", Coupled, _drawn)
