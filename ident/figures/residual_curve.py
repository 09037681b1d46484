"""What the model lacks as a function of what moves inside it: a dead zone or dry friction can be seen."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import altair as alt

from ident.errors import Unusable
from ident.figures import words
from ident.figures.candidate import called, candidate_of
from ident.figures.chart_template import Filled, Frame, blank, frame
from ident.figures.drawing import Drawing, Options
from ident.figures.options import BAND, CANDIDATE, MANY, VIEW
from ident.figures.render import Panel
from ident.figures.run_selection import RUNS, chosen, filter_in
from ident.figures.selection import band_of
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import significant
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.residuals.curves import Curve

SHOWN = 4
_WIDTH, _HEIGHT = 340, 210
_PERCENTAGE = "percentage: share of the residual variance that the curve explains (cross-validated)"
_MEASURED, _CANDIDATE = "from the residual, 95 % band", "predicted by"


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
) -> Filled:
    """The four curves that explain most of the residual, or the one called `view`, each with its 95 % band.

    `candidate` are the curves that another model predicts, drawn dashed. Raises Unusable where there is no curve.
    """
    shown = [curve for curve in found if view in (None, "", curve.name)][:SHOWN]
    if not shown:
        raise _nothing(view, [curve.name for curve in found])
    other = {curve.name: curve for curve in candidate}
    names = [_MEASURED, f"{_CANDIDATE} {candidate_name}"] if other else [_MEASURED]
    values = {
        "headline": words.headline(actuator, "missing nonlinearity versus internal signals"),
        "told": [words.verdict(fit), runs, *textwrap.wrap(_PERCENTAGE, look.across(130))],
        "names": names,
    }
    hints = _hints([curve.shows for curve in shown], look)
    for place, (curve, hint) in enumerate(zip(shown, hints, strict=True)):
        along, across = _axes(curve)
        written = {
            "name": f"{_heading(curve.name)}: {_share(curve)}",
            "hint": hint,
            "along": along,
            "across": across,
        }
        values |= {f"{name}{place}": value for name, value in written.items()}
    tables = {f"curve{i}": _rows(curve, other.get(curve.name), names) for i, curve in enumerate(shown)}
    return Filled(_frame(len(shown), bool(other), look), tables, values)


@lru_cache(maxsize=32)
def _frame(count: int, compared: bool, look: Look) -> Frame:
    panels = [_panel(place, compared, look, wide=count == 1) for place in range(count)]
    title = alt.TitleParams(blank("headline"), subtitle=blank("told"))
    heading = {} if look.small else {"title": title}
    chart = alt.concat(*panels, columns=2, spacing={"row": 26, "column": 24}, **heading)
    return frame(chart.resolve_scale(color="shared").configure(**look.config()))


def _nothing(view: str | None, known: Sequence[str]) -> Unusable:
    if not known:
        what = "the model has no inner signals to draw a residual against"
        return Unusable("no-such-curve", what, "figure residual-curve", "use another model")
    return Unusable("no-such-curve", f"no curve {view!r}", "figure residual-curve", f"use {', '.join(known)}")


def _rows(curve: Curve, other: Curve | None, names: Sequence[str]) -> list[dict[str, Any]]:
    """x, y, l and h in the printed units, s the series, d the point in words."""
    along, across = _scales(curve)
    rows = [row | {"d": _point(row, curve)} for row in _series(curve, along, across, names[0])]
    if other is not None:
        rows += [{key: row[key] for key in ("x", "y", "s")} for row in _series(other, along, across, names[1])]
    return rows


def _point(row: Mapping[str, Any], curve: Curve) -> str:
    x, y, low, high = (f"{row[field]:.3g}".replace("-", "−") for field in "xylh")
    along, across = _axes(curve)
    return f"{across}: {y}, 95 % from {low} to {high}; {along}: {x}"


def _axes(curve: Curve) -> tuple[str, str]:
    """What both axes show, with their units."""
    x_unit = words.engineering(curve.x[1:-1], curve.x_unit)[1]
    y_unit = words.engineering(_extent(curve), curve.y_unit)[1]
    return words.axis(curve.against, x_unit), words.axis(curve.missing, y_unit)


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


def _hints(texts: Sequence[str], look: Look) -> list[list[str]]:
    """What each panel may show, in lines of its width; all of one height, since the panels stand side by side."""
    hints = [textwrap.wrap(text, look.across(105 if len(texts) == 1 else 60)) for text in texts]
    most = max(map(len, hints))
    return [hint + [""] * (most - len(hint)) for hint in hints]


def _panel(place: int, compared: bool, look: Look, *, wide: bool) -> Panel:
    data, across = alt.NamedData(f"curve{place}"), _axis(blank(f"across{place}"), 5)
    x = alt.X("x:Q", scale=alt.Scale(zero=False, nice=False), axis=_axis(blank(f"along{place}"), 6))
    y = alt.Y("y:Q", scale=alt.Scale(zero=True), axis=across)
    legend = alt.Legend(
        title=None,
        orient="bottom",
        symbolType="stroke",
        symbolStrokeWidth=2,
        symbolOpacity=1,
        labelLimit=500,
        columns=1 if look.small else 2,
    )
    scale = alt.Scale(domain=blank("names"), range=list(look.series[: 1 + compared]))
    colour = alt.Color("s:N", scale=scale, legend=legend)
    base = alt.Chart(data).encode(x=x)
    seen = base.transform_filter(f"datum.s == '{_MEASURED}'")
    layers = [
        alt.Chart(data).mark_rule(color=look.faint, strokeWidth=0.8).encode(y=alt.datum(0)),
        seen.mark_area(opacity=0.25).encode(y=alt.Y("l:Q", axis=across), y2="h:Q", color=colour),
        seen.mark_line(strokeWidth=1.8, point=alt.OverlayMarkDef(size=22)).encode(y=y, color=colour, tooltip="d:N"),
    ]
    if compared:
        predicted = base.transform_filter(f"datum.s != '{_MEASURED}'")
        layers.append(predicted.mark_line(strokeWidth=2, strokeDash=[6, 4]).encode(y=y, color=colour))
    width, height = (640, 200 if look.small else 340) if wide else (_WIDTH, _HEIGHT)
    title = alt.TitleParams(
        blank(f"name{place}"),
        subtitle=blank(f"hint{place}"),
        fontSize=12,
        subtitleFontSize=11,
        subtitleLineHeight=13,
        offset=8,
        frame="group",
    )
    panel: Panel = alt.layer(*layers, width=look.across(width), height=height, title=title)
    return panel


def _heading(name: str) -> str:
    """A name in words begins with a capital; one of symbols, as ``w(x)/w``, stays as it is."""
    return name if "(" in name else f"{name[:1].upper()}{name[1:]}"


def _share(curve: Curve) -> str:
    return f"explains {100 * curve.explained:.0f} %" if curve.explained > 0.005 else "explains nothing"


def _axis(title: Any, ticks: int) -> alt.Axis:
    return alt.Axis(title=title, tickCount=ticks, format=".4~g")


def _drawn(study: Study, look: Look, options: Options) -> Filled:
    matrix, view, band, other = study.matrix, options.get("view") or None, band_of(options), candidate_of(options)
    some = any(map(options.get, RUNS))
    shown = chosen(matrix, filter_in(options)) if some else matrix.of_use("fit") or matrix.runs
    runs = words.describe(shown[0]) if len(shown) == 1 else f"{len(shown)} runs"
    return residual_curve(
        study.curves(shown, view, band),
        matrix.actuator,
        study.fit,
        look,
        candidate=study.curves(shown, view, band, other) if other else (),
        view=view,
        runs=f"{runs}, {band.words}" if band else runs,
        candidate_name=called(other, study.fit),
    )


RESIDUAL_CURVE = Drawing(
    "residual-curve", "Missing characteristic", Study, _drawn, (VIEW, *MANY, *BAND, CANDIDATE), share=0.63
)
