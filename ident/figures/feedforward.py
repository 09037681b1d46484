"""A reference followed with and without feedforward: positions, errors, and the band of the Monte Carlo."""

from __future__ import annotations

from typing import Any

import altair as alt
import numpy as np

from ident.figures.look import Look
from ident.figures.render import Chart, Panel
from ident.hybrid.feedforward import Tracked

_POINTS = 600
ALONE, BOTH, BAND = "feedback alone", "with feedforward", "band of 90 % of the draws"


def feedforward_figure(tracked: Tracked, look: Look, title: str = "") -> Chart:
    """Positions (mm) above, errors (mm) with feedforward and their band below, against time (s)."""
    said = f"gain {tracked.gain:.3g} V/m, {tracked.margin:.2g} dB below the stability limit of {tracked.limit:.3g} V/m"
    headed = alt.TitleParams(title or "Following a reference", subtitle=[said])
    panels = alt.vconcat(_positions(tracked, look), _errors(tracked, look), title=headed)
    chart: Chart = panels.configure(**look.config())
    return chart


def _positions(tracked: Tracked, look: Look) -> Panel:
    r = tracked.reference
    shown = {"reference": r, ALONE: r - tracked.feedback, BOTH: r - tracked.both}
    return _lines(tracked, shown, look, "Position (mm)", [look.ink, *look.series[:2]])


def _errors(tracked: Tracked, look: Look) -> Panel:
    low, high = 1e3 * tracked.band()
    places = _places(len(low))
    rows = [_rounded({"t": n / tracked.sample_rate, "low": low[n], "high": high[n]}, BAND) for n in places]
    x = alt.X("t:Q", title="Time (s)")
    y, colour = alt.Y("low:Q", title="Error (mm)"), _colour([BAND, BOTH], list(look.series[1:3])[::-1])
    drawn = alt.Chart(alt.InlineData(values=rows)).mark_area(opacity=0.3)
    area = drawn.encode(x=x, y=y, y2="high:Q", color=colour)
    lines = _lines(tracked, {BOTH: tracked.both}, look, "Error (mm)", [], [BAND, BOTH])
    panel: Panel = alt.layer(area, lines)
    return panel


def _lines(
    tracked: Tracked, shown: dict[str, Any], look: Look, unit: str, colours: list[str], names: list[str] | None = None
) -> Panel:  # fmt: skip
    rows = [
        _rounded({"t": n / tracked.sample_rate, "y": 1e3 * signal[n]}, name)
        for name, signal in shown.items()
        for n in _places(len(signal))
    ]
    colour = _colour(names or list(shown), colours or list(look.series[1:3])[::-1])
    panel: Panel = (
        alt.Chart(alt.InlineData(values=rows))
        .mark_line(strokeWidth=1.2)
        .encode(x=alt.X("t:Q", title="Time (s)"), y=alt.Y("y:Q", title=unit), color=colour)
        .properties(width=look.across(560), height=200)
    )
    return panel


def _colour(names: list[str], colours: list[str]) -> alt.Color:
    return alt.Color(
        "n:N", title=None, scale=alt.Scale(domain=names, range=colours), legend=alt.Legend(orient="bottom")
    )


def _places(count: int) -> Any:
    return np.unique(np.linspace(0, count - 1, min(count, _POINTS)).astype(int))


def _rounded(row: dict[str, float], name: str) -> dict[str, Any]:
    return {**{key: float(f"{value:.5g}") for key, value in row.items()}, "n": name}
