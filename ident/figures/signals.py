"""The signals of some runs over time as they were measured: a panel a channel, a colour a run."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import altair as alt
import numpy as np

from ident.errors import Unusable
from ident.figures import words
from ident.figures.chart_template import Filled, Frame, blank, frame
from ident.figures.drawing import Drawing, Option, Options
from ident.figures.options import RUN, number
from ident.figures.render import Panel
from ident.figures.subjects import Recorded
from ident.figures.theme import Look
from ident.figures.thinning import Real, significant
from ident.figures.traces import Trace
from ident.matrix import Actuator
from ident.words.run_name import run_name
from ident.words.titles import title

MOST = 8  # runs in one figure: as many as there are colours
_BINS = 350  # parts of a panel of which the smallest and the largest sample are drawn: a sample is never lost
_HEIGHT, _LOW, _MANY = 130, 84, 4  # pixels of a panel, and of one where there are more than so many
_AXIS = 64  # pixels for the numbers of an axis, alike in all panels, so that their times stand one below the other


def signals(
    runs: Sequence[Trace], actuator: Actuator, look: Look, *, start: float | None = None, seconds: float | None = None
) -> Filled:
    """Every channel of the runs over one axis of time, in s (or samples where the clock is unknown).

    `start` and `seconds` choose a stretch; without them it is the whole record. Of a long stretch the smallest and the
    largest sample of each of 350 parts are drawn. Raises Unusable ``outside-record``, ``two-clocks``.
    """
    clocks = {run.time_unit for run in runs}
    if len(clocks) > 1:
        what = "one run is timed in seconds, another in samples"
        raise Unusable("two-clocks", what, "figure option run", "choose runs with one clock")
    first, length = _stretch(runs, start, seconds)
    channels = tuple(dict.fromkeys(name for run in runs for name in run.channels))
    values: dict[str, Any] = {"begin": first, "end": first + length}
    tables = {}
    for place, name in enumerate(channels):
        shown = {run.id: _part(run, name, first, length) for run in runs if name in run.channels}
        unit = next(run.units.get(name, "1") for run in runs if name in run.channels)
        factor, printed = words.engineering((run.largest(name) for run in runs if name in run.channels), unit)
        tables[f"channel{place}"] = [row for run, one in shown.items() for row in _rows(*one, factor, run, len(runs))]
        values[f"across{place}"] = [title(name).capitalize(), words.axis("", printed).strip()]
    named = ", ".join(run.id for run in runs)
    values["headline"] = words.headline(actuator, "signals as measured")
    values["told"] = [runs[0].described if len(runs) == 1 else named]
    shown_runs = tuple(run.id for run in runs) if len(runs) > 1 else ()
    clock = "s" if clocks == {"s"} else "samples"
    return Filled(_frame(len(channels), shown_runs, clock, look), tables, values)


def _stretch(runs: Sequence[Trace], start: float | None, seconds: float | None) -> tuple[float, float]:
    """Where the figure begins and how long it is; raises Unusable where nothing was recorded there."""
    longest = max(run.duration for run in runs)
    first = 0.0 if start is None else start
    length = longest - first if seconds is None else min(seconds, longest - first)
    if not (0 <= first < longest and length > 0):
        stretch = f"a stretch from {first:g}" if seconds is None else f"a stretch from {first:g} of {seconds:g}"
        where = " and ".join(run_name(run.id) for run in runs[:2])
        raise Unusable("outside-record", stretch, where, f"stay within 0 to {longest:g}")
    return first, length


def _part(run: Trace, channel: str, first: float, length: float) -> tuple[Real, Real]:
    """Times and samples to draw: the extremes of each part, and the samples next to both ends of the stretch."""
    begin = max(0, int(np.floor(first * run.sample_rate)))
    end = min(run.length, int(np.ceil((first + length) * run.sample_rate)) + 1)
    numbers, values = run.envelope(channel, begin, end, _BINS)
    return numbers / run.sample_rate, values


def _rows(times: Real, samples: Real, factor: float, run: str, runs: int) -> list[dict[str, Any]]:
    """The points of a run; its id is left out where there is one run only."""
    more = {"r": run} if runs > 1 else {}
    pairs = zip(significant(times, 8), significant(factor * samples, 5), strict=True)
    return [{"t": t, "y": y, **more} for t, y in pairs]


@lru_cache(maxsize=32)
def _frame(channels: int, runs: tuple[str, ...], clock: str, look: Look) -> Frame:
    title = alt.TitleParams(blank("headline"), subtitle=blank("told"))
    panels = [_panel(place, channels, runs, clock, look) for place in range(channels)]
    return frame(alt.vconcat(*panels, title=title, spacing=6).configure(**look.config()))


def _panel(place: int, channels: int, runs: tuple[str, ...], clock: str, look: Look) -> Panel:
    last = place == channels - 1
    across = alt.Axis(labels=last, title=f"Time ({clock})" if last else None, tickCount=8)
    height = _HEIGHT if channels <= _MANY else _LOW
    panel: Panel = (
        alt.Chart(alt.NamedData(f"channel{place}"), width=look.across(880), height=height)
        .mark_line(strokeWidth=1.2, clip=True, color=look.series[0])
        .encode(
            x=alt.X("t:Q", scale=alt.Scale(domain=[blank("begin"), blank("end")], nice=False), axis=across),
            y=alt.Y(
                "y:Q",
                axis=alt.Axis(title=blank(f"across{place}"), tickCount=4, minExtent=_AXIS, maxExtent=_AXIS),
                scale=alt.Scale(zero=False),
            ),
        )
    )
    if not runs:
        return panel
    legend = None if place else alt.Legend(title=None, orient="top", columns=4, symbolType="stroke")
    scale = alt.Scale(domain=list(runs), range=list(look.series[: len(runs)]))
    coloured: Panel = panel.encode(color=alt.Color("r:N", scale=scale, legend=legend))
    return coloured


def _drawn(of: Recorded, look: Look, options: Options) -> Filled:
    runs = of.traced(options.get("run"), MOST)
    return signals(runs, of.actuator, look, start=number(options, "start"), seconds=number(options, "seconds"))


SIGNALS = Drawing(
    "signals",
    "Signals",
    Recorded,
    _drawn,
    (RUN, Option("start", "Start (s)"), Option("seconds", "Length (s)")),
    share=1.0,
)
