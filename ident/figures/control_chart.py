"""Individuals and moving ranges of a process, with control limits, limits of the product and what is out of control."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt

from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel, datasets
from ident.figures.subjects import Charted
from ident.figures.theme import Look
from ident.statistics import ControlChart
from ident.words.message import message

Limits = tuple[float | None, float | None]
_WIDTH = 620
_TICKS = 20  # at most
_DASHES = {"centre": [1, 0], "control": [6, 4], "product": [2, 3]}


def control_chart(
    chart: ControlChart, quantity: str, unit: str, where: str, labels: Sequence[str], limits: Limits, look: Look
) -> Chart:
    """Individuals above, moving ranges below, in the order of production; a label a value.

    Dashed are the 3 σ limits, dotted the `limits` of the product. A value that breaks a rule of Western Electric, or a
    range beyond its limit, is marked.
    """
    given = [limit for limit in limits if limit is not None]
    factor, shown = words.engineering([*chart.values, *given], unit)
    broken = {signal.place: signal.text for signal in reversed(chart.signals)}
    wide = dict.fromkeys(chart.wide_ranges, "beyond the limit of ranges")
    ranges = dict(enumerate(chart.moving_ranges, 1))
    tables = {
        "individuals": _rows(dict(enumerate(chart.values)), labels, broken, factor),
        "ranges": _rows(ranges, labels, wide, factor),
        "individuals_lines": _lines(factor, [chart.centre], [chart.lower, chart.upper], given),
        "ranges_lines": _lines(factor, [chart.mean_range], [chart.upper_range], []),
    }
    sets = len(chart.values)
    above = _panel("individuals", words.axis(quantity, shown), sets, 230, look)
    below = _panel("ranges", words.axis("moving range", shown), sets, 110, look)
    said = message("chart.with_limits" if given else "chart.limits", marked=len(broken))
    title = alt.TitleParams(f"{quantity}, {where}: {len(chart.values)} sets", subtitle=[str(said)])
    made: Chart = alt.vconcat(above, below, title=title, datasets=datasets(tables)).configure(**look.config())
    return made


def _rows(
    values: dict[int, float], labels: Sequence[str], marked: dict[int, str], factor: float
) -> list[dict[str, Any]]:
    return [
        {
            "n": place + 1,
            "v": float(f"{factor * value:.6g}"),
            "of": labels[place],
            "why": marked.get(place, "in control"),
        }
        for place, value in values.items()
    ]


def _lines(factor: float, centre: list[float], control: list[float], product: list[float]) -> list[dict[str, Any]]:
    kinds = {"centre": centre, "control": control, "product": product}
    return [{"v": factor * value, "kind": kind} for kind, values in kinds.items() for value in values]


def _panel(name: str, title: str, sets: int, height: int, look: Look) -> Panel:
    """The values of a table over their place among the sets, with its lines."""
    ticks = list(range(1, sets + 1, -(-sets // _TICKS)))
    x = alt.X(
        "n:Q",
        axis=alt.Axis(title="set, in the order in which they were made", values=ticks, format="d"),
        scale=alt.Scale(nice=False, domain=[0.5, sets + 0.5]),
    )
    y = alt.Y("v:Q", axis=alt.Axis(title=title), scale=alt.Scale(zero=False))
    base = alt.Chart(alt.NamedData(name)).encode(x=x, y=y)
    tooltip = [
        alt.Tooltip("of:N", title="Set of"),
        alt.Tooltip("v:Q", title=title),
        alt.Tooltip("why:N", title="State"),
    ]
    # Seen where something is out of control; a layer of these alone would have no extent where there is none.
    seen = alt.condition("datum.why != 'in control'", alt.value(1), alt.value(0))
    dashes = alt.Scale(domain=list(_DASHES), range=list(_DASHES.values()))
    inks = alt.Scale(domain=list(_DASHES), range=[look.faint, look.faint, look.series[1]])
    lines = alt.Chart(alt.NamedData(f"{name}_lines")).encode(
        y=y,
        strokeDash=alt.StrokeDash("kind:N", scale=dashes, legend=None),
        color=alt.Color("kind:N", scale=inks, legend=None),
    )
    panel: Panel = alt.layer(
        lines.mark_rule(strokeWidth=1.3),
        base.mark_line(color=look.series[0], strokeWidth=1, opacity=0.5),
        base.mark_circle(color=look.series[0], size=24, opacity=1).encode(tooltip=tooltip),
        base.mark_point(color=look.series[1], size=90, strokeWidth=2, shape="diamond").encode(
            opacity=seen, tooltip=tooltip
        ),
        width=look.across(_WIDTH),
        height=height,
    )
    return panel


def _drawn(of: Charted, look: Look, _: Options) -> Chart:
    return control_chart(of.chart, of.quantity, of.unit, of.where, of.labels, of.limits, look)


CONTROL_CHART = Drawing("control-chart", "Control chart", Charted, _drawn)
