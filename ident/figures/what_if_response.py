"""What a change would do: magnitude and phase at each gain, peaks marked, beside the change that makes a peak."""

from __future__ import annotations

from typing import Any

import altair as alt

from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel
from ident.figures.theme import Look
from ident.hybrid.what_if import HIGHEST, Response, WhatIf
from ident.words.number import plain, trimmed

_AS_SCALED, _WITH_PEAK = "as changed", "smallest change that makes the peak"


def what_if_response(result: WhatIf, look: Look) -> Chart:
    """|G| and phase (°) over frequency (Hz), both axes linear; a line a gain, dashed with the smallest change."""
    end = max(HIGHEST, 2 * result.peak.target.frequency) if result.peak else HIGHEST
    rows = [row for each in result.responses for row in _rows(each, _AS_SCALED, end)]
    rows += [row for each in result.with_peak for row in _rows(each, _WITH_PEAK, end)]
    marks = [
        {"f": peak.frequency, "a": peak.magnitude, "g": _gain(each), "t": f"{trimmed(peak.frequency)} Hz"}
        for each in (*result.responses, *result.with_peak)
        for peak in each.peaks
        if peak.frequency <= end
    ]
    magnitude = alt.layer(*_ground(result, look), _lines(rows, "a", "Magnitude |G| (–)", look), *_marks(marks, look))
    panels: list[Panel] = [
        magnitude.properties(width=look.across(640), height=230),
        _lines(rows, "p", "Phase (°)", look).properties(width=look.across(640), height=170),
    ]
    title = alt.TitleParams("Frequency response after the change", subtitle=_told(result))
    chart: Chart = alt.vconcat(*panels, title=title).configure(**look.config())
    return chart


def _told(result: WhatIf) -> list[str]:
    size, specimen = result.actuator, result.specimen
    area = "area not stated" if size.piston_area is None else f"{plain(1e6 * size.piston_area)} mm²"
    stroke = "" if size.stroke is None else f", stroke {plain(1e3 * size.stroke)} mm"
    moved = f"{plain(specimen.mass)} kg, {plain(specimen.stiffness / 1e3)} kN/m"
    return [f"{area}{stroke}, specimen {moved}", "dots: peaks"]


def _gain(each: Response) -> str:
    return "no loop" if each.gain is None else f"Kp = {trimmed(each.gain)}"


def _rows(each: Response, kind: str, end: float) -> list[dict[str, Any]]:
    columns = zip(each.frequency, each.magnitude, each.phase, strict=True)
    return [
        {"f": round(f, 4), "a": float(f"{a:.5g}"), "p": round(p, 3), "g": _gain(each), "k": kind}
        for f, a, p in columns
        if f <= end
    ]


def _lines(rows: list[dict[str, Any]], field: str, title: str, look: Look) -> Any:
    kinds = list(dict.fromkeys(row["k"] for row in rows))
    dash = alt.StrokeDash(
        "k:N",
        title=None,
        scale=alt.Scale(domain=kinds, range=[[1, 0], [6, 4]][: len(kinds)]),
        legend=alt.Legend(orient="bottom", labelLimit=400) if len(kinds) > 1 else None,
    )
    colour = alt.Color("g:N", title=None, scale=alt.Scale(range=list(look.series)), legend=alt.Legend(orient="bottom"))
    return (
        alt.Chart(alt.InlineData(values=rows))
        .mark_line(strokeWidth=1.6)
        .encode(
            x=alt.X("f:Q", title="Frequency (Hz)", scale=alt.Scale(nice=False)),
            color=colour,
            strokeDash=dash,
            y=alt.Y(f"{field}:Q", title=title),
            tooltip=["g:N", "k:N", "f:Q", f"{field}:Q"],
        )
    )


def _marks(rows: list[dict[str, Any]], look: Look) -> list[Any]:
    base = alt.Chart(alt.InlineData(values=rows)).encode(x="f:Q", y="a:Q")
    words = base.mark_text(dy=-10, color=look.ink).encode(text="t:N")
    return [base.mark_circle(size=50, color=look.ink), words] if rows else []


def _ground(result: WhatIf, look: Look) -> list[Any]:
    """The frequencies at which the peak is wanted."""
    if result.peak is None:
        return []
    target = result.peak.target
    ends = [{"f": target.frequency - target.tolerance, "e": target.frequency + target.tolerance}]
    return [alt.Chart(alt.InlineData(values=ends)).mark_rect(color=look.faint, opacity=0.15).encode(x="f:Q", x2="e:Q")]


def _drawn(of: WhatIf, look: Look, _: Options) -> Chart:
    return what_if_response(of, look)


WHAT_IF_RESPONSE = Drawing("response", "Response after the change", WhatIf, _drawn)
