"""The step response of a fitted model, or of several, with what a data sheet says of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import altair as alt
import numpy as np

from ident.comparison.side_by_side import titles
from ident.comparison.step_response import StepResponse, duration, step_response
from ident.decimation.envelope import envelope
from ident.figures import words
from ident.figures.drawing import Drawing, Option, Options
from ident.figures.options import OTHER, RUN, number
from ident.figures.other_fits import others_of
from ident.figures.render import Chart, datasets
from ident.figures.run_selection import selected_run, typical_run
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import significant
from ident.run import Run
from ident.words.engineering import quantity
from ident.words.number import plain
from ident.words.percent import percent
from ident.words.titles import title

_POINTS = 800  # of all models together
_LEAST = 1e-3  # of the final value: less is no overshoot


def step(run: Run, found: Mapping[str, StepResponse], told: Sequence[str], headline: str, look: Look) -> Chart:
    """Output over time for each model, the command dashed; `told` and what is read off each under the title."""
    first = next(iter(found.values()))
    unit = run.units.get(run.output, "m")
    factor, printed = words.engineering(np.concatenate([one.output for one in found.values()]), unit)
    alike = run.units.get("command", "m") == unit
    points = _POINTS // len(found)
    rows = [row for name, each in found.items() for row in _rows(name, each, factor, points)]
    stepped = StepResponse(first.time, np.where(first.time >= 0, first.size, 0.0), first.size)
    rows += _rows("command", stepped, factor, points) if alike else []
    names = [*found, *(["command"] if alike else [])]
    colours = [*look.series[1 : 1 + len(found)]] if len(found) == 1 else [*look.series[: len(found)]]
    legend = alt.Legend(orient="bottom", columns=1, labelLimit=560, symbolType="stroke")
    colour = alt.Color("s:N", title=None, scale=alt.Scale(domain=names, range=[*colours, look.faint]), legend=legend)
    dashes = alt.Scale(domain=names, range=[*([[1, 0]] * len(found)), [2, 2]])
    dash = alt.StrokeDash("s:N", title=None, scale=dashes, legend=legend)
    lines = (
        alt.Chart(alt.NamedData("step"))
        .mark_line(strokeWidth=1.7, interpolate="linear")
        .encode(
            x=alt.X("t:Q", axis=alt.Axis(title="Time (ms)"), scale=alt.Scale(nice=False)),
            y=alt.Y("y:Q", axis=alt.Axis(title=words.axis(title(run.output).capitalize(), printed))),
            color=colour,
            strokeDash=dash,
            tooltip=[alt.Tooltip("s:N", title="Model"), "t:Q", "y:Q"],
        )
    )
    ends = [{"y": float(f"{factor * first.final * share:.6g}")} for share in (0.98, 1.02)]
    band = (
        alt.Chart(alt.InlineData(values=[{"low": ends[0]["y"], "high": ends[1]["y"]}]))
        .mark_rect(color=look.faint, opacity=0.15)
        .encode(y="low:Q", y2="high:Q")
    )
    heading = alt.TitleParams(headline, subtitle=words.wrapped([*told, *_read(found)], look))
    chart: Chart = alt.layer(
        band, lines, width=look.across(640), height=300, title=heading, datasets=datasets({"step": rows})
    ).configure(**look.config())
    return chart


def _read(found: Mapping[str, StepResponse]) -> list[str]:
    """What a data sheet says, a line a model."""
    several = len(found) > 1
    return [(f"{name[0]}: " if several else "") + said(one) for name, one in found.items()]


def said(of: StepResponse) -> str:
    """ "rise time 12 ms (10 to 90 %), overshoot 4.1 %, settled within 2 % after 80 ms"."""
    rise, settled = (f"{plain(1e3 * time, 3)} ms" for time in (of.rise, of.settling))
    over = f"overshoot {percent(of.overshoot)}" if of.overshoot >= _LEAST else "no overshoot"
    return f"rise time {rise} (10 to 90 %), {over}, settled within 2 % after {settled}"


def _rows(name: str, of: StepResponse, factor: float, points: int) -> list[dict[str, Any]]:
    places = envelope(of.output, points // 2)
    values = significant(factor * of.output[places], 5)
    times = np.round(1e3 * of.time[places], 4).tolist()
    return [{"t": t, "y": y, "s": name} for t, y in zip(times, values, strict=True)]


def _drawn(study: Study, look: Look, options: Options) -> Chart:
    run, others = selected_run(study.matrix, options) or typical_run(study.matrix, study.fit), others_of(options)
    actuator = study.matrix.actuator
    studies = (study, *map(study.beside, others))
    seconds = number(options, "seconds") or max(duration(each.fit, run, actuator) for each in studies)
    size = run.amplitude or float(f"{np.std(run.command):.2g}")
    names = titles([each.fit for each in studies]) if others else ("model",)
    found = {
        name: step_response(each.fit, run, actuator, size, seconds, each.simulator)
        for name, each in zip(names, studies, strict=True)
    }
    height = quantity(size, run.units.get("command", "m"))
    stepped = f"step of {height} under the conditions of {words.describe(run)}"
    told = [stepped] if others else [words.verdict(study.fit), stepped]
    return step(run, found, told, words.headline(actuator, "step response of the model"), look)


STEP = Drawing("step", "Step response", Study, _drawn, (RUN, Option("seconds", "Length (s)"), OTHER), share=0.81)
