"""A reference followed with and without feedforward: positions, errors, and the band of the Monte Carlo."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import altair as alt

from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel
from ident.figures.subjects import Simulated
from ident.figures.theme import Look
from ident.hybrid.feedforward_tracking import FeedforwardTracking, rounded
from ident.words.message import message

REFERENCE, ALONE, BOTH, BAND = "reference", "feedback alone", "with feedforward", "band of 90 % of the draws"


def feedforward_figure(followed: FeedforwardTracking, look: Look, title: str = "") -> Chart:
    """Positions (mm) above, errors (mm) with feedforward and their band below, against time (s).

    The reference is dashed over the other lines: with feedforward the machine is on it.
    """
    facts = [followed.gain_said]
    if followed.drawn_ratio is not None:
        facts.append(message("feedforward.error", ratio=rounded(followed.drawn_ratio), draws=followed.draws))
    headed = alt.TitleParams(title or "Following a reference", subtitle=words.wrapped(list(map(str, facts)), look))
    panels = alt.vconcat(_positions(followed, look), _errors(followed, look), title=headed)
    chart: Chart = panels.configure(**look.config())
    return chart


def _positions(followed: FeedforwardTracking, look: Look) -> Panel:
    r = followed.reference
    alone, both = ([x - e for x, e in zip(r, error, strict=True)] for error in (followed.feedback, followed.both))
    return _lines(followed, {ALONE: alone, BOTH: both, REFERENCE: r}, look, "Position (mm)")


def _errors(followed: FeedforwardTracking, look: Look) -> Panel:
    edges = zip(followed.t, followed.low, followed.high, strict=True)
    rows = [_rounded({"t": t, "low": 1e3 * low, "high": 1e3 * high}, BAND) for t, low, high in edges]
    x, y = alt.X("t:Q", title="Time (s)"), alt.Y("low:Q", title="Error (mm)")
    area = alt.Chart(alt.InlineData(values=rows)).mark_area(opacity=0.35)
    band = area.encode(x=x, y=y, y2="high:Q", color=_colour(look))
    panel: Panel = alt.layer(band, _lines(followed, {BOTH: followed.both}, look, "Error (mm)"))
    return panel


def _lines(followed: FeedforwardTracking, shown: Mapping[str, Sequence[float]], look: Look, unit: str) -> Panel:
    rows = [
        _rounded({"t": t, "y": 1e3 * y}, name)
        for name, signal in shown.items()
        for t, y in zip(followed.t, signal, strict=True)
    ]
    dashed = alt.condition(f"datum.n == '{REFERENCE}'", alt.value([6, 4]), alt.value([1, 0]))
    panel: Panel = (
        alt.Chart(alt.InlineData(values=rows))
        .mark_line(strokeWidth=1.4)
        .encode(
            x=alt.X("t:Q", title="Time (s)"),
            y=alt.Y("y:Q", title=unit),
            color=_colour(look),
            strokeDash=dashed,
            order="t:Q",
        )
        .properties(width=look.across(560), height=200)
    )
    return panel


def _colour(look: Look) -> alt.Color:
    """One scale for both panels, so that there is one legend."""
    colours = [look.ink, *look.series[:3]]
    scale = alt.Scale(domain=[REFERENCE, ALONE, BOTH, BAND], range=colours)
    return alt.Color(
        "n:N", title=None, scale=scale, legend=alt.Legend(orient="bottom", symbolType="stroke", symbolOpacity=1)
    )


def _rounded(row: Mapping[str, float], name: str) -> dict[str, Any]:
    return {**{key: float(f"{value:.5g}") for key, value in row.items()}, "n": name}


def _drawn(of: Simulated, look: Look, _: Options) -> Chart:
    assert of.feedforward is not None
    return feedforward_figure(of.feedforward, look)


FEEDFORWARD = Drawing(
    "feedforward", "Effect of the feedforward", Simulated, _drawn, there=lambda of: of.feedforward is not None
)
