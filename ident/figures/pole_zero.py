"""Poles and zeros of the linearised machine under the conditions of a run, as natural frequencies and dampings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np

from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.options import RUN
from ident.figures.render import Chart, datasets
from ident.figures.run_selection import selected_run, typical_run
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.hybrid.poles_and_zeros import Root, poles_and_zeros
from ident.words.message import message
from ident.words.number import plain

_CROSS = "M-1,-1L1,1M-1,1L1,-1"
_DAMPINGS = (0.1, 0.3, 0.5, 0.7, 0.9)
_FIRST = 3  # poles that are named under the title


def pole_zero(roots: Sequence[Root], told: Sequence[str], headline: str, look: Look) -> Chart:
    """Real against imaginary part in Hz, s/(2π): crosses are poles, rings zeros, rays are of one damping ratio."""
    rows = [
        {"x": r.real, "y": r.imaginary, "s": r.kind, "n": f"{plain(r.frequency, 3)} Hz", "z": plain(r.damping, 3)}
        for r in roots
    ]
    reach = 1.08 * max(max(abs(r.real), abs(r.imaginary)) for r in roots)
    kinds = alt.Scale(domain=["pole", "zero"], range=[_CROSS, "circle"])
    base = alt.Chart(alt.NamedData("roots")).encode(
        x=alt.X(
            "x:Q", axis=alt.Axis(title="Real part (Hz)"), scale=alt.Scale(domain=[-reach, 0.25 * reach], nice=False)
        ),
        y=alt.Y("y:Q", axis=alt.Axis(title="Imaginary part (Hz)"), scale=alt.Scale(domain=[-reach, reach], nice=False)),
    )
    marks = base.mark_point(size=90, strokeWidth=2, filled=False).encode(
        shape=alt.Shape("s:N", title=None, scale=kinds, legend=alt.Legend(orient="bottom")),
        color=alt.Color("s:N", title=None, scale=alt.Scale(domain=["pole", "zero"], range=list(look.series[:2]))),
        tooltip=[
            alt.Tooltip("s:N", title="Kind"),
            alt.Tooltip("n:N", title="Natural frequency"),
            alt.Tooltip("z:N", title="Damping ratio"),
        ],
    )
    edge = alt.Chart(alt.InlineData(values=[{"x": 0.0}])).mark_rule(color=look.ink, strokeDash=[5, 3]).encode(x="x:Q")
    chart: Chart = alt.layer(
        *_rays(reach, look),
        edge,
        marks,
        width=look.across(520),
        height=400,
        title=alt.TitleParams(headline, subtitle=words.wrapped(told, look)),
        datasets=datasets({"roots": rows}),
    ).configure(**look.config())
    return chart


def _rays(reach: float, look: Look) -> list[Any]:
    """Lines of one damping ratio ζ, each named where it leaves the figure."""
    rows, ends = [], []
    for zeta in _DAMPINGS:
        x, y = -zeta, np.sqrt(1 - zeta**2)
        end = reach / max(abs(x), y)
        rows += [
            {"x": far * x, "y": sign * far * y, "d": f"{zeta}{sign}", "o": order}
            for sign in (1, -1)
            for order, far in enumerate((0.0, end))
        ]
        ends.append({"x": 0.93 * end * x, "y": 0.93 * end * y, "t": f"ζ {zeta}"})
    lines = alt.Chart(alt.InlineData(values=rows)).mark_line(color=look.faint, opacity=0.5, strokeWidth=0.7)
    names = alt.Chart(alt.InlineData(values=ends)).mark_text(color=look.faint, fontSize=10, dx=14)
    return [
        lines.encode(x="x:Q", y="y:Q", detail="d:N", order="o:O"),
        names.encode(x="x:Q", y="y:Q", text="t:N"),
    ]


def _drawn(study: Study, look: Look, options: Options) -> Chart:
    run = selected_run(study.matrix, options) or typical_run(study.matrix, study.fit)
    found = poles_and_zeros(study.fit, run, study.matrix.actuator)
    told = [words.verdict(study.fit), f"linearised under the conditions of {words.describe(run)}"]
    if found.left_out:
        told.append(str(message("poles.left_out", names=found.left_out)))
    told.append(f"slowest: {'; '.join(root.words for root in found.slowest(_FIRST))}")
    headline = words.headline(study.matrix.actuator, "poles and zeros of the model")
    return pole_zero(found.roots, told, headline, look)


POLE_ZERO = Drawing("pole-zero", "Poles and zeros", Study, _drawn, (RUN,), share=0.9)
