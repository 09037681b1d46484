"""Bode plot: magnitude, phase and coherence of measured records against the model, by Kp, amplitude and specimen."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import altair as alt
import numpy as np

from ident.comparison.compare import RunComparison
from ident.errors import Unusable
from ident.figures import words
from ident.figures.candidate import called, candidate_of
from ident.figures.choose import asked, by_gain, chosen, representative
from ident.figures.drawing import Drawing, Options
from ident.figures.frame import Filled, Frame, blank, frame
from ident.figures.look import Look
from ident.figures.options import AXIS, BAND, CANDIDATE, CONDITIONS, RUN, USE
from ident.figures.render import Panel
from ident.figures.responses import Responses
from ident.figures.selection import HIGH, LOW, OPEN, Band, band_of, band_params, band_values, brush, zoomed
from ident.figures.study import Study
from ident.figures.thin import decade_ticks, fine_ticks
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.run import Run
from ident.words.nearest import did_you_mean

FACETS = 4
_ALONE, _EACH = 5, 4  # runs of one gain alone; of each of several, whose columns are narrower
_GAP = 22
_WIDTHS = {1: 640, 2: 400, 3: 300}


def readable(runs: Sequence[Run]) -> tuple[Run, ...]:
    """What of `runs` one figure can show: at most four gains, and of each so many runs that the curves stay apart."""
    groups = list(by_gain(runs).values())
    places = np.unique(np.linspace(0, len(groups) - 1, min(FACETS, len(groups))).round().astype(int))
    each = _ALONE if len(places) == 1 else _EACH
    return tuple(run for place in places for run in representative(groups[place], each))


def bode(
    compared: Sequence[RunComparison],
    actuator: Actuator,
    fit: FitResult,
    look: Look,
    *,
    axis: str = "log",
    candidates: int | None = None,
    band: Band = OPEN,
    others: Sequence[RunComparison] = (),
    other_name: str = "",
) -> Filled:
    """Magnitude (dB), phase (degrees, unwrapped) and coherence over frequency; one column a gain Kp.

    Measured points fade with their coherence; lines are the model. `axis` is "log" or "linear"; `candidates` is
    the number of runs from which these were taken; `band` is shaded, and drawn with what is around it.
    `others` are the same runs with another model, `other_name`, whose lines are dashed.
    """
    if axis not in ("log", "linear"):
        raise Unusable(
            "unknown-axis", f"no frequency axis {axis!r}", "figure option axis", did_you_mean(axis, ("log", "linear"))
        )
    responses = Responses(compared, axis == "log", others)
    gains = list(by_gain([entry.run for entry in compared]))
    lower, upper = responses.band
    values = {
        "headline": words.headline(actuator, "frequency response, measured and model"),
        "told": _briefly(responses, other_name, look) if look.small else _told(responses, fit, candidates, other_name),
        "labels": responses.domain,
        "magnitude": list(responses.limits("a", "A")),
        "phase": list(responses.limits("p", "P")),
        "lowest": lower, "highest": upper, "near": fine_ticks(lower, upper), "far": decade_ticks(lower, upper),
        **{f"gain{place}": words.gain(gain) for place, gain in enumerate(gains)},
        **band_values(band),
    }  # fmt: skip
    tables = {_data(place): responses.rows[gain] for place, gain in enumerate(gains)}
    alike = _Alike(
        columns=len(gains),
        headed=len(gains) > 1 or gains[0] is not None,
        single=len(compared) == 1,
        legend=len(responses.domain) > 1,
        logarithmic=responses.logarithmic,
        compared=bool(others),
        decibel=responses.magnitude_unit,
        frequency="Hz" if compared[0].run.time_unit == "s" else "cycles/sample",
    )
    return Filled(_frame(alike, look), tables, values)


@dataclass(frozen=True)
class _Alike:
    """What Bode plots must share to be drawn in one frame; `single` is True for one run."""

    columns: int
    headed: bool
    single: bool
    legend: bool
    logarithmic: bool
    compared: bool
    decibel: str
    frequency: str


@lru_cache(maxsize=32)
def _frame(alike: _Alike, look: Look) -> Frame:
    columns = [_column(alike, look, place) for place in range(alike.columns)]
    columns[0][0] = columns[0][0].add_params(brush())
    panels = [panel for row in zip(*columns, strict=True) for panel in row]
    heading = {} if look.small else {"title": alt.TitleParams(blank("headline"), subtitle=blank("told"))}
    chart = (
        alt.concat(*panels, columns=alike.columns, spacing={"row": 12, "column": _GAP}, bounds="flush", **heading)
        .add_params(*band_params(OPEN), *(alt.param(name=name, value=0) for name in ("lowest", "highest")))
        .add_params(*(alt.param(name=name, value=[]) for name in ("near", "far")))
        .resolve_scale(color="shared", opacity="shared")
        .configure(**look.config())
    )
    return frame(chart)


def _told(responses: Responses, fit: FitResult, candidates: int | None, other_name: str) -> list[str]:
    """The lines under the title."""
    compared = responses.compared
    if len(compared) == 1:
        shown = f"{words.describe(compared[0].run)}: {words.left(compared[0])}"
    elif candidates is not None and candidates > len(compared):
        shown = f"{len(compared)} of {candidates} runs (automatic selection)"
    else:
        shown = f"{len(compared)} runs"
    if len(compared) > 1:
        shown = ", ".join((shown, *responses.common))
    dashed = f" · dashed: {other_name}" if other_name else ""
    return [words.verdict(fit), shown, f"points: measured (fainter = low coherence) · lines: model{dashed}"]


def _briefly(responses: Responses, other_name: str, look: Look) -> list[str]:
    """The runs and what is what, in lines of a small figure's width."""
    runs = [words.describe(entry.run) for entry in responses.compared]
    said = ("; ".join(runs), "points: measured · line: model", *([f"dashed: with {other_name}"] if other_name else []))
    return [line for text in said for line in textwrap.wrap(text, look.across(120))]


