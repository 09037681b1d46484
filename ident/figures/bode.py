"""Bode plot: magnitude, phase and coherence of measured records against models, by Kp, amplitude and specimen."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import Any

import altair as alt
import numpy as np

from ident.comparison.response_error import response_error
from ident.errors import Unusable
from ident.figures import words
from ident.figures.candidate import called, candidate_of
from ident.figures.chart_template import Filled, Frame, blank, frame
from ident.figures.drawing import Drawing, Options
from ident.figures.options import AXIS, BAND, CANDIDATE, CONDITIONS, OTHER, RUN, USE
from ident.figures.other_fits import others_of, titles_of
from ident.figures.render import Panel
from ident.figures.responses import Responses
from ident.figures.run_selection import by_gain, chosen, filter_in, representative, selected_run, typical_run
from ident.figures.selection import HIGH, LOW, OPEN, Band, band_of, band_values, brush, zoomed
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import decade_ticks, fine_ticks
from ident.fit.result import FitResult
from ident.hybrid.readouts import Readouts, in_words, readouts
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
    responses: Responses,
    told: Sequence[str],
    actuator: Actuator,
    look: Look,
    *,
    band: Band = OPEN,
    read: Sequence[Readouts] = (),
) -> Filled:
    """Magnitude (dB), phase (degrees, unwrapped) and coherence over frequency; one column a gain Kp.

    Measured points fade with their coherence, their bars hold 95 % of their random error. Lines are the models' own
    responses, in the 95 % band of their parameters where it is known; what `read` has of each is marked. `band` is
    shaded, and drawn with what is around it. `told` is said under the title.
    """
    compared = responses.compared
    gains = list(by_gain([entry.run for entry in compared]))
    lower, upper = responses.band
    values = {
        "headline": words.headline(actuator, "frequency response, measured and model"),
        "told": list(told),
        "labels": responses.domain,
        "magnitude": list(responses.limits("a", "A")),
        "phase": list(responses.limits("p", "P")),
        "lowest": lower,
        "highest": upper,
        "near": fine_ticks(lower, upper),
        "far": decade_ticks(lower, upper),
        **{f"gain{place}": words.gain(gain) for place, gain in enumerate(gains)},
        **band_values(band),
    }
    tables = {_data(place): responses.points[gain] for place, gain in enumerate(gains)}
    tables |= {_lines(place): responses.lines[gain] for place, gain in enumerate(gains)}
    marks = responses.marks(read)
    tables |= {_marks(place): marks.get(gain, []) for place, gain in enumerate(gains)}
    alike = _Alike(
        columns=len(gains),
        headed=len(gains) > 1 or gains[0] is not None,
        single=len(compared) == 1,
        legend=len(responses.domain) > 1,
        logarithmic=responses.logarithmic,
        compared=bool(responses.others),
        several=bool(responses.models),
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
    several: bool
    decibel: str
    frequency: str


@dataclass(frozen=True)
class _Fields:
    """The fields of one quantity: measured, the model, another model, the error of the model's line; error bars."""

    limits: str
    measured: str
    model: str
    other: str
    error: str
    bars: dict[str, str] = field(hash=False)


_FACTORS = {"low": "max(1e-3, 1 - datum.e)", "high": "1 + datum.e"}
_DECIBEL = {end: f"datum.a + 20 * log({factor}) / LN10" for end, factor in _FACTORS.items()}
_MAGNITUDE = _Fields("magnitude", "a", "A", "B", "u", _DECIBEL)
_TURN = "57.29578 * asin(min(1, datum.e))"
_PHASE = _Fields("phase", "p", "P", "Q", "v", {"low": f"datum.p - {_TURN}", "high": f"datum.p + {_TURN}"})


@lru_cache(maxsize=32)
def _frame(alike: _Alike, look: Look) -> Frame:
    columns = [_column(alike, look, place) for place in range(alike.columns)]
    columns[0][0] = columns[0][0].add_params(brush())
    panels = [panel for row in zip(*columns, strict=True) for panel in row]
    heading = {} if look.small else {"title": alt.TitleParams(blank("headline"), subtitle=blank("told"))}
    chart = alt.concat(
        *panels,
        columns=alike.columns,
        spacing={"row": 12, "column": _GAP},
        bounds="flush",
        resolve=alt.Resolve(scale={"color": "shared", "opacity": "shared"}),
        config=look.config(),
        **heading,
    )
    return frame(chart, {**band_values(OPEN), "lowest": 0, "highest": 0, "near": [], "far": []})


