"""The bench's figures of a fitted model: what Kononykhin's Figs. 3 to 5 show, from the matrix and the fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ident.bench.acceptance import read_limits, sheet
from ident.bench.analysis import analyse
from ident.bench.frequency import frequency_response
from ident.bench.model import Model
from ident.bench.outputs import model_of
from ident.bench.records import BenchSet, Record, bench_set
from ident.bench.speed import levels
from ident.comparison.compare import fitted
from ident.errors import Unusable
from ident.figures import words
from ident.figures.acceptance_sheet import sheet_chart
from ident.figures.frequency_characteristics import frequency_characteristics
from ident.figures.look import Look
from ident.figures.pressure_loop import pressure_loop
from ident.figures.render import Chart
from ident.figures.speed_characteristic import speed_characteristic
from ident.fit.result import FitResult
from ident.matrix import Matrix

Draw = Callable[[Matrix, FitResult, Look, Mapping[str, Any]], Chart]


def _of(matrix: Matrix, fit: FitResult) -> tuple[BenchSet, Model]:
    preset, _, values = fitted(fit, matrix)
    bench = bench_set(matrix)
    return bench, model_of(values, bench.supply_pressure, preset)


def _records(bench: BenchSet, what: str, *kinds: str) -> tuple[Record, ...]:
    found = bench.of_kind(*kinds)
    if not found:
        raise Unusable("missing-record", f"the {what} cannot be drawn without a record of kind {kinds[0]}", "figure",
                       f"add a run with kind: {kinds[0]}")  # fmt: skip
    return found


def _loop(matrix: Matrix, fit: FitResult, look: Look, _options: Mapping[str, Any]) -> Chart:
    bench, model = _of(matrix, fit)
    title = words.headline(matrix.actuator, "hysteresis by the pressure difference, measured and model")
    return pressure_loop(_records(bench, "pressure loop", "static"), model, look, title)


def _frequency(matrix: Matrix, fit: FitResult, look: Look, _options: Mapping[str, Any]) -> Chart:
    bench, model = _of(matrix, fit)
    records = _records(bench, "frequency characteristics", "frequency")
    title = words.headline(matrix.actuator, "amplitude and phase, measured and model")
    return frequency_characteristics(frequency_response(records), records, model, look, title)


def _speed(matrix: Matrix, fit: FitResult, look: Look, options: Mapping[str, Any]) -> Chart:
    bench, model = _of(matrix, fit)
    records = _records(bench, "speed characteristic", "speed-continuous", "speed-levels")
    title = words.headline(matrix.actuator, "speed characteristic, measured and model")
    return speed_characteristic(records, levels(model, records), model, look, options.get("smoothing") or "iir", title)


def _sheet(matrix: Matrix, _fit: FitResult, look: Look, _options: Mapping[str, Any]) -> Chart:
    """The records as the procedures judge them: the sheet of `servoident bench`, whatever the fit."""
    bench = bench_set(matrix)
    analysis = analyse(bench)
    lines = sheet(analysis, read_limits(matrix.limits_text, matrix.limits or "limits"))
    return sheet_chart(matrix, bench, analysis, lines, look)


BENCH_FIGURES: Mapping[str, tuple[Draw, tuple[str, ...]]] = {
    "pressure-loop": (_loop, ()),
    "frequency-characteristics": (_frequency, ()),
    "speed-characteristic": (_speed, ("smoothing",)),
    "acceptance-sheet": (_sheet, ()),
}
"""Figures of a fit of the model kononykhin, each with the options that it takes."""