def _data(place: int) -> str:
    return f"gain{place}"


def _column(alike: _Alike, look: Look, place: int) -> list[Panel]:
    """The three panels of one gain; only the first column names the vertical axes."""
    one, others = _WIDTHS[1], alike.columns - 1
    alone = look.share == 1  # else beside something, where all columns have the room of one
    width = look.across(_WIDTHS.get(alike.columns, 240) if alone else (one - _GAP * others) / alike.columns)
    data = alt.NamedData(_data(place))
    first = place == 0
    of_size: dict[str, Any] = {"fontSize": 12, "offset": 6, "frame": "group"}
    if look.small:  # the figure has no title: what it shows stands here
        of_size |= {"subtitle": blank("told"), "subtitleFontSize": 11, "subtitleLineHeight": 13}
    heading = {"title": alt.TitleParams(blank(f"gain{place}"), **of_size)} if alike.headed or look.small else {}
    panels = [
        _panel(alike, look, data, ("a", "A", "B"), f"Magnitude ({alike.decibel})", first=first, **heading),
        _panel(alike, look, data, ("p", "P", "Q"), "Phase (°)", first=first),
        _coherence(alike, look, data, first),
    ]
    return [panel.properties(width=width) for panel in (panels[:2] if look.small else panels)]


def _panel(
    alike: _Alike,
    look: Look,
    data: alt.NamedData,
    fields: tuple[str, str, str],
    what: str,
    *,
    first: bool,
    **heading: Any,
) -> Panel:
    """One quantity: measured as points, model as lines."""
    measured, model, other = fields
    limits, height = ("magnitude", 200) if measured == "a" else ("phase", 170)
    lowest = look.small and measured == "p"
    scale = alt.Scale(domain=blank(limits), nice=True, zero=False)
    ticks = alt.Axis(title=what if first else None, labels=first, tickCount=6)
    base = alt.Chart(data).encode(x=_frequency(alike, named=lowest), color=_colour(alike, look))
    points = base.mark_circle(size=14, clip=True).encode(
        y=alt.Y(f"{measured}:Q", scale=scale, axis=ticks),
        opacity=alt.Opacity("c:Q", scale=alt.Scale(domain=[0.3, 0.95], range=[0.06, 0.8], clamp=True), legend=None),
        tooltip=_tooltip(alike, fields, what),
    )
    lines = base.mark_line(strokeWidth=1.6, clip=True, interpolate="monotone").encode(y=f"{model}:Q", detail="r:N")
    layers = [_shade(alike, look, named=lowest), points, lines]
    if alike.compared:
        layers.append(
            base.mark_line(strokeWidth=1.6, strokeDash=[6, 4], clip=True, interpolate="monotone").encode(
                y=f"{other}:Q", detail="r:N", color=alt.value(look.ink if alike.single else look.faint)
            )
        )
    return alt.layer(*layers, height=0.6 * height if look.small else height, **heading)


