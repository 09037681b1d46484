"""τyr and kyr over time with their bands, as the tracking filter follows them (Strano, Terzo et al., Fig. 7)."""

from __future__ import annotations

from typing import Any

import altair as alt
import numpy as np

from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel, datasets
from ident.figures.subjects import Tracked
from ident.figures.theme import Look
from ident.figures.thinning import Real, significant
from ident.hybrid.tracked_run import Track
from ident.matrix import Actuator
from ident.words.number import trimmed
from ident.words.run_name import run_name

BAND = 1.96  # standard deviations of the 95 % band
_POINTS = 900
_SETTLED = 0.1  # of the record: the axis is made for what comes after the filter has found its way
_KNOWN = 0.1  # relative standard deviation
_RAREST = 3  # per cent at either end
_ROOM = 0.15  # of the range of an axis is left on either side


def tracking(tracked: Track, actuator: Actuator, look: Look) -> Chart:
    """Two panels over time, s: the time constant (ms) and the gain, each a line in its 95 % band."""
    clock = "s" if tracked.run.time_unit == "s" else "samples"
    factor, unit = (1e3, "ms") if clock == "s" else (1.0, "samples")
    places = np.unique(np.linspace(0, len(tracked.t) - 1, min(_POINTS, len(tracked.t))).astype(np.intp))
    series = {
        "tau": (factor * tracked.tau, factor * tracked.std_tau),
        "gain": (tracked.gain, tracked.std_gain),
    }
    t = tracked.t[places]
    ends = {name: _ends(*(part[places] for part in pair)) for name, pair in series.items()}
    tables = {name: _rows(t, value[places], BAND * std[places], ends[name]) for name, (value, std) in series.items()}
    title = alt.TitleParams(
        words.headline(actuator, f"tracking of {run_name(tracked.run.id)}"), subtitle=_told(tracked)
    )
    panels = (
        _panel("tau", words.axis("Time constant τyr", unit), None, ends["tau"], look, 0),
        _panel("gain", words.axis("Gain kyr", "–"), clock, ends["gain"], look, 1),
    )
    chart: Chart = alt.vconcat(*panels, title=title, spacing=10, datasets=datasets(tables)).configure(**look.config())
    return chart


def _told(tracked: Track) -> list[str]:
    """The last values, and the verdict."""
    said = tracked.verdict
    mean = "unknown" if said.nis_mean is None else trimmed(said.nis_mean)
    holds = "the first-order loop holds" if said.holds else "the first-order loop does not hold"
    return [
        f"{holds}; mean normalised innovation squared {mean}",
        "line: estimate · band: 95 %, as far as the loop holds",
    ]


def _ends(value: Real, std: Real) -> tuple[float, float]:
    """The ends of an axis: where the parameter lies while it is known to a tenth, without the rarest of it."""
    known = np.flatnonzero(std < _KNOWN * np.abs(value))
    settled = known[int(_SETTLED * len(known)) :] if len(known) else np.arange(len(value))
    low, high = np.percentile(value[settled], (_RAREST, 100 - _RAREST))
    wide = float(np.median(BAND * std[settled]))
    room = max(_ROOM * (high - low), 2 * wide, 0.02 * abs(high))
    return float(low - room), float(high + room)


def _rows(t: Real, value: Real, half: Real, ends: tuple[float, float]) -> list[dict[str, Any]]:
    """t time, v value, l and u the ends of its band, all within the axis: what is far off is drawn at its edge."""
    columns = (np.clip(part, *ends) for part in (value, value - half, value + half))
    rows = zip(np.round(t, 6).tolist(), *(significant(column) for column in columns), strict=True)
    return [{"t": a, "v": v, "l": low, "u": high} for a, v, low, high in rows]


def _panel(table: str, title: str, clock: str | None, ends: tuple[float, float], look: Look, place: int) -> Panel:
    axis = alt.Axis(labels=clock is not None, title=f"Time ({clock})" if clock else None, tickCount=8)
    x = alt.X("t:Q", scale=alt.Scale(nice=False), axis=axis)
    scale = alt.Scale(domain=significant(ends, 4), nice=False, zero=False)
    y = alt.Y("v:Q", scale=scale, axis=alt.Axis(title=title, tickCount=5))
    tips = [alt.Tooltip("t:Q", title="Time"), alt.Tooltip("v:Q", title=title)]
    base = alt.Chart(alt.NamedData(table))
    band = base.mark_area(opacity=0.25, color=look.series[place], clip=True).encode(
        x=x, y=alt.Y("l:Q", scale=scale), y2="u:Q"
    )
    line = base.mark_line(strokeWidth=1.5, color=look.series[place], clip=True).encode(x=x, y=y, tooltip=tips)
    panel: Panel = alt.layer(band, line).properties(width=look.across(720), height=190)
    return panel


def _drawn(of: Tracked, look: Look, _: Options) -> Chart:
    return tracking(of.track, of.actuator, look)


TRACKING = Drawing("tracking", "Tracking", Tracked, _drawn)