def _told(
    responses: Responses, fit: FitResult, candidates: int, other_name: str, read: Sequence[Readouts]
) -> list[str]:
    """The lines under the title of a plot of one fit."""
    compared = responses.compared
    if len(compared) == 1:
        shown = f"{words.describe(compared[0].run)}: {words.left(compared[0])}"
    elif candidates > len(compared):
        shown = f"{len(compared)} of {candidates} runs (automatic selection)"
    else:
        shown = f"{len(compared)} runs"
    if len(compared) > 1:
        shown = ", ".join((shown, *responses.common))
    dashed = f" · dashed: {other_name}" if other_name else ""
    line = "describing gain of the model" if fit.effects else "model"
    signs = f"points: measured, bars: 95 % of the random error · lines: {line}{dashed}"
    return [words.verdict(fit), shown, *_read(responses, read), signs]


def _told_of_several(responses: Responses, read: Sequence[Readouts]) -> list[str]:
    """The lines under the title of one run with several models."""
    run = responses.compared[0].run
    each = (
        f"{name[0]}: {', '.join(in_words([found], 'Hz'))}" for name, found in zip(responses.models, read, strict=True)
    )
    return [
        f"{words.describe(run)}: {len(responses.models)} models",
        *(line for line in each if len(line) > len("A: ")),
    ]


def _read(responses: Responses, read: Sequence[Readouts]) -> list[str]:
    """What was read off the lines."""
    unit = "Hz" if responses.compared[0].run.time_unit == "s" else "cycles/sample"
    said = " · ".join(in_words(read, unit))
    return [f"model: {said}"] if said else []


def _briefly(responses: Responses, other_name: str, look: Look) -> list[str]:
    """The runs and what is what, in lines of a small figure's width."""
    runs = [words.describe(entry.run) for entry in responses.compared]
    said = ("; ".join(runs), "points: measured · line: model", *([f"dashed: with {other_name}"] if other_name else []))
    return [line for text in said for line in textwrap.wrap(text, look.across(120))]


def _data(place: int) -> str:
    return f"gain{place}"


def _lines(place: int) -> str:
    return f"lines{place}"


def _marks(place: int) -> str:
    return f"marks{place}"


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
        _panel(alike, look, place, _MAGNITUDE, f"Magnitude ({alike.decibel})", first=first, **heading),
        _panel(alike, look, place, _PHASE, "Phase (°)", first=first),
        _coherence(alike, look, data, first),
    ]
    return [panel.properties(width=width) for panel in (panels[:2] if look.small else panels)]


def _panel(alike: _Alike, look: Look, place: int, fields: _Fields, what: str, *, first: bool, **heading: Any) -> Panel:
    """One quantity: measured as points with error bars, model as lines in their bands."""
    scale = alt.Scale(domain=blank(fields.limits), nice=True, zero=False)
    axis = alt.Axis(title=what if first else None, labels=first, tickCount=6)
    x = _frequency(alike, named=look.small and fields is _PHASE)

    def y(field: str) -> alt.Y:
        return alt.Y(f"{field}:Q", scale=scale, axis=axis)

    shared: dict[str, Any] = {"x": x, "color": _colour(alike, look)}
    data, lines, marks = (alt.Chart(alt.NamedData(name(place))).encode(**shared) for name in (_data, _lines, _marks))
    opacity = alt.Opacity("c:Q", scale=alt.Scale(domain=[0.3, 0.95], range=[0.06, 0.8], clamp=True), legend=None)
    size, run = ("height", 200 if fields is _MAGNITUDE else 170), ["r:N", "s:N"]
    layers = [
        _shade(alike, look, named=look.small and fields is _PHASE),
        lines.transform_calculate(
            low=f"datum.{fields.model} - datum.{fields.error}", high=f"datum.{fields.model} + datum.{fields.error}"
        )
        .mark_area(opacity=0.18, clip=True)
        .encode(y=y("low"), y2="high:Q", detail=run),
        data.transform_calculate(**fields.bars)
        .mark_rule(strokeWidth=0.8, clip=True)
        .encode(y=y("low"), y2="high:Q", opacity=opacity),
        data.mark_circle(size=14, clip=True).encode(
            y=y(fields.measured), opacity=opacity, tooltip=_tooltip(alike, fields.measured, f"{what}, measured")
        ),
        lines.mark_line(strokeWidth=1.6, clip=True).encode(
            y=y(fields.model), detail=run, tooltip=_tooltip(alike, fields.model, f"{what}, model")
        ),
    ]
    if alike.compared:
        colour = alt.value(look.ink if alike.single else look.faint)
        layers.append(
            lines.mark_line(strokeWidth=1.6, strokeDash=[6, 4], clip=True).encode(
                y=y(fields.other), detail=run, color=colour
            )
        )
    if not look.small:
        told = [alt.Tooltip("t:N", title="Read off"), alt.Tooltip("f:Q", title=f"At ({alike.frequency})", format=".3g")]
        layers.append(
            marks.mark_point(shape="diamond", size=70, strokeWidth=1.8, filled=False, clip=True, opacity=1).encode(
                y=y(fields.model), tooltip=told
            )
        )
    return alt.layer(*layers, **{size[0]: 0.6 * size[1] if look.small else size[1]}, **heading)


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
    ticks: dict[str, Any] = (
        {"values": alt.ExprRef(f"{LOW} > 0 || {HIGH} > 0 ? near : far")} if alike.logarithmic else {"tickCount": 8}
    )
    axis = alt.Axis(labels=named, title=f"Frequency ({alike.frequency})" if named else None, format="~r", **ticks)
    return alt.X(f"{field}:Q", scale=scale, axis=axis)