def _coherence(alike: _Alike, look: Look, data: alt.NamedData, first: bool) -> Panel:
    ticks = alt.Axis(title="Coherence (–)" if first else None, labels=first, values=[0, 0.5, 1])
    base = alt.Chart(data, height=70).encode(x=_frequency(alike, named=True), color=_colour(alike, look))
    line = base.mark_line(strokeWidth=1, clip=True).encode(
        y=alt.Y("c:Q", scale=alt.Scale(domain=[0, 1.02], nice=False), axis=ticks), detail="r:N"
    )
    return alt.layer(_shade(alike, look, named=True), line)


def _shade(alike: _Alike, look: Look, named: bool) -> alt.Chart:
    """The chosen band, as a ground behind the curves."""
    ends = {"low": f"{LOW} || lowest", "high": f"{HIGH} || highest"}
    shown = alt.Chart(alt.sequence(0, 1)).transform_filter(f"{LOW} > 0 || {HIGH} > 0")
    shade: alt.Chart = (
        shown.transform_calculate(**ends)
        .mark_rect(color=look.faint, opacity=0.13, clip=True)
        .encode(x=_frequency(alike, named, "low"), x2="high:Q")
    )
    return shade


def _frequency(alike: _Alike, named: bool, field: str = "f") -> alt.X:
    """The common frequency axis; only the lowest panel names it."""
    if alike.logarithmic:
        scale = alt.Scale(type="log", domain=zoomed("lowest", "highest"), nice=False)
    else:
        scale = alt.Scale(domain=[0, {"expr": "highest"}], nice=True)
    ticks = {"values": alt.ExprRef(f"{LOW} > 0 || {HIGH} > 0 ? near : far")} if alike.logarithmic else {"tickCount": 8}
    axis = alt.Axis(labels=named, title=f"Frequency ({alike.frequency})" if named else None, format="~r", **ticks)
    return alt.X(f"{field}:Q", scale=scale, axis=axis)


def _colour(alike: _Alike, look: Look) -> alt.Color:
    legend = alt.Legend(orient="bottom", columns=3, symbolType="circle") if alike.legend else None
    return alt.Color("s:N", scale=alt.Scale(domain=blank("labels"), range=list(look.series)), legend=legend, title=None)


def _tooltip(alike: _Alike, fields: tuple[str, str, str], title: str) -> list[alt.Tooltip]:
    measured, model, _ = fields
    return [
        alt.Tooltip("r:N", title="Run"),
        alt.Tooltip("f:Q", title=f"Frequency ({alike.frequency})", format=".4g"),
        alt.Tooltip(f"{measured}:Q", title=f"{title}, measured", format=".4g"),
        alt.Tooltip(f"{model}:Q", title=f"{title}, model", format=".4g"),
        alt.Tooltip("c:Q", title="Coherence", format=".3f"),
    ]


def _drawn(study: Study, look: Look, options: Options) -> Filled:
    candidates = chosen(study.matrix, asked(options))
    runs, other = readable(candidates), candidate_of(options)
    return bode(
        study.compared(runs).runs, study.matrix.actuator, study.fit, look,
        axis=options.get("axis") or "log", candidates=len(candidates), band=band_of(options),
        others=study.beside(other).compared(runs).runs if other else (), other_name=called(other, study.fit),
    )  # fmt: skip


BODE = Drawing("bode", "Bode plot", Study, _drawn, (RUN, USE, *CONDITIONS, *BAND, AXIS, CANDIDATE), share=0.79)
