"""The residual of every run in every frequency band, and of the run as a whole."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import altair as alt

from ident.comparison.compare import Comparison
from ident.errors import Unusable
from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.options import BAND, MANY
from ident.figures.render import Chart, Panel, datasets
from ident.figures.run_selection import CONDITIONS, chosen, filter_in
from ident.figures.selection import HIGH, LOW, OPEN, RUN, Band, band_of, band_params, brush
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import decade_ticks
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.residuals.breakdown import Breakdown, breakdown, noise_in_bands, stated_amplitude
from ident.run import Run
from ident.words.titles import DATA

MOST = 100  # rows
_ROWS = ((30, 15, 11), (60, 12, 10), (MOST, 10, 9))  # up to so many rows: pixels a row, and the size of its label


_MULTIPLES = "colour: residual over the white noise of the run; 1 is noise alone"
_WIDEST = 10.0  # multiples: the scale of colours reaches so far at least, so that noise alone looks like it
_PERCENT = "colour: error, for the noise of a run is not known"


def residual_map(
    compared: Comparison,
    actuator: Actuator,
    fit: FitResult,
    look: Look,
    *,
    floors: Mapping[str, float | None],
    run: str = "",
    band: Band = OPEN,
) -> Chart:
    """Runs by amplitude, gain and specimen, over frequency; colour is the residual in the band over the noise there.

    The noise of a run is its floor, of those in `floors`, spread evenly over frequency; where that of a run is not
    known, colour is the error in per cent. On the right is the error of each run. Of more than a hundred runs the worst
    are shown. `run` and `band` are marked. Raises Unusable where the model is unstable at every run.
    """
    found = breakdown(compared)
    if not found.runs:
        raise Unusable("unstable-model", "the model is unstable at every run", "fit", "fit it to these data first")
    worst = {each.id for each in sorted(found.runs, key=lambda each: -each.error)[:MOST]}
    runs = {each.run.id: each.run for each in compared.runs if each.run.id in worst}
    order = sorted(runs, key=lambda name: _place(runs[name]))
    shown = f"{len(order)} of {len(compared.runs)} runs, the worst" if len(order) < len(compared.runs) else "every run"
    ends = _ends(found)
    unit = "Hz" if all(each.time_unit == "s" for each in runs.values()) else "cycles/sample"
    known = {name: floor for name in order if (floor := floors.get(name))}
    noise = known if len(known) == len(order) else {}
    row, size = next((row, size) for most, row, size in _ROWS if len(order) <= most)
    height = max(60, row * len(order))
    cells = _cells(found, runs, ends, noise)
    top = max([_WIDEST, *(cell["m"] for cell in cells if "m" in cell)]) if noise else None
    panels = [_bands(order, ends, unit, look, height, size, top), _totals(order, look, height, size)]
    title = alt.TitleParams(
        words.headline(actuator, "where the error is, by run and frequency"),
        subtitle=[
            words.verdict(fit),
            f"{shown}, by amplitude, then Kp, then specimen",
            _MULTIPLES if noise else _PERCENT,
            f"last column: all above {found.edges[-2]:.3g} {unit}",
        ],
    )
    data = {"map": cells, "totals": _errors(found, runs)}
    chart: Chart = (
        alt.hconcat(*panels, spacing=10, bounds="flush", datasets=datasets(data), title=title)
        .add_params(alt.param(name=RUN, value=run), *band_params(band))
        .resolve_scale(color="independent")
        .configure(**look.config())
    )
    return chart


def _place(run: Run) -> tuple[Any, ...]:
    specimen = run.specimen
    return (stated_amplitude(run), run.Kp, *((specimen.stiffness, specimen.mass) if specimen else (0.0, 0.0)), run.id)


def _ends(found: Breakdown) -> list[tuple[float, float]]:
    """Where each band is drawn: the first and the last one as wide as their neighbours."""
    edges = list(found.edges)
    ratio = (edges[-2] / edges[1]) ** (1 / max(len(edges) - 3, 1)) if len(edges) > 3 else 2.0
    edges[0], edges[-1] = edges[1] / ratio, min(edges[-1], edges[-2] * ratio)
    return list(pairwise(edges))


def _cells(
    found: Breakdown, runs: Mapping[str, Run], ends: Sequence[tuple[float, float]], noise: Mapping[str, float]
) -> list[dict[str, Any]]:
    """r run, f and g ends of the band, e error in per cent, m in multiples of the noise, at least 1."""
    rows = []
    for run in found.runs:
        if run.id not in runs:
            continue
        floor = noise_in_bands(runs[run.id], noise[run.id], found.edges) if noise else [None] * len(ends)
        for (f, g), error, level in zip(ends, run.bands, floor, strict=True):
            if error:
                multiple = {"m": _short(max(1.0, error / level))} if level else {}
                rows.append({"r": run.id, "f": _short(f), "g": _short(g), "e": _short(100 * error), **multiple})
    return rows


def _errors(found: Breakdown, runs: Mapping[str, Run]) -> list[dict[str, Any]]:
    return [
        {"r": run.id, "e": _short(100 * run.error), "u": DATA[run.use], "d": words.describe(runs[run.id])}
        for run in found.runs
        if run.id in runs
    ]


def _short(value: float) -> float:
    return float(f"{value:.4g}")


def _rows(order: Sequence[str], labels: bool, size: int) -> alt.Y:
    axis = alt.Axis(
        labels=labels, ticks=False, title=None, labelFontSize=size, labelOverlap=False, domain=False, labelFlush=False
    )
    return alt.Y("r:N", sort=list(order), axis=axis, scale=alt.Scale(paddingInner=0.04, paddingOuter=0))


def _bands(
    order: Sequence[str],
    ends: Sequence[tuple[float, float]],
    unit: str,
    look: Look,
    height: int,
    size: int,
    top: float | None,
) -> Panel:
    in_noise = top is not None  # up to which multiple of it colours reach
    lower, upper = ends[0][0], ends[-1][1]
    axis = alt.Axis(
        title=f"Frequency ({unit})", values=decade_ticks(lower, ends[-1][0]), format="~r", grid=False, labelOverlap=True
    )
    field, title = ("m", "Residual over noise (–)") if in_noise else ("e", "Error in the band (%)")
    colour = alt.Color(
        f"{field}:Q",
        scale=alt.Scale(type="log", range=list(look.ramp), nice=False, domain=[1, top] if in_noise else alt.Undefined),
        legend=alt.Legend(title=title, orient="top", format="~g", gradientLength=260, tickCount=4),
    )
    x = alt.X("f:Q", scale=alt.Scale(type="log", domain=[lower, upper], nice=False), axis=axis)
    cells = (
        alt.Chart(alt.NamedData("map"))
        .mark_rect(cursor="pointer")
        .encode(
            x=x,
            x2="g:Q",
            y=_rows(order, True, size),
            color=colour,
            tooltip=[
                alt.Tooltip("r:N", title="Run"),
                alt.Tooltip("f:Q", title=f"From ({unit})", format=".3g"),
                alt.Tooltip("g:Q", title=f"To ({unit})", format=".3g"),
                alt.Tooltip("e:Q", title="Error (%)", format=".3g"),
                *([alt.Tooltip("m:Q", title="Multiple of the noise", format=".3g")] if in_noise else []),
            ],
        )
        .add_params(brush())
    )
    row = alt.Chart(alt.NamedData("totals")).transform_filter(f"datum.r == {RUN}")
    picked = {"f": f"{LOW} || {lower:.6g}", "g": f"{HIGH} || {upper:.6g}"}
    band = alt.Chart(alt.sequence(0, 1)).transform_filter(f"{LOW} > 0 || {HIGH} > 0")
    outline = alt.MarkDef(type="rect", filled=False, stroke=look.ink, strokeWidth=1.5, clip=True)
    marked = row.properties(mark=outline).encode(y=_rows(order, True, size), x=alt.value(0), x2=alt.value("width"))
    panel: Panel = alt.layer(
        cells,
        marked,
        band.transform_calculate(**picked).properties(mark=outline).encode(x=x, x2="g:Q"),
        width=look.across(520),
        height=height,
    )
    return panel


def _totals(order: Sequence[str], look: Look, height: int, size: int) -> Panel:
    colour = alt.Color(
        "u:N",
        scale=alt.Scale(domain=[DATA["fit"], DATA["verify"]], range=list(look.series[:2])),
        legend=alt.Legend(title="Data", orient="top", symbolType="square", columns=1),
    )
    panel: Panel = (
        alt.Chart(alt.NamedData("totals"), width=look.across(120), height=height)
        .mark_bar(cursor="pointer")
        .encode(
            x=alt.X(
                "e:Q",
                axis=alt.Axis(title="Error (%)", tickCount=3, format="~r", labelOverlap="greedy", labelSeparation=6),
                scale=alt.Scale(zero=True),
            ),
            y=_rows(order, False, size),
            color=colour,
            tooltip=[alt.Tooltip("d:N", title="Run"), alt.Tooltip("e:Q", title="Error (%)", format=".3g")],
        )
    )
    return panel


def _drawn(study: Study, look: Look, options: Options) -> Chart:
    """Of every run where none is asked for; the one in `run` is marked."""
    shown = (
        chosen(study.matrix, filter_in(options, CONDITIONS)) if any(map(options.get, CONDITIONS)) else study.matrix.runs
    )
    run = str(options.get("run") or "")
    return residual_map(
        study.compared(shown),
        study.matrix.actuator,
        study.fit,
        look,
        floors=study.floors.by_run,
        run=run,
        band=band_of(options),
    )


RESIDUAL_MAP = Drawing("residual-map", "By run and frequency", Study, _drawn, (*MANY, *BAND), share=0.66)
