"""The acceptance sheet of an actuator: its quantities against their limits, and the bench's figures, on one page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np

from ident.bench.acceptance import Line, judged, passed, read_limits, sheet
from ident.bench.analysis import Analysis
from ident.bench.records import BenchSet
from ident.figures.drawing import Drawing, Options
from ident.figures.frequency_characteristics import frequency_panels
from ident.figures.pressure_loop import pressure_panel
from ident.figures.render import Chart, Panel
from ident.figures.speed_characteristic import speed_panel
from ident.figures.study import Study
from ident.figures.theme import Look, look
from ident.matrix import Matrix
from ident.words.titles import title

_COLUMNS = {"quantity": 0, "value": 230, "std error": 330, "unit": 390, "min": 480, "max": 560, "": 620}
_ROW = 18
_MOST, _LIMIT = 5, 4  # decimals, digits of a limit


def acceptance_sheet(
    matrix: Matrix, bench: BenchSet, analysis: Analysis, lines: Sequence[Line], theme: str = "light"
) -> Chart:
    """Table of the quantities with pass or fail, then pressure loop, speed and frequency characteristics."""
    return sheet_chart(matrix, bench, analysis, lines, look(theme))


def sheet_chart(matrix: Matrix, bench: BenchSet, analysis: Analysis, lines: Sequence[Line], of: Look) -> Chart:
    """The same in a look that is at hand."""
    panels: list[Any] = [_table(lines, of)]
    model = analysis.model or analysis.steps or (analysis.static.model if analysis.static else None)
    pictures: list[Any] = []
    if analysis.static is not None and model is not None:
        pictures.append(pressure_panel(bench.of_kind("static"), model, of, 400, 250))
    if analysis.speed is not None and model is not None:
        moving = bench.of_kind("speed-levels", "speed-continuous")
        pictures.append(speed_panel(moving, analysis.speed.levels, model, of, width=400, height=250))
    if pictures:
        panels.append(alt.hconcat(*pictures, spacing=30).resolve_scale(color="independent"))
    if analysis.frequency:
        sines = bench.of_kind("frequency")
        panels.append(
            alt.hconcat(
                *frequency_panels(analysis.frequency, sines, analysis.model, of, 400, 170, beside=True), spacing=30
            ).resolve_scale(color="independent")
        )
    open_ = not any(line.verdict == "FAIL" for line in lines) and not passed(tuple(lines))
    verdict = "inconclusive" if open_ else "passed" if passed(tuple(lines)) else "NOT passed"
    verdict = "NOT passed" if analysis.missing else verdict
    notes = [_short(text) for text in (*(m.text for m in analysis.missing), *analysis.notes)]
    title = alt.TitleParams(
        f"{matrix.actuator.serial} · acceptance test {verdict}",
        subtitle=[f"{len(bench.records)} records · data {matrix.data_hash[:12]}", *notes],
    )
    chart: Chart = (
        alt.vconcat(*panels, title=title, spacing=24).resolve_scale(color="independent").configure(**of.config())
    )
    return chart


def _table(lines: Sequence[Line], of: Look) -> Panel:
    cells = [_cell(name, x, 0, "head") for name, x in _COLUMNS.items()]
    for row, line in enumerate(lines, 1):
        for (_, x), text in zip(_COLUMNS.items(), _texts(line), strict=True):
            kind = "bad" if text == "FAIL" else "cell"
            cells.append(_cell(text, x, row, kind))
    colour = alt.Color(
        "k:N", legend=None, scale=alt.Scale(domain=["head", "cell", "bad"], range=[of.faint, of.ink, of.series[1]])
    )
    height = _ROW * (len(lines) + 1)
    scale = alt.Scale(domain=[-0.5, len(lines) + 0.5], reverse=True, nice=False)
    panel: Panel = (
        alt.Chart(alt.InlineData(values=cells), width=660, height=height)
        .mark_text(align="left", fontSize=11)
        .encode(
            x=alt.X("x:Q", axis=None, scale=alt.Scale(domain=[-8, 660], nice=False)),
            y=alt.Y("y:Q", axis=None, scale=scale),
            text="t:N",
            color=colour,
        )
    )
    return panel


def _texts(line: Line) -> tuple[str, ...]:
    factor, unit = line.printed
    places = _places(line, factor)
    value, deviation, lower, upper = (
        "" if n is None else f"{factor * n:.{places if i < 2 else _LIMIT}{'f' if i < 2 else 'g'}}".replace("-", "−")
        for i, n in enumerate((line.value, line.deviation or None, line.lower, line.upper))
    )
    return title(line.quantity), value or "not found", deviation, unit, lower, upper, line.verdict


def _places(line: Line, factor: float) -> int:
    """Decimals of a value and its standard error: two digits of the error, or four of a value that has none."""
    size = factor * (line.deviation or abs(line.value or 0.0) / 50.0)
    return int(np.clip(1 - np.floor(np.log10(size)), 0, _MOST)) if size > 0 else 1


def _cell(text: str, x: int, row: int, kind: str) -> dict[str, Any]:
    return {"t": text, "x": x, "y": row, "k": kind}


def _short(text: str, most: int = 150) -> str:
    return text if len(text) <= most else text[: most - 1] + "…"


def _drawn(study: Study, of: Look, _options: Options) -> Chart:
    """The records as the procedures judge them: the sheet of `servoident bench`, whatever the fit.

    Against the limits of the data set, or as a production line judges them.
    """
    matrix = study.matrix
    bench, analysis = study.procedures
    lines = sheet(analysis, read_limits(matrix.limits_text, matrix.limits or "limits"))
    if study.line_limits is not None:
        lines = judged(lines, study.line_limits)
    return sheet_chart(matrix, bench, analysis, lines, of)


ACCEPTANCE_SHEET = Drawing("acceptance-sheet", "Acceptance sheet", Study, _drawn, kind="bench")
