"""Speed against current with its hysteresis (Kononykhin, Fig. 5): smoothed records, fixed levels, the model's f."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np

from ident.bench.model import Model
from ident.bench.records import Record
from ident.bench.smoothing import METHODS
from ident.bench.speed import Level, curve, levels
from ident.figures import words
from ident.figures.bench import model_and_records
from ident.figures.drawing import Choices, Drawing, Offer, Option, Options
from ident.figures.render import Chart, Panel
from ident.figures.study import Study
from ident.figures.theme import Look

_POINTS = 700
NAMES = ("measured, against the current given", "measured, current corrected", "fixed levels", "f without friction")


def speed_characteristic(
    records: Sequence[Record], levels: Sequence[Level], model: Model, look: Look, method: str = "iir", title: str = ""
) -> Chart:
    """Speed (mm/s) against current (% of rated); `method` smooths: iir, fir or bezier."""
    chart: Chart = alt.vconcat(speed_panel(records, levels, model, look, method), title=title).configure(
        **look.config()
    )
    return chart


def speed_panel(
    records: Sequence[Record],
    levels: Sequence[Level],
    model: Model,
    look: Look,
    method: str = "iir",
    width: int = 420,
    height: int = 330,
) -> Panel:
    """Lines for the records under changing current, given and corrected, points for levels, a line for the table."""
    rows: list[dict[str, Any]] = []
    for record in records:
        if record.kind != "speed-continuous":
            continue
        found = curve(model, record, method)
        step = max(1, record.length // _POINTS)
        inside = slice(_settled(record), record.length - _settled(record), step)
        for name, current in ((NAMES[0], found.given), (NAMES[1], found.corrected)):
            pairs = zip(current[inside], found.speed[inside], strict=True)
            rows += [_row(i, v, name, record.id, n) for n, (i, v) in enumerate(pairs)]
    grid = np.linspace(-1.0, 1.0, 201) * model.table.nodes[-1]
    rows += [
        _row(i + model.I0, v, NAMES[3], "f", n)
        for n, (i, v) in enumerate(zip(grid, model.table.speed(grid), strict=True))
    ]
    points = [_row(level.current, level.speed, NAMES[2], level.id, 0) for level in levels]
    colour = alt.Color(
        "n:N",
        title=None,
        scale=alt.Scale(domain=list(NAMES), range=[look.faint, *look.series[:2], look.ink]),
        legend=alt.Legend(orient="bottom", columns=2),
    )
    x = alt.X("i:Q", title="Current (% of rated)")
    y = alt.Y("v:Q", title="Speed (mm/s)")
    lines = (
        alt.Chart(alt.InlineData(values=rows))
        .mark_line(strokeWidth=1.2)
        .encode(x=x, y=y, color=colour, detail="r:N", order="o:Q")
    )
    dots = alt.Chart(alt.InlineData(values=points)).mark_point(size=40).encode(x=x, y=y, color=colour)
    panel: Panel = alt.layer(lines, dots).properties(width=width, height=height, title="Speed characteristic")
    return panel


def _settled(record: Record) -> int:
    """Samples at either end that a filter has to guess."""
    return min(round(0.1 * record.rate), record.length // 10)


def _row(current: float, speed: float, name: str, run: str, order: int) -> dict[str, Any]:
    return {
        "i": float(np.round(100 * current, 3)),
        "v": float(np.round(1e3 * speed, 3)),
        "n": name,
        "r": run,
        "o": order,
    }


def _smoothings(_: Offer) -> Choices:
    first, *others = METHODS
    return (("", first), *((name, name) for name in others))


def _drawn(study: Study, look: Look, options: Options) -> Chart:
    model, records = model_and_records(study, "speed characteristic", "speed-continuous", "speed-levels")
    title = words.headline(study.matrix.actuator, "speed characteristic, measured and model")
    return speed_characteristic(records, levels(model, records), model, look, options.get("smoothing") or "iir", title)


SPEED_CHARACTERISTIC = Drawing(
    "speed-characteristic",
    "Speed",
    Study,
    _drawn,
    (Option("smoothing", "Smoothing", str | None, _smoothings),),
    kind="bench",
)
