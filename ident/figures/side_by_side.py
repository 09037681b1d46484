"""Several fits in one plot: the error of every run, a colour a fit."""

from __future__ import annotations

from typing import Any

import altair as alt

from ident.comparison.side_by_side import SideBySide
from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, datasets
from ident.figures.subjects import Compared
from ident.figures.theme import Look
from ident.matrix import Actuator
from ident.words.titles import DATA

_STEP = 15  # pixels a run


def side_by_side(of: SideBySide, actuator: Actuator, look: Look) -> Chart:
    """Runs from top to bottom, the worst of the first fit first; errors (%) on a logarithmic axis.

    `actuator` is the one whose runs they are, where the fits do not say whose they are.
    """
    titles = list(of.titles)
    first = of.columns[0].runs
    order = sorted(of.uses, key=lambda run: -first.get(run, 0.0))
    rows: list[dict[str, Any]] = [
        {"r": run, "u": DATA[of.uses[run]], "e": float(f"{100 * error:.4g}"), "f": title}
        for column, title in zip(of.columns, titles, strict=True)
        for run, error in column.runs.items()
    ]
    x = alt.X(
        "e:Q",
        axis=alt.Axis(title="Error, eq. 17 (%)", format="~r", tickCount=6),
        scale=alt.Scale(type="log", nice=False, padding=10),
    )
    y = alt.Y("r:N", sort=order, axis=alt.Axis(title=None, grid=True, ticks=False, labelLimit=200))
    legend = alt.Legend(orient="bottom", columns=1, labelLimit=560, symbolType="circle")
    colours = alt.Scale(domain=titles, range=list(look.series[: len(titles)]))
    colour = alt.Color("f:N", title=None, sort=titles, scale=colours, legend=legend)
    marks = alt.Legend(orient="bottom", symbolFillColor=look.ink, symbolStrokeColor=look.ink)
    shapes = alt.Scale(domain=[DATA["fit"], DATA["verify"]], range=["circle", "diamond"])
    shape = alt.Shape("u:N", title="Data", scale=shapes, legend=marks)
    tip = [alt.Tooltip("r:N", title="Run"), alt.Tooltip("f:N", title="Fit"), alt.Tooltip("e:Q", title="Error (%)")]
    dots = alt.Chart(alt.NamedData("errors")).mark_point(size=42, opacity=1, filled=True)
    errors = ", ".join(f"{column.name} {words.error(column.words['fit'])}" for column in of.columns)
    title = alt.TitleParams(_headline(of, actuator), subtitle=[f"error on estimation data: {errors}"])
    chart: Chart = alt.layer(
        dots.encode(x=x, y=y, color=colour, shape=shape, tooltip=tip),
        width=look.across(480),
        height=_STEP * len(order),
        datasets=datasets({"errors": rows}),
        title=title,
    ).configure(**look.config())
    return chart


def _headline(of: SideBySide, actuator: Actuator) -> str:
    """The actuators that the fits are of, and what is drawn."""
    what = f"{len(of.columns)} fits, run by run"
    return f"{' and '.join(of.serials)} · {what}" if of.serials else words.headline(actuator, what)


def _drawn(of: Compared, look: Look, _: Options) -> Chart:
    return side_by_side(of.fits, of.actuator, look)


SIDE_BY_SIDE = Drawing("side-by-side", "Several fits", Compared, _drawn)
