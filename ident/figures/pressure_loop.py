"""Hysteresis by the cavities' pressure difference (Kononykhin, Fig. 3): static, moving +, moving −, and the model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np

from ident.bench.model import Model
from ident.bench.motion import groups
from ident.bench.records import Record
from ident.figures import words
from ident.figures.bench import model_and_records
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel
from ident.figures.study import Study
from ident.figures.theme import Look

NAMES = {0: "static", 1: "moving +", -1: "moving −"}
_POINTS = 900  # of each record


def pressure_loop(records: Sequence[Record], model: Model, look: Look, title: str = "") -> Chart:
    """ΔP (MPa) against the current (% of rated) of static records."""
    chart: Chart = alt.vconcat(pressure_panel(records, model, look), title=title).configure(**look.config())
    return chart


def pressure_panel(records: Sequence[Record], model: Model, look: Look, width: int = 420, height: int = 260) -> Panel:
    """Measured means of short blocks as points, in three colours; the model's loop as a line."""
    points: list[dict[str, Any]] = []
    line: list[dict[str, Any]] = []
    for record in records:
        slow = record.reduced(max(20.0, record.rate * _POINTS / record.length))
        if slow.pressure is None:
            continue
        state = groups(record)[:: max(1, round(record.rate / slow.rate))]
        rows = zip(slow.current, slow.pressure, state, strict=False)
        points += [{"i": _percent(i), "p": _mega(p), "g": NAMES[int(s)]} for i, p, s in rows]
        answer = model.answer(slow.current, slow.rate, slow.hold, float(slow.position[0]))
        if not line:
            shown = slice(slow.length // 4, None)
            pairs = zip(slow.current[shown], answer.pressure[shown], strict=True)
            line = [{"i": _percent(i), "p": _mega(p), "n": n} for n, (i, p) in enumerate(pairs)]
    colour = alt.Color(
        "g:N",
        title=None,
        scale=alt.Scale(domain=list(NAMES.values()), range=list(look.series[:3])),
        legend=alt.Legend(orient="bottom"),
    )
    x = alt.X("i:Q", title="Current (% of rated)", scale=alt.Scale(zero=False))
    y = alt.Y("p:Q", title="Pressure difference (MPa)")
    cloud = alt.Chart(alt.InlineData(values=points)).mark_circle(size=9, opacity=0.5).encode(x=x, y=y, color=colour)
    drawn = (
        alt.Chart(alt.InlineData(values=line)).mark_line(color=look.ink, strokeWidth=1.2).encode(x=x, y=y, order="n:Q")
    )
    panel: Panel = alt.layer(cloud, drawn).properties(width=width, height=height, title="Pressure against current")
    return panel


def _percent(value: Any) -> float:
    return float(np.round(100.0 * value, 4))


def _mega(value: Any) -> float:
    return float(np.round(1e-6 * value, 4))


def _drawn(study: Study, look: Look, _options: Options) -> Chart:
    model, records = model_and_records(study, "pressure loop", "static")
    title = words.headline(study.matrix.actuator, "hysteresis by the pressure difference, measured and model")
    return pressure_loop(records, model, look, title)


PRESSURE_LOOP = Drawing("pressure-loop", "Pressure loop", Study, _drawn, kind="bench")
