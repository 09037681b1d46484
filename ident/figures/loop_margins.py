"""The open loop of a position regulator around a servo-actuator: |L| and phase at each amplitude of its play."""

from __future__ import annotations

from typing import Any

import altair as alt

from ident.bench.position_loop import AmplitudeMargin, PositionLoop
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart
from ident.figures.theme import Look
from ident.words.percent import percent

_LOWEST = -360.0
"""°: a loop that turns farther is of no interest to its margins."""
_STEP = 10
"""Points of the loop for each that is drawn: a line of 200 points is smooth."""


def loop_margins(result: PositionLoop, look: Look) -> Chart:
    """|L| (dB) and phase (°) over frequency (Hz), a line an amplitude; where L = −1 lies the margins are zero."""
    moving = [one for one in result.amplitudes if not one.stands]
    rows = [row for one in moving for row in _rows(one)]
    swings = [
        {"f": one.oscillation_frequency, "m": -one.gain_margin, "p": -180.0, "a": _named(one)}
        for one in moving
        if one.gain_margin is not None
    ]
    size = {"width": look.across(640)}
    magnitude = alt.layer(_lines(rows, "m", "|L| (dB)", look), _level(0.0, look), *_marks(swings, "m", look))
    quarters = alt.Axis(values=list(range(-360, 1, 90)))
    phase = alt.layer(
        _lines(rows, "p", "Phase of L (°)", look, quarters), _level(-180.0, look), *_marks(swings, "p", look)
    )
    panels = [magnitude.properties(height=230, **size), phase.properties(height=170, **size)]
    subtitle = ["dots: the phase is −180°; below 0 dB there the distance is the gain margin"]
    title = alt.TitleParams("Open position loop, by amplitude of the current at the play", subtitle=subtitle)
    chart: Chart = alt.vconcat(*panels, title=title).configure(**look.config())
    return chart


def _named(one: AmplitudeMargin) -> str:
    return f"{percent(one.amplitude)} of rated current"


def _rows(one: AmplitudeMargin) -> list[dict[str, Any]]:
    columns = zip(one.frequency[::_STEP], one.magnitude[::_STEP], one.angle[::_STEP], strict=True)
    return [
        {"f": float(f"{f:.4g}"), "m": round(m, 3), "p": round(p, 2), "a": _named(one)}
        for f, m, p in columns
        if p > _LOWEST
    ]


def _lines(rows: list[dict[str, Any]], field: str, title: str, look: Look, axis: alt.Axis | None = None) -> Any:
    colour = alt.Color(
        "a:N",
        title=None,
        sort=None,
        scale=alt.Scale(range=list(look.series)),
        legend=alt.Legend(orient="bottom", labelLimit=300),
    )
    return (
        alt.Chart(alt.InlineData(values=rows))
        .mark_line(strokeWidth=1.6)
        .encode(
            x=alt.X("f:Q", title="Frequency (Hz)", scale=alt.Scale(type="log", nice=False)),
            color=colour,
            y=alt.Y(f"{field}:Q", title=title, axis=axis or alt.Axis()),
            tooltip=["a:N", "f:Q", f"{field}:Q"],
        )
    )


def _level(value: float, look: Look) -> Any:
    return (
        alt.Chart(alt.InlineData(values=[{"y": value}])).mark_rule(color=look.faint, strokeDash=[4, 4]).encode(y="y:Q")
    )


def _marks(rows: list[dict[str, Any]], field: str, look: Look) -> list[Any]:
    base = alt.Chart(alt.InlineData(values=rows)).mark_circle(size=60, color=look.ink)
    return [base.encode(x="f:Q", y=f"{field}:Q", tooltip=["a:N", "f:Q"])] if rows else []


def _drawn(of: PositionLoop, look: Look, _: Options) -> Chart:
    return loop_margins(of, look)


LOOP_MARGINS = Drawing("margins", "Open position loop", PositionLoop, _drawn)
