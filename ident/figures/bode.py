"""Bode plot: magnitude, phase and coherence of measured records against the model, by Kp, amplitude and specimen."""

from __future__ import annotations

from collections.abc import Sequence

import altair as alt
import numpy as np

from ident.compare import RunComparison
from ident.errors import Unusable
from ident.figures import words
from ident.figures.choose import by_gain, representative
from ident.figures.look import Look
from ident.figures.render import Chart, Panel, datasets
from ident.figures.responses import Responses
from ident.figures.selection import HIGH, LOW, OPEN, Band, band_params, brush, zoomed
from ident.figures.thin import decade_ticks, fine_ticks
from ident.fit.result import FitResult
from ident.matrix import Actuator, Run

FACETS = 4
_WIDTHS = {1: 640, 2: 400, 3: 300}


def readable(runs: Sequence[Run]) -> tuple[Run, ...]:
    """What of `runs` one figure can show: at most four gains, and of each so many runs that the curves stay apart."""
    groups = list(by_gain(runs).values())
    places = np.unique(np.linspace(0, len(groups) - 1, min(FACETS, len(groups))).round().astype(int))
    each = 5 if len(places) == 1 else 4
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
) -> Chart:
    """Magnitude (dB), phase (degrees, unwrapped) and coherence over frequency; one column a gain Kp.

    Measured points fade with their coherence; lines are the model. `axis` is "log" or "linear"; `candidates` is
    the number of runs from which these were taken; `band` is shaded, and drawn with what is around it.
    `others` are the same runs with another model, `other_name`, whose lines are dashed.
    """
    if axis not in ("log", "linear"):
        raise Unusable("unknown-axis", f"no frequency axis {axis!r}", "figure option axis", "use log or linear")
    responses = Responses(compared, axis == "log", others)
    gains = list(by_gain([entry.run for entry in compared]))
    columns = [_column(responses, look, place, gains) for place in range(len(gains))]
    columns[0][0] = columns[0][0].add_params(brush())
    panels = [panel for row in zip(*columns, strict=True) for panel in row]
    data = {_data(place): responses.rows[gain] for place, gain in enumerate(gains)}
    chart: Chart = (
        alt.concat(
            *panels,
            columns=len(gains),
            spacing={"row": 12, "column": 22},
            bounds="flush",
            datasets=datasets(data),
            title=_title(responses, actuator, fit, candidates, other_name),
        )
        .add_params(*band_params(band))
        .resolve_scale(color="shared", opacity="shared")
        .configure(**look.config())
    )
    return chart


def _title(
    responses: Responses, actuator: Actuator, fit: FitResult, candidates: int | None, other_name: str
) -> alt.TitleParams:
    compared = responses.compared
    if len(compared) == 1:
        shown = f"{words.describe(compared[0].run)}: error {words.percent(compared[0].error)}"
    elif candidates is not None and candidates > len(compared):
        shown = f"{len(compared)} of {candidates} runs, chosen to differ"
    else:
        shown = f"{len(compared)} runs"
    if len(compared) > 1:
        shown = ", ".join((shown, *responses.common))
    return alt.TitleParams(
        words.headline(actuator, "frequency response, measured and model"),
        subtitle=[
            words.verdict(fit),
            shown,
            "points: measured, fading with lost coherence · lines: model"
            + (f" · dashed: {other_name}" if other_name else ""),
        ],
    )


def _data(place: int) -> str:
    return f"gain{place}"


def _column(responses: Responses, look: Look, place: int, gains: Sequence[float | None]) -> list[Panel]:
    """The three panels of one gain; only the first column names the vertical axes."""
    width = look.across(_WIDTHS.get(len(gains), 240))
    data = alt.NamedData(_data(place))
    first = place == 0
    panels: list[Panel] = [
        _panel(
            responses,
            look,
            data,
            ("a", "A", "B"),
            title=f"Magnitude ({responses.magnitude_unit})",
            height=200,
            first=first,
        ),
        _panel(responses, look, data, ("p", "P", "Q"), title="Phase (°)", height=170, first=first),
        _coherence(responses, look, data, first),
    ]
    panels[0] = panels[0].properties(title=_heading(gains[place], len(gains)))
    return [panel.properties(width=width) for panel in panels]


def _heading(gain: float | None, count: int) -> alt.TitleParams:
    return alt.TitleParams(
        words.gain(gain) if count > 1 or gain is not None else "", fontSize=12, offset=6, frame="group"
    )


