"""Reference to measured displacement of a hybrid simulation over frequency (Qian et al. 2014, Fig. 18)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import altair as alt
import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used

from ident.figures.chart_template import unchecked
from ident.figures.drawing import Drawing, Options
from ident.figures.hybrid_time import legend_of, told
from ident.figures.render import Chart, Panel, Row, datasets
from ident.figures.subjects import Simulated
from ident.figures.theme import Look
from ident.figures.thinning import significant
from ident.hybrid.hybrid_simulation import HybridResult

HIGHEST = 30.0
"""Hz: the range of the paper's figure."""
_WINDOW, _COHERENT = 2.0, 0.5  # s; below this coherence an estimate says nothing


def hybrid_response(shown: Mapping[str, HybridResult], look: Look) -> Chart:
    """Magnitude (dB) and phase (°) of the H1 estimate from wanted to measured displacement, 0 to 30 Hz.

    One curve a simulation, by its label; where what is wanted has no power, and the coherence is below ½, none.
    """
    with unchecked():
        return _hybrid_response(shown, look)


def _hybrid_response(shown: Mapping[str, HybridResult], look: Look) -> Chart:
    first = next(iter(shown.values()))
    kept = {name: one for name, one in shown.items() if one.scores is not None}
    tables = {"curves": [row for name, one in kept.items() for row in rows(name, one)]}
    colours = alt.Scale(domain=list(shown), range=list(look.series[: len(shown)]))
    panels = [_panel("a", "Magnitude (dB)", colours, look), _panel("p", "Phase (°)", colours, look)]
    title = alt.TitleParams(f"{first.case.name} · reference to measured displacement", subtitle=told(shown))
    chart: Chart = alt.vconcat(*panels, title=title, spacing=12, datasets=datasets(tables)).configure(**look.config())
    return chart


def rows(name: str, one: HybridResult) -> list[Row]:
    """The curve of one simulation: f in Hz, a in dB, p in degrees."""
    length = min(len(one.measured), round(_WINDOW * one.sample_rate))
    options: dict[str, Any] = {"fs": one.sample_rate, "nperseg": length, "detrend": "constant"}
    frequency, dy = scipy.signal.csd(one.numerical, one.measured, **options)
    _, dd = scipy.signal.welch(one.numerical, **options)
    _, yy = scipy.signal.welch(one.measured, **options)
    coherence = np.abs(dy) ** 2 / np.maximum(dd * yy, 1e-300)
    used = (frequency > 0) & (frequency <= HIGHEST) & (coherence >= _COHERENT)
    found = dy[used] / dd[used]
    columns = (frequency[used], 20 * np.log10(np.abs(found)), np.degrees(np.unwrap(np.angle(found))))
    table = zip(*(significant(column, 5) for column in columns), strict=True)
    return [{"f": f, "a": a, "p": p, "s": name} for f, a, p in table]


def _panel(part: str, said: str, colours: Any, look: Look) -> Panel:
    panel: Panel = (
        alt.Chart(alt.NamedData("curves"), width=look.across(720), height=180)
        .mark_line(strokeWidth=1.5)
        .encode(
            x=alt.X("f:Q", axis=alt.Axis(title="Frequency (Hz)"), scale=alt.Scale(domain=[0, HIGHEST], nice=False)),
            y=alt.Y(f"{part}:Q", axis=alt.Axis(title=said)),
            color=alt.Color("s:N", scale=colours, legend=legend_of(look)),
        )
    )
    return panel


def _drawn(of: Simulated, look: Look, _: Options) -> Chart:
    return hybrid_response(of.runs, look)


HYBRID_RESPONSE = Drawing(
    "response",
    "Reference to measured displacement",
    Simulated,
    _drawn,
    there=lambda of: any(one.scores is not None for one in of.runs.values()),
)
