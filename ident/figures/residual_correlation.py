"""Whether the residual of a run is noise: its correlation with itself and with the command, in bands of chance."""

from __future__ import annotations

from typing import Any

import altair as alt

from ident.comparison.compare import RunComparison
from ident.figures import words
from ident.figures.drawing import Drawing, Option, Options
from ident.figures.options import RUN, whole_number
from ident.figures.render import Chart, Panel, datasets
from ident.figures.run_selection import selected_run, typical_run, unstable_on
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.residuals.correlation import SURE, Correlation, correlation
from ident.run import Run
from ident.words.percent import percent


def residual_correlation(
    compared: RunComparison, actuator: Actuator, fit: FitResult, look: Look, *, lags: int | None = None
) -> Chart:
    """Autocorrelation above, correlation with the command below, each within its 99 % band."""
    found, run = correlation(compared, lags), compared.run
    panels, tables, told = [], {}, []
    for name, title, shown in (
        ("auto", "Autocorrelation (–)", found.auto),
        ("cross", "Cross-correlation (–)", found.cross),
    ):
        if shown is None:
            continue
        tables[name] = _rows(shown, run)
        panels.append(_panel(name, title, shown.band, run, look))
        told.append(f"{percent(shown.outside)} of the {title.partition(' (')[0].lower()}")
    subtitle = [
        words.verdict(fit),
        words.describe(run),
        f"lags outside the {100 * SURE:.0f} % band (1.00 % expected):",
        ", ".join(told),
    ]
    headline = alt.TitleParams(words.headline(actuator, "residual whiteness and cross-correlation"), subtitle=subtitle)
    chart: Chart = alt.vconcat(*panels, title=headline, spacing=14, datasets=datasets(tables)).configure(
        **look.config()
    )
    return chart


def _rows(shown: Correlation, run: Run) -> list[dict[str, Any]]:
    step = 1e3 / run.sample_rate if run.time_unit == "s" else 1.0
    return [
        {"k": float(f"{step * lag:.6g}"), "r": float(f"{value:.4g}"), "o": bool(lag and abs(value) > shown.band)}
        for lag, value in zip(shown.lags, shown.values, strict=True)
    ]


def _panel(name: str, title: str, band: float, run: Run, look: Look) -> Panel:
    data = alt.NamedData(name)
    clock = "ms" if run.time_unit == "s" else "samples"
    across = f"Lag of the residual ({clock})"
    x = alt.X("k:Q", axis=alt.Axis(title=across), scale=alt.Scale(nice=False, zero=False))
    y = alt.Y("r:Q", axis=alt.Axis(title=title, tickCount=5))
    colours = alt.Scale(domain=[False, True], range=[look.series[0], look.series[1]])
    colour = alt.Color("o:N", legend=None, scale=colours)
    tip = [alt.Tooltip("k:Q", title=across), alt.Tooltip("r:Q", title="Correlation")]
    chance = (
        alt.Chart(alt.InlineData(values=[{"low": -band, "high": band}]))
        .mark_rect(color=look.faint, opacity=0.25)
        .encode(y=alt.Y("low:Q"), y2="high:Q")
    )
    stems = alt.Chart(data).mark_rule(strokeWidth=1.2).encode(x=x, y=y, y2=alt.datum(0), color=colour)
    heads = alt.Chart(data).mark_circle(size=14, opacity=1).encode(x=x, y=y, color=colour, tooltip=tip)
    return alt.layer(chance, stems, heads).properties(width=look.across(560), height=150)


def _draw(study: Study, look: Look, options: Options) -> Chart:
    run = selected_run(study.matrix, options) or typical_run(study.matrix, study.fit)
    (compared,) = study.compared((run,)).runs
    if compared.unstable:
        raise unstable_on(run)
    lags = whole_number(options, "lags", 1, run.length // 2)
    return residual_correlation(compared, study.matrix.actuator, study.fit, look, lags=lags)


RESIDUAL_CORRELATION = Drawing(
    "residual-correlation", "Residual correlation", Study, _draw, (RUN, Option("lags", "Largest lag, samples"))
)
