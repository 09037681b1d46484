"""A stretch of one run in time: command, measured, model, and what is left (the paper's Fig. 15)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import altair as alt
import numpy as np

from ident.comparison.compare import RunComparison
from ident.errors import Unusable
from ident.figures import words
from ident.figures.choose import one
from ident.figures.drawing import Drawing, Option, Options
from ident.figures.frame import Filled, Frame, blank, frame
from ident.figures.look import Look
from ident.figures.options import BAND, RUN
from ident.figures.render import Panel
from ident.figures.selection import OPEN, Band, band_of, number
from ident.figures.study import Study
from ident.figures.thin import Real, envelope, significant
from ident.fit.reduction import within
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.words.run_name import run_name
from ident.words.titles import title

BINS = 350  # stretches of which smallest and largest sample are kept
_DASHES = {"command": [2, 2], "measured": [1, 0], "model": [6, 3]}
PERIODS = 12  # of the command's mean period, shown where no length is asked for


def typical(matrix: Matrix, fit: FitResult) -> Run:
    """The verify run (or, without one, the run) whose error is the middle one."""
    runs = matrix.of_use("verify") or matrix.runs
    errors = {entry.id: entry.error for entry in fit.runs}
    ordered = sorted(runs, key=lambda run: errors.get(run.id, 0.0))
    return ordered[len(ordered) // 2]


def time(
    compared: RunComparison,
    actuator: Actuator,
    fit: FitResult,
    look: Look,
    *,
    start: float | None = None,
    seconds: float | None = None,
    band: Band = OPEN,
) -> Filled:
    """Command, measured and model over time, the residual below on its own scale.

    `start` and `seconds` are in s (or samples where the clock is unknown); by default twelve mean periods of the
    command, a third into the record. Long stretches keep the extremes of each of 350 parts. With a `band`, only what
    the signals have within it.
    """
    run = compared.run
    unit = run.units.get(run.output, "m")

    def filtered(signal: Real) -> Real:
        return within(signal, run.sample_rate, band.low, band.high) if band else signal

    command, measured, modelled = map(filtered, (run.command, run.measured, compared.modelled))
    window = _window(run, command, start, seconds)
    residual = measured - modelled
    factor, printed = words.engineering(measured[window], unit)
    fine, small = words.engineering(residual[window], unit)
    signals = {"measured": measured, "model": modelled}
    if "command" in run.channels and run.units.get("command", "m") == unit:
        signals = {"command": command} | signals
    left = words.left(compared)
    values = {
        "headline": words.headline(actuator, "time record, measured and model"),
        "told": [words.verdict(fit), f"{words.describe(run)}: {left}", *([f"filtered: {band.words}"] if band else [])],
        "begin": window.start / run.sample_rate,
        "end": (window.stop - 1) / run.sample_rate,
        "across": words.axis(title(run.output).capitalize(), printed),
        "small": words.axis("Measured − model", small),
    }
    tables = {"traces": _table(signals, factor, run, window), "residual": _rows(fine * residual, run, window)}
    return Filled(_frame(tuple(signals), "s" if run.time_unit == "s" else "samples", look), tables, values)


@lru_cache(maxsize=32)
def _frame(shown: tuple[str, ...], clock: str, look: Look) -> Frame:
    title = alt.TitleParams(blank("headline"), subtitle=blank("told"))
    panels = _traces(shown, clock, look), _residual(clock, look)
    return frame(alt.vconcat(*panels, title=title, spacing=8).configure(**look.config()))


def _window(run: Run, command: Real, start: float | None, seconds: float | None) -> slice:
    """The samples to show; raises Unusable for a stretch outside the record."""
    length = seconds if seconds is not None else _twelve_periods(run, command)
    first = start if start is not None else max(0.0, min(run.duration / 3, run.duration - length))
    if not (0 <= first < run.duration and length > 0):
        stretch = f"a stretch of {length:g} from {first:g}"
        raise Unusable("outside-record", stretch, run_name(run.id), f"stay within 0 to {run.duration:g}")
    begin = round(first * run.sample_rate)
    return slice(begin, min(run.length, begin + max(2, round(length * run.sample_rate))))


def _twelve_periods(run: Run, command: Real) -> float:
    """Twelve mean periods of the command, from its crossings of the mean, on a 1-2-5 scale."""
    signal = command - command.mean()
    crossings = int(np.count_nonzero(np.diff(np.signbit(signal))))
    length = min(PERIODS * 2 * run.duration / max(crossings, 1), run.duration)
    decade = 10.0 ** np.floor(np.log10(length))
    return float(decade * max(step for step in (1, 2, 5) if step * decade <= length * (1 + 1e-9)))


def _rows(signal: Real, run: Run, window: slice, **more: str) -> list[dict[str, Any]]:
    places = envelope(signal[window], BINS)
    times = (window.start + places) / run.sample_rate
    values = significant(signal[window][places], 5)
    return [{"t": t, "y": y, **more} for t, y in zip(np.round(times, 6).tolist(), values, strict=True)]


def _clock(unit: str, title: bool) -> alt.X:
    axis = alt.Axis(labels=title, title=f"Time ({unit})" if title else None, tickCount=8)
    return alt.X("t:Q", scale=alt.Scale(domain=[blank("begin"), blank("end")], nice=False), axis=axis)


def _table(signals: Mapping[str, Real], factor: float, run: Run, window: slice) -> list[dict[str, Any]]:
    return [row for name, signal in signals.items() for row in _rows(factor * signal, run, window, s=name)]


def _traces(shown: Sequence[str], clock: str, look: Look) -> Panel:
    colours = {"command": look.faint, "measured": look.series[0], "model": look.series[1]}
    legend = alt.Legend(title=None, orient="top", symbolType="stroke", symbolStrokeWidth=2, symbolSize=500, offset=4)
    colour = alt.Color(
        "s:N",
        scale=alt.Scale(domain=list(shown), range=[colours[name] for name in shown]),
        legend=legend,
    )
    dashes = alt.StrokeDash(
        "s:N", scale=alt.Scale(domain=list(shown), range=[_DASHES[name] for name in shown]), legend=legend
    )
    panel: Panel = (
        alt.Chart(alt.NamedData("traces"), width=look.across(720), height=240)
        .mark_line(strokeWidth=1.5)
        .encode(
            x=_clock(clock, title=False),
            y=alt.Y("y:Q", axis=alt.Axis(title=blank("across")), scale=alt.Scale(zero=False)),
            color=colour,
            strokeDash=dashes,
        )
    )
    return panel


def _residual(clock: str, look: Look) -> Panel:
    panel: Panel = (
        alt.Chart(alt.NamedData("residual"), width=look.across(720), height=110)
        .mark_line(strokeWidth=1.1, color=look.series[2])
        .encode(
            x=_clock(clock, title=True),
            y=alt.Y("y:Q", axis=alt.Axis(title=blank("small"), tickCount=4)),
        )
    )
    return panel


def _drawn(study: Study, look: Look, options: Options) -> Filled:
    run = one(study.matrix, options) or typical(study.matrix, study.fit)
    (shown,) = study.compared((run,)).runs
    start, seconds = number(options, "start"), number(options, "seconds")
    return time(shown, study.matrix.actuator, study.fit, look, start=start, seconds=seconds, band=band_of(options))


TIME = Drawing(
    "time",
    "Time record",
    Study,
    _drawn,
    (RUN, *BAND, Option("start", "Start (s)"), Option("seconds", "Length (s)")),
    share=0.69,
)