def _panel(
    responses: Responses,
    look: Look,
    data: alt.NamedData,
    fields: tuple[str, str, str],
    *,
    title: str,
    height: int,
    first: bool,
) -> Panel:
    """One quantity: measured as points, model as lines."""
    measured, model, other = fields
    scale = alt.Scale(domain=list(responses.limits(measured, model)), nice=True, zero=False)
    ticks = alt.Axis(title=title if first else None, labels=first, tickCount=6)
    base = alt.Chart(data, height=height).encode(x=_frequency(responses, named=False), color=_colour(responses, look))
    points = base.mark_circle(size=14, clip=True).encode(
        y=alt.Y(f"{measured}:Q", scale=scale, axis=ticks),
        opacity=alt.Opacity("c:Q", scale=alt.Scale(domain=[0.3, 0.95], range=[0.06, 0.8], clamp=True), legend=None),
        tooltip=_tooltip(responses, fields, title),
    )
    lines = base.mark_line(strokeWidth=1.6, clip=True, interpolate="monotone").encode(y=f"{model}:Q", detail="r:N")
    layers = [_shade(responses, look, named=False), points, lines]
    if responses.others:
        layers.append(
            base.mark_line(strokeWidth=1.6, strokeDash=[6, 4], clip=True, interpolate="monotone").encode(
                y=f"{other}:Q", detail="r:N", color=alt.value(look.ink if len(responses.compared) == 1 else look.faint)
            )
        )
    return alt.layer(*layers)


def _coherence(responses: Responses, look: Look, data: alt.NamedData, first: bool) -> Panel:
    ticks = alt.Axis(title="Coherence (–)" if first else None, labels=first, values=[0, 0.5, 1])
    base = alt.Chart(data, height=70).encode(x=_frequency(responses, named=True), color=_colour(responses, look))
    line = base.mark_line(strokeWidth=1, clip=True).encode(
        y=alt.Y("c:Q", scale=alt.Scale(domain=[0, 1.02], nice=False), axis=ticks), detail="r:N"
    )
    return alt.layer(_shade(responses, look, named=True), line)


def _shade(responses: Responses, look: Look, named: bool) -> alt.Chart:
    """The chosen band, as a ground behind the curves."""
    lower, upper = responses.band
    ends = {"low": f"{LOW} || {lower:.6g}", "high": f"{HIGH} || {upper:.6g}"}
    shown = alt.Chart(alt.sequence(0, 1)).transform_filter(f"{LOW} > 0 || {HIGH} > 0")
    shade: alt.Chart = (
        shown.transform_calculate(**ends)
        .mark_rect(color=look.faint, opacity=0.13, clip=True)
        .encode(x=_frequency(responses, named, "low"), x2="high:Q")
    )
    return shade


def _frequency(responses: Responses, named: bool, field: str = "f") -> alt.X:
    """The common frequency axis; only the lowest panel names it."""
    unit = "Hz" if responses.compared[0].run.time_unit == "s" else "cycles/sample"
    lower, upper = responses.band
    if responses.logarithmic:
        scale = alt.Scale(type="log", domain=zoomed(lower, upper), nice=False)
    else:
        scale = alt.Scale(domain=[0, upper], nice=True)
    near, far = fine_ticks(lower, upper), decade_ticks(lower, upper)
    values = alt.ExprRef(f"{LOW} > 0 || {HIGH} > 0 ? {near} : {far}")
    ticks = {"values": values} if responses.logarithmic else {"tickCount": 8}
    axis = alt.Axis(labels=named, title=f"Frequency ({unit})" if named else None, format="~r", **ticks)
    return alt.X(f"{field}:Q", scale=scale, axis=axis)


def _colour(responses: Responses, look: Look) -> alt.Color:
    entries = responses.domain
    colours = [look.series[place % len(look.series)] for place in range(len(entries))]
    legend = alt.Legend(orient="bottom", columns=3, symbolType="circle") if len(entries) > 1 else None
    return alt.Color("s:N", scale=alt.Scale(domain=entries, range=colours), legend=legend, title=None)


def _tooltip(responses: Responses, fields: tuple[str, str, str], title: str) -> list[alt.Tooltip]:
    measured, model, _ = fields
    unit = "Hz" if responses.compared[0].run.time_unit == "s" else "cycles/sample"
    return [
        alt.Tooltip("r:N", title="Run"),
        alt.Tooltip("f:Q", title=f"Frequency ({unit})", format=".4g"),
        alt.Tooltip(f"{measured}:Q", title=f"{title}, measured", format=".4g"),
        alt.Tooltip(f"{model}:Q", title=f"{title}, model", format=".4g"),
        alt.Tooltip("c:Q", title="Coherence", format=".3f"),
    ]
