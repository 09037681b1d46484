"""The acceleration of a shaking table against its record, over thirds of an octave."""

from __future__ import annotations

from collections.abc import Mapping

import altair as alt

from ident.figures.chart_template import unchecked
from ident.figures.drawing import Drawing, Options
from ident.figures.hybrid_time import legend_of
from ident.figures.render import Chart, Row, datasets
from ident.figures.subjects import Simulated
from ident.figures.theme import Look
from ident.hybrid.hybrid_simulation import HybridResult

WITHIN = 1.0
"""dB: between these lines the spectrum of a table counts as that of its record."""


def acceleration_chart(shown: Mapping[str, HybridResult], look: Look) -> Chart:
    """Level (dB) of the measured acceleration over that of the record, a line a simulation, with lines at ± 1 dB."""
    first = next(iter(shown.values()))
    kept = {name: one.acceleration for name, one in shown.items() if one.acceleration is not None}
    rows: list[Row] = [
        {"f": round(f, 4), "l": round(level, 4), "s": name}
        for name, one in kept.items()
        for f, level in zip(one.frequency, one.level, strict=True)
    ]
    told = [
        f"{name}: at most {f'{one.worst:+.2f}'.replace('-', '−')} dB, at {one.worst_at:.3g} Hz"
        for name, one in kept.items()
    ]
    with unchecked():
        colours = alt.Scale(domain=list(kept), range=list(look.series[: len(kept)]))
        x = alt.X("f:Q", axis=alt.Axis(title="Frequency (Hz)"), scale=alt.Scale(type="log", nice=False))
        y = alt.Y("l:Q", axis=alt.Axis(title="Acceleration over that of the record (dB)"))
        lines = alt.Chart(alt.NamedData("levels"), width=look.across(720), height=260).mark_line(strokeWidth=1.5)
        lines = lines.encode(x=x, y=y, color=alt.Color("s:N", scale=colours, legend=legend_of(look)))
        limits = alt.Chart(alt.NamedData("limits")).mark_rule(strokeDash=[4, 3], color=look.ink, opacity=0.6)
        tables: dict[str, list[Row]] = {"levels": rows, "limits": [{"l": WITHIN}, {"l": -WITHIN}]}
        title = alt.TitleParams(f"{first.case.name} · acceleration spectrum, {first.case.ground.name}", subtitle=told)
        layers = alt.layer(lines, limits.encode(y="l:Q"), title=title, datasets=datasets(tables))
        chart: Chart = layers.configure(**look.config())
    return chart


def _drawn(of: Simulated, look: Look, _: Options) -> Chart:
    return acceleration_chart(of.runs, look)


ACCELERATION = Drawing(
    "acceleration",
    "Acceleration spectrum",
    Simulated,
    _drawn,
    there=lambda of: any(one.acceleration is not None for one in of.runs.values()),
)
