"""A reference followed with and without feedforward: positions, errors, and the band of the Monte Carlo."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import altair as alt
import numpy as np
from numpy.typing import NDArray

from ident.figures.look import Look
from ident.figures.render import Chart, Panel
from ident.hybrid.feedforward import Tracked

Array = NDArray[np.float64]
_POINTS = 600
REFERENCE, ALONE, BOTH, BAND = "reference", "feedback alone", "with feedforward", "band of 90 % of the draws"


def feedforward_figure(tracked: Tracked, look: Look, title: str = "") -> Chart:
    """Positions (mm) above, errors (mm) with feedforward and their band below, against time (s)."""
    said = f"gain {tracked.gain:.3g} V/m, {tracked.margin:.2g} dB below the stability limit of {tracked.limit:.3g} V/m"
    headed = alt.TitleParams(title or "Following a reference", subtitle=[said])
    panels = alt.vconcat(_positions(tracked, look), _errors(tracked, look), title=headed)
    chart: Chart = panels.configure(**look.config())
    return chart


def _positions(tracked: Tracked, look: Look) -> Panel:
    r = tracked.reference
    return _lines(tracked, {REFERENCE: r, ALONE: r - tracked.feedback, BOTH: r - tracked.both}, look, "Position (mm)")


def _errors(tracked: Tracked, look: Look) -> Panel:
    low, high = 1e3 * tracked.band()
    rows = [
        _rounded({"t": n / tracked.sample_rate, "low": low[n], "high": high[n]}, BAND) for n in _places(len(low))
    ]  # fmt: skip
    x, y = alt.X("t:Q", title="Time (s)"), alt.Y("low:Q", title="Error (mm)")
    area = alt.Chart(alt.InlineData(values=rows)).mark_area(opacity=0.35)
    band = area.encode(x=x, y=y, y2="high:Q", color=_colour(look))
    panel: Panel = alt.layer(band, _lines(tracked, {BOTH: tracked.both}, look, "Error (mm)"))
    return panel


def _lines(tracked: Tracked, shown: Mapping[str, Array], look: Look, unit: str) -> Panel:
    rows = [
        _rounded({"t": n / tracked.sample_rate, "y": 1e3 * signal[n]}, name)
        for name, signal in shown.items()
        for n in _places(len(signal))
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
    return alt.Color("n:N", title=None, scale=scale, legend=alt.Legend(orient="bottom"))


def _places(count: int) -> NDArray[np.intp]:
    return np.unique(np.linspace(0, count - 1, min(count, _POINTS)).astype(np.intp))


def _rounded(row: Mapping[str, float], name: str) -> dict[str, Any]:
    return {**{key: float(f"{value:.5g}") for key, value in row.items()}, "n": name}