def _colour(alike: _Alike, look: Look) -> alt.Color:
    """A colour a run; where several models are drawn, a colour a model, and what was measured that of the text."""
    several: dict[str, Any] = {"columns": 1, "labelLimit": 560} if alike.several else {"columns": 3}
    legend = alt.Legend(orient="bottom", symbolType="circle", symbolOpacity=1, **several) if alike.legend else None
    colours = [look.ink, *look.series] if alike.several else list(look.series)
    return alt.Color("s:N", scale=alt.Scale(domain=blank("labels"), range=colours), legend=legend, title=None)


def _tooltip(alike: _Alike, field: str, title: str) -> list[alt.Tooltip]:
    return [
        alt.Tooltip("r:N", title="Run"),
        alt.Tooltip("f:Q", title=f"Frequency ({alike.frequency})", format=".4g"),
        alt.Tooltip(f"{field}:Q", title=title, format=".4g"),
    ]


def _drawn(study: Study, look: Look, options: Options) -> Filled:
    logarithmic, band = _axis(options) == "log", band_of(options)
    if several := others_of(options):
        return _several(study, several, look, options)
    candidates = chosen(study.matrix, filter_in(options))
    runs, other = readable(candidates), candidate_of(options)
    compared = study.compared(runs).runs
    responses = Responses(
        compared,
        logarithmic,
        study.beside(other).compared(runs).runs if other else (),
        errors=[partial(response_error, study.fit, run, study.matrix.actuator) for run in runs],
    )
    name = called(other, study.fit)
    if look.small:
        return bode(responses, _briefly(responses, name, look), study.matrix.actuator, look, band=band)
    read = [readouts(one, study.fit, study.matrix.actuator, responses.band) for one in compared]
    told = words.wrapped(_told(responses, study.fit, len(candidates), name, read), look)
    return bode(responses, told, study.matrix.actuator, look, band=band, read=read)


def _several(study: Study, several: Sequence[FitResult], look: Look, options: Options) -> Filled:
    """One run, each model in a colour of its own."""
    run = selected_run(study.matrix, options) or typical_run(study.matrix, study.fit)
    studies = (study, *map(study.beside, several))
    compared = [each.compared((run,)).runs[0] for each in studies]
    fits = [each.fit for each in studies]
    actuator = study.matrix.actuator
    responses = Responses(
        compared,
        _axis(options) == "log",
        models=titles_of(fits, compared),
        errors=[partial(response_error, fit, run, actuator) for fit in fits],
    )
    read = [readouts(each, fit, actuator, responses.band) for each, fit in zip(compared, fits, strict=True)]
    told = words.wrapped(_told_of_several(responses, read), look)
    return bode(responses, told, actuator, look, band=band_of(options), read=read)


def _axis(options: Options) -> str:
    axis = options.get("axis") or "log"
    if axis not in ("log", "linear"):
        remedy = did_you_mean(axis, ("log", "linear"))
        raise Unusable("unknown-axis", f"no frequency axis {axis!r}", "figure option axis", remedy)
    return str(axis)


BODE = Drawing("bode", "Bode plot", Study, _drawn, (RUN, USE, *CONDITIONS, *BAND, AXIS, CANDIDATE, OTHER), share=0.79)
