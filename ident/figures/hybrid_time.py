"""Displacements of a hybrid simulation over time, whole and near the peak (Qian et al. 2014, Fig. 17)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import altair as alt
import numpy as np

from ident.decimation.envelope import envelope
from ident.figures import words
from ident.figures.chart_template import unchecked
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel, Row, datasets
from ident.figures.subjects import Simulated
from ident.figures.theme import Look
from ident.figures.thinning import Real, significant
from ident.hybrid.hybrid_simulation import HybridResult
from ident.words.percent import percent_in_print

REFERENCE = "reference: the whole structure"
_BINS, _NEAR = 350, 1.0  # stretches of the whole record; s shown near the peak
_LINE = 95  # characters beside each other in the narrowest figure
_DASHES = ([6, 3], [1, 0], [2, 2])


def hybrid_time(shown: Mapping[str, HybridResult], look: Look) -> Chart:
    """Measured displacement of each simulation, by its label, and the reference solution, all over time in s.

    Above the whole record, below one second around the largest displacement of the reference.
    """
    with unchecked():
        return _hybrid_time(shown, look)


def _hybrid_time(shown: Mapping[str, HybridResult], look: Look) -> Chart:
    first = next(iter(shown.values()))
    curves = {REFERENCE: first.reference} | {f"measured, {name}": _until_end(one) for name, one in shown.items()}
    factor, unit = words.engineering(first.reference, "m")
    rate, peak = first.sample_rate, int(np.argmax(np.abs(first.reference)))
    begin = max(0, peak - round(_NEAR * rate / 2))
    near = slice(begin, min(len(first.reference), begin + round(_NEAR * rate)))
    tables = {
        "whole": _rows(curves, factor, slice(0, len(first.reference)), rate),
        "near": _rows(curves, factor, near, rate),
    }
    named = list(curves)
    colours = alt.Scale(domain=named, range=[look.ink, *look.series][: len(named)])
    dashes = alt.Scale(domain=named, range=[*_DASHES, *[[1, 0]] * len(named)][: len(named)])
    panels = [_panel(name, colours, dashes, words.axis("Displacement", unit), look) for name in ("whole", "near")]
    title = alt.TitleParams(f"{first.case.name} · hybrid simulation, {first.case.ground.name}", subtitle=told(shown))
    chart: Chart = alt.vconcat(*panels, title=title, spacing=12, datasets=datasets(tables)).configure(**look.config())
    return chart


def told(shown: Mapping[str, HybridResult]) -> list[str]:
    """A line of each simulation, two where it is long: its scores, or when it ran away."""
    lines = []
    for name, one in shown.items():
        found = one.scores
        if found is None:
            lines.append(f"{name}: unstable, ran away after {one.ended:.3g} s")
            continue
        left = f"{percent_in_print(found.reference_rms)} off the reference"
        late = f"{round(1e3 * found.delay, 2) + 0.0:.2f} ms late"  # never a minus before nothing
        follows = f"{percent_in_print(found.tracking_rms)} off what was asked for, {late}"
        said = ", ".join((left, follows) if one.stable else (left, follows, "unstable"))
        lines += [f"{name}: {said}"] if len(name) + len(said) < _LINE else [f"{name}:", said]
    return lines


def _until_end(one: HybridResult) -> Real:
    """The measured displacement as far as the simulation went, then zero."""
    if one.ended is None:
        return one.measured
    kept = np.arange(len(one.measured)) <= one.ended * one.sample_rate
    return np.where(kept, np.nan_to_num(one.measured), 0.0)


def _rows(curves: Mapping[str, Real], factor: float, part: slice, rate: float) -> list[Row]:
    rows: list[Row] = []
    most = 3.0 * float(np.max(np.abs(next(iter(curves.values())))))  # what runs away leaves the axis
    for name, signal in curves.items():
        piece = np.clip(signal[part], -most, most)
        places = envelope(piece, _BINS)
        times = np.round((part.start + places) / rate, 6).tolist()
        values = significant(factor * piece[places], 5)
        rows += [{"t": t, "y": y, "s": name} for t, y in zip(times, values, strict=True)]
    return rows


def legend_of(look: Look) -> alt.Legend:
    """The legend of simulations: their labels are long, so that of narrow panels has one below the other."""
    return alt.Legend(
        title=None,
        orient="top",
        symbolType="stroke",
        symbolSize=500,
        labelLimit=500,
        columns=1 if look.share < 1 else 3,
    )


def _panel(table: str, colours: Any, dashes: Any, across: str, look: Look) -> Panel:
    legend = legend_of(look)
    panel: Panel = (
        alt.Chart(alt.NamedData(table), width=look.across(720), height=200)
        .mark_line(strokeWidth=1.3)
        .encode(
            x=alt.X("t:Q", axis=alt.Axis(title="Time (s)"), scale=alt.Scale(nice=False, zero=False)),
            y=alt.Y("y:Q", axis=alt.Axis(title=across)),
            color=alt.Color("s:N", scale=colours, legend=legend),
            strokeDash=alt.StrokeDash("s:N", scale=dashes, legend=legend),
        )
    )
    return panel


def _drawn(of: Simulated, look: Look, _: Options) -> Chart:
    return hybrid_time(of.runs, look)


HYBRID_TIME = Drawing("displacement", "Displacements over time", Simulated, _drawn)
