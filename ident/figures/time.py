"""A stretch of one run in time: command, measured, model and residual (the paper's Fig. 15)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import altair as alt
import numpy as np

from ident.comparison.compare import RunComparison
from ident.decimation.envelope import envelope
from ident.errors import Unusable
from ident.figures import words
from ident.figures.chart_template import Filled, Frame, blank, frame
from ident.figures.drawing import Drawing, Option, Options
from ident.figures.options import BAND, OTHER, RUN, number
from ident.figures.other_fits import others_of, titles_of
from ident.figures.render import Panel
from ident.figures.run_selection import selected_run, typical_run
from ident.figures.selection import OPEN, Band, band_of
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import Real, significant
from ident.fit.reduction import within
from ident.matrix import Actuator
from ident.run import Run
from ident.words.run_name import run_name
from ident.words.titles import title

BINS = 350  # stretches of which smallest and largest sample are kept
_SEVERAL = 100  # of each signal, where several models are drawn
_DASHES = {"command": [2, 2], "measured": [1, 0], "model": [6, 3]}
PERIODS = 12  # of the command's mean period, shown where no length is asked for


def time(
    compared: Sequence[RunComparison],
    told: Sequence[str],
    actuator: Actuator,
    look: Look,
    *,
    names: Sequence[str] = ("model",),
    start: float | None = None,
    seconds: float | None = None,
    band: Band = OPEN,
) -> Filled:
    """Command, measured and model over time, the residual below on its own scale.

    `compared` is one run with each of the models that `names` has. `start` and `seconds` are in s (or samples where
    the clock is unknown); by default twelve mean periods of the command, a third into the record. Long stretches keep
    the extremes of each of 350 parts. With a `band`, only what the signals have within it. `told` is said under the
    title.
    """
    run = compared[0].run
    unit = run.units.get(run.output, "m")

    def filtered(signal: Real) -> Real:
        return within(signal, run.sample_rate, band.low, band.high) if band else signal

    command, measured = filtered(run.command), filtered(run.measured)
    models = {name: filtered(each.modelled) for name, each in zip(names, compared, strict=True)}
    window = _window(run, command, start, seconds)
    residuals = {name: measured - model for name, model in models.items()}
    factor, printed = words.engineering(measured[window], unit)
    fine, small = words.engineering(np.concatenate([each[window] for each in residuals.values()]), unit)
    signals = {"measured": measured, **models}
    if "command" in run.channels and run.units.get("command", "m") == unit:
        signals = {"command": command} | signals
    values = {
        "headline": words.headline(actuator, "time record, measured and model"),
        "told": [*told, *([f"filtered: {band.words}"] if band else [])],
        "begin": window.start / run.sample_rate,
        "end": (window.stop - 1) / run.sample_rate,
        "across": words.axis(title(run.output).capitalize(), printed),
        "small": words.axis("Measured − model", small),
    }
    tables = {"traces": _table(signals, factor, run, window), "residual": _table(residuals, fine, run, window)}
    clock = "s" if run.time_unit == "s" else "samples"
    return Filled(_frame(tuple(signals), tuple(models), clock, look), tables, values)


@lru_cache(maxsize=32)
def _frame(shown: tuple[str, ...], models: tuple[str, ...], clock: str, look: Look) -> Frame:
    title = alt.TitleParams(blank("headline"), subtitle=blank("told"))
    panels = _traces(shown, models, clock, look), _residual(models, clock, look)
    return frame(
        alt.vconcat(*panels, title=title, spacing=8)
        .resolve_scale(color="independent", strokeDash="independent")
        .configure(**look.config())
    )


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


def _rows(signal: Real, run: Run, window: slice, bins: int, **more: str) -> list[dict[str, Any]]:
    places = envelope(signal[window], bins)
    times = (window.start + places) / run.sample_rate
    values = significant(signal[window][places], 5)
    return [{"t": t, "y": y, **more} for t, y in zip(np.round(times, 6).tolist(), values, strict=True)]


def _clock(unit: str, title: bool) -> alt.X:
    axis = alt.Axis(labels=title, title=f"Time ({unit})" if title else None, tickCount=8)
    return alt.X("t:Q", scale=alt.Scale(domain=[blank("begin"), blank("end")], nice=False), axis=axis)


def _table(signals: Mapping[str, Real], factor: float, run: Run, window: slice) -> list[dict[str, Any]]:
    bins = BINS if len(signals) <= len(_DASHES) else _SEVERAL
    return [row for name, signal in signals.items() for row in _rows(factor * signal, run, window, bins, s=name)]


def _colours(models: Sequence[str], look: Look) -> dict[str, str]:
    """Of one model the usual two; several models have a colour each, and what was measured that of the text."""
    if len(models) == 1:
        return {"command": look.faint, "measured": look.series[0], models[0]: look.series[1]}
    return {"command": look.faint, "measured": look.ink, **dict(zip(models, look.series, strict=False))}


def _traces(shown: Sequence[str], models: Sequence[str], clock: str, look: Look) -> Panel:
    colours = _colours(models, look)
    several = len(models) > 1
    legend = alt.Legend(
        title=None,
        orient="top",
        symbolType="stroke",
        symbolStrokeWidth=2,
        symbolSize=500,
        offset=4,
        columns=1 if several else alt.Undefined,
        labelLimit=560,
    )
    colour = alt.Color(
        "s:N",
        scale=alt.Scale(domain=list(shown), range=[colours[name] for name in shown]),
        legend=legend,
    )
    dashes = alt.StrokeDash(
        "s:N", scale=alt.Scale(domain=list(shown), range=[_DASHES.get(name, [6, 3]) for name in shown]), legend=legend
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


def _residual(models: Sequence[str], clock: str, look: Look) -> Panel:
    series = look.series[2:3] if len(models) == 1 else look.series[: len(models)]
    panel: Panel = (
        alt.Chart(alt.NamedData("residual"), width=look.across(720), height=110 if len(models) == 1 else 150)
        .mark_line(strokeWidth=1.1)
        .encode(
            x=_clock(clock, title=True),
            y=alt.Y("y:Q", axis=alt.Axis(title=blank("small"), tickCount=4)),
            color=alt.Color("s:N", scale=alt.Scale(domain=list(models), range=list(series)), legend=None),
        )
    )
    return panel


def _drawn(study: Study, look: Look, options: Options) -> Filled:
    run = selected_run(study.matrix, options) or typical_run(study.matrix, study.fit)
    others = others_of(options)
    compared = [each.compared((run,)).runs[0] for each in (study, *map(study.beside, others))]
    if others:
        names = titles_of((study.fit, *others), compared)
        told = [f"{words.describe(run)}: {len(names)} models"]
    else:
        names, told = ("model",), [words.verdict(study.fit), f"{words.describe(run)}: {words.left(compared[0])}"]
    return time(
        compared,
        told,
        study.matrix.actuator,
        look,
        names=names,
        start=number(options, "start"),
        seconds=number(options, "seconds"),
        band=band_of(options),
    )


TIME = Drawing(
    "time",
    "Time record",
    Study,
    _drawn,
    (RUN, *BAND, Option("start", "Start (s)"), Option("seconds", "Length (s)"), OTHER),
    share=0.69,
)
