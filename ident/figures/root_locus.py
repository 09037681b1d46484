"""The poles of the closed loop over the gain Kp."""

from __future__ import annotations

from typing import Any

import altair as alt

from ident.errors import Unusable
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart
from ident.figures.theme import Look
from ident.hybrid.root_locus import Mark
from ident.hybrid.what_if import WhatIf
from ident.words.number import trimmed


def root_locus(result: WhatIf, look: Look) -> Chart:
    """Real against imaginary part in Hz, s/(2π), coloured by Kp; crosses where it is least, rings where it is most.

    Raises Unusable for a machine without a loop.
    """
    if result.locus is None:
        raise Unusable("no-gain", "the model has no loop with a gain", "root locus", "choose the response")
    rows = [
        {"x": pole.real, "y": pole.imaginary, "k": gain}
        for gain, poles in zip(result.locus.gain, result.locus.poles, strict=True)
        for pole in poles
    ]
    lowest, highest = result.locus.gain[0], result.locus.gain[-1]
    x = alt.X("x:Q", title="Real part (Hz)")
    y = alt.Y("y:Q", title="Imaginary part (Hz)")
    colour = alt.Color(
        "k:Q",
        title="Kp",
        scale=alt.Scale(type="log", range=list(look.ramp), domain=[lowest, highest]),
        legend=alt.Legend(orient="right"),
    )
    dots = alt.Chart(alt.InlineData(values=rows)).mark_circle(size=16).encode(x=x, y=y, color=colour)
    edge = alt.Chart(alt.InlineData(values=[{"x": 0.0}])).mark_rule(color=look.ink, strokeDash=[5, 3]).encode(x="x:Q")
    layers: list[Any] = [
        edge,
        dots,
        *(_ends(rows, k, shape, look) for k, shape in ((lowest, "cross"), (highest, "circle"))),
        *(_marked(mark, shape, look) for mark, shape in zip(result.locus.marks, ("diamond", "square"), strict=False)),
    ]
    told = f"Kp from {trimmed(lowest)} (crosses) to {trimmed(highest)} (rings); stable to the left of the dashed line"
    lost = result.critical_gain
    named = (
        f"{mark.meaning} at Kp = {trimmed(mark.gain)} ({shape})"
        for mark, shape in zip(result.locus.marks, ("diamonds", "squares"), strict=False)
    )
    kept = "stability is kept" if lost is None else f"stability is lost at Kp = {trimmed(lost)}, beyond these gains"
    more = ", ".join(named) or kept
    title = alt.TitleParams("Poles of the closed loop over the gain", subtitle=[told, more])
    chart: Chart = (
        alt.layer(*layers).properties(width=look.across(520), height=360, title=title).configure(**look.config())
    )
    return chart


def _ends(rows: list[dict[str, Any]], gain: float, shape: str, look: Look) -> Any:
    own = [row for row in rows if row["k"] == gain]
    return (
        alt.Chart(alt.InlineData(values=own))
        .mark_point(shape=shape, size=80, color=look.ink, filled=False)
        .encode(x="x:Q", y="y:Q")
    )


def _marked(mark: Mark, shape: str, look: Look) -> Any:
    """The poles at one gain that has a meaning."""
    own = [{"x": pole.real, "y": pole.imaginary} for pole in mark.poles]
    return (
        alt.Chart(alt.InlineData(values=own))
        .mark_point(shape=shape, size=110, color=look.series[1], filled=False, strokeWidth=2)
        .encode(x="x:Q", y="y:Q")
    )


def _drawn(of: WhatIf, look: Look, _: Options) -> Chart:
    return root_locus(of, look)


ROOT_LOCUS = Drawing("root-locus", "Poles over the gain", WhatIf, _drawn, there=lambda of: of.locus is not None)
