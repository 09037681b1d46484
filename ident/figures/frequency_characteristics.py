"""Amplitude and phase over frequency, by amplitude of the current (Kononykhin, Fig. 4): measured and the model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import altair as alt
import numpy as np

from ident.bench.frequency import Response, frequency_response, point
from ident.bench.model import Model
from ident.bench.records import Record
from ident.figures import words
from ident.figures.bench import model_and_records
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel
from ident.figures.study import Study
from ident.figures.theme import Look

Rows = list[dict[str, Any]]


def frequency_characteristics(
    responses: Sequence[Response], records: Sequence[Record], model: Model | None, look: Look, title: str = ""
) -> Chart:
    """Gain (dB of mm per % of rated current) and phase (degrees)."""
    panels = frequency_panels(responses, records, model, look)
    whole = alt.vconcat(*panels, title=title).resolve_scale(color="independent")  # else the gain's missing legend rules
    chart: Chart = whole.configure(**look.config())
    return chart


def frequency_panels(
    responses: Sequence[Response],
    records: Sequence[Record],
    model: Model | None,
    look: Look,
    width: int = 420,
    height: int = 150,
    beside: bool = False,
) -> tuple[Panel, Panel]:
    """Measured as points, the model, put through the same procedure, as lines; one above the other, or `beside` it."""
    measured = _rows(responses)
    modelled = [] if model is None else _rows([point(_of_model(record, model)) for record in records])
    names = list(dict.fromkeys(row["a"] for row in sorted(measured, key=lambda row: row["o"])))
    colours = [look.series[i % len(look.series)] for i in range(len(names))]

    def panel(field: str, what: str, last: bool) -> Panel:
        legend = alt.Legend(orient="bottom", title="Amplitude") if last or beside else None
        colour = alt.Color("a:N", scale=alt.Scale(domain=names, range=colours), legend=legend)
        x = alt.X("f:Q", title="Frequency (Hz)" if last or beside else None, scale=alt.Scale(type="log", nice=False))
        y = alt.Y(f"{field}:Q", title=what, scale=alt.Scale(zero=False))
        dots = alt.Chart(alt.InlineData(values=measured)).mark_circle(size=36).encode(x=x, y=y, color=colour)
        lines = alt.Chart(alt.InlineData(values=modelled)).mark_line(strokeWidth=1.3).encode(x=x, y=y, color=colour)
        found: Panel = alt.layer(lines, dots).properties(width=width, height=height)
        return found

    return panel("g", "Gain (dB of mm/%)", last=False), panel("p", "Phase (°)", last=True)


def _rows(responses: Sequence[Response]) -> Rows:
    return [
        {
            "f": float(f"{r.frequency:.5g}"),
            "g": float(f"{20 * np.log10(max(10.0 * r.gain, 1e-12)):.5g}"),
            "p": float(f"{-np.degrees(r.phase):.5g}"),
            "a": f"{100 * r.amplitude:.2g} %",
            "o": r.amplitude,
        }
        for r in responses
    ]


def _of_model(record: Record, model: Model) -> Record:
    answer = model.answer(record.current, record.rate, record.hold, float(record.position[0]))
    return replace(record, position=answer.position)


def _drawn(study: Study, look: Look, _options: Options) -> Chart:
    model, records = model_and_records(study, "frequency characteristics", "frequency")
    title = words.headline(study.matrix.actuator, "amplitude and phase, measured and model")
    return frequency_characteristics(frequency_response(records), records, model, look, title)


FREQUENCY_CHARACTERISTICS = Drawing("frequency-characteristics", "Frequency", Study, _drawn, kind="bench")
