"""What the model lacks as a function of what moves inside it: a dead zone or dry friction can be seen."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

import altair as alt

from ident.errors import Unusable
from ident.figures import words
from ident.figures.look import Look
from ident.figures.render import Chart, Panel, datasets
from ident.figures.thin import significant
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.residuals.curves import Curve

SHOWN = 4
_WIDTH, _HEIGHT = 340, 210
_SMALL = 0.6  # of the usual width: then it stands beside words that say what it is
_MEASURED, _CANDIDATE = "seen in the residual, 95 % band", "predicted by"


def residual_curve(
    found: Sequence[Curve],
    actuator: Actuator,
    fit: FitResult,
    look: Look,
    *,
    candidate: Sequence[Curve] = (),
    candidate_name: str = "the candidate",
    view: str | None = None,
    runs: str = "",
) -> Chart:
    """The four curves that explain most of the residual, or the one called `view`, each with its 95 % band.

    `candidate` are the curves that another model predicts, drawn dashed. Raises Unusable where there is no curve.
    """
    shown = [curve for curve in found if view in (None, "", curve.name)][:SHOWN]
    if not shown:
        raise _nothing(view, [curve.name for curve in found])
    other = {curve.name: curve for curve in candidate}
    names = [_MEASURED, f"{_CANDIDATE} {candidate_name}"] if other else [_MEASURED]
    tables = {curve.name: _rows(curve, other.get(curve.name), names) for curve in shown}
    wide = len(shown) == 1
    panels = [_panel(curve, names, look, wide) for curve in shown]
    small = look.share < _SMALL
    title = alt.TitleParams(
        words.headline(actuator, "what the model lacks, against its own signals"),
        subtitle=[
            words.verdict(fit),
            f"{runs} · percentage: share of the residual's power that the curve takes off,",
            "on stretches it was not fitted to",
        ],
    )
    heading = {} if small else {"title": title}
    chart: Chart = (
        alt.concat(*panels, columns=2, spacing={"row": 26, "column": 34}, datasets=datasets(tables), **heading)
        .resolve_scale(color="shared")
        .configure(**look.config())
    )
    return chart


def _nothing(view: str | None, known: Sequence[str]) -> Unusable:
    if not known:
        what = "the model has no inner signals to draw a residual against"
        return Unusable("no-such-curve", what, "figure residual-curve", "use another model")
    return Unusable("no-such-curve", f"no curve {view!r}", "figure residual-curve", f"use {', '.join(known)}")


def _rows(curve: Curve, other: Curve | None, names: Sequence[str]) -> list[dict[str, Any]]:
    """x, y, l and h in the printed units, s the series."""
    along, across = _scales(curve)
    rows = _series(curve, along, across, names[0])
    if other is not None:
        rows += [{key: row[key] for key in ("x", "y", "s")} for row in _series(other, along, across, names[1])]
    return rows


def _series(curve: Curve, along: float, across: float, name: str) -> list[dict[str, Any]]:
    table = zip(*(significant([f * v for v in values], 4) for f, values in _columns(curve, along, across)), strict=True)
    return [{"x": x, "y": y, "l": low, "h": high, "s": name} for x, y, low, high in list(table)[1:-1]]


def _columns(curve: Curve, along: float, across: float) -> list[tuple[float, Sequence[float]]]:
    return [(along, curve.x), (across, curve.y), (across, curve.lower), (across, curve.upper)]


def _scales(curve: Curve) -> tuple[float, float]:
    """What brings both axes into readable units; the outermost knots are off the drawing."""
    inner = slice(1, -1)
    return words.engineering(curve.x[inner], curve.x_unit)[0], words.engineering(_extent(curve), curve.y_unit)[0]


def _extent(curve: Curve) -> tuple[float, ...]:
    return (*curve.lower[1:-1], *curve.upper[1:-1])


def _panel(curve: Curve, names: Sequence[str], look: Look, wide: bool) -> Panel:
    x_unit = words.engineering(curve.x[1:-1], curve.x_unit)[1]
    y_unit = words.engineering(_extent(curve), curve.y_unit)[1]
    across = _axis(words.axis(curve.missing, y_unit), 5)
    x = alt.X("x:Q", scale=alt.Scale(zero=False, nice=False), axis=_axis(words.axis(curve.against, x_unit), 6))
    y = alt.Y("y:Q", scale=alt.Scale(zero=True), axis=across)
    colours = [look.series[0], look.series[1]][: len(names)]
    legend = alt.Legend(
        title=None,
        orient="bottom",
        symbolType="stroke",
        symbolStrokeWidth=2,
        symbolOpacity=1,
        labelLimit=500,
        columns=1 if look.share < _SMALL else 2,
    )
    colour = alt.Color("s:N", scale=alt.Scale(domain=list(names), range=colours), legend=legend)
    base = alt.Chart(alt.NamedData(curve.name)).encode(x=x)
    seen = base.transform_filter(f"datum.s == '{names[0]}'")
    layers = [
        alt.Chart(alt.NamedData(curve.name)).mark_rule(color=look.faint, strokeWidth=0.8).encode(y=alt.datum(0)),
        seen.mark_area(opacity=0.25).encode(y=alt.Y("l:Q", axis=across), y2="h:Q", color=colour),
        seen.mark_line(strokeWidth=1.8, point=alt.OverlayMarkDef(size=22)).encode(
            y=y, color=colour, tooltip=_tooltip(curve, x_unit, y_unit)
        ),
    ]
    if len(names) > 1:
        predicted = base.transform_filter(f"datum.s != '{names[0]}'")
        layers.append(predicted.mark_line(strokeWidth=2, strokeDash=[6, 4]).encode(y=y, color=colour))
    width, height = (640, 340 if look.share >= _SMALL else 200) if wide else (_WIDTH, _HEIGHT)
    hint = textwrap.wrap(curve.shows, look.across(95 if wide else 54))
    hint += [""] * (2 - len(hint))  # titles of one height: the panels of a row stand side by side
    title = alt.TitleParams(
        f"{curve.name.capitalize()}: {_share(curve)}",
        fontSize=12, subtitle=hint, subtitleFontSize=11, subtitleLineHeight=13, offset=8, frame="group",
    )  # fmt: skip
    panel: Panel = alt.layer(*layers, width=look.across(width), height=height, title=title)
    return panel


def _share(curve: Curve) -> str:
    return f"explains {100 * curve.explained:.0f} %" if curve.explained > 0.005 else "explains nothing"


def _axis(title: str, ticks: int) -> alt.Axis:
    return alt.Axis(title=title, tickCount=ticks, format=".4~g")


def _tooltip(curve: Curve, x_unit: str, y_unit: str) -> list[alt.Tooltip]:
    named: Mapping[str, str] = {
        "x": words.axis(curve.against, x_unit), "y": words.axis(curve.missing, y_unit), "l": "Lower", "h": "Upper",
    }  # fmt: skip
    return [alt.Tooltip(f"{field}:Q", title=title, format=".3g") for field, title in named.items()]
