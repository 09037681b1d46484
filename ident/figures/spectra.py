"""The spectra of some runs as they were measured, and how far the output follows the command linearly."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np

from ident.checks.response import Response, response
from ident.errors import Unusable
from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.options import RUN
from ident.figures.render import Chart, Panel, datasets
from ident.figures.signals import MOST
from ident.figures.subjects import Recorded
from ident.figures.theme import Look
from ident.figures.thinning import Places, decade_ticks, significant
from ident.matrix import Actuator
from ident.run import MOTIONS, Run

_POINTS = 240  # parts of the axis of which one frequency is drawn
_HEIGHT = 150
_DRIVES = ("command", "current", "drive_force", *MOTIONS)
"""Channels that may drive a machine, the first that was recorded does: a specimen is driven by a motion."""


def spectra(runs: Sequence[Run], actuator: Actuator, look: Look) -> Chart:
    """Power of input and output in dB below their largest, and the coherence |S_uy|² / (S_uu S_yy), a colour a run.

    Averages over Hann frames of half overlap (Welch 1967). Raises Unusable ``no-spectrum`` where nothing drives the
    runs, or all are too short to average.
    """
    found = {run.id: of for run in runs if (of := _response(run)) is not None}
    if not found:
        what = "no input was recorded, or the record is too short to average"
        raise Unusable("no-spectrum", what, "figure option run", "choose a longer run with an input")
    rows = [row for run, of in found.items() for row in _rows(of, run)]
    clock = "Hz" if all(run.time_unit == "s" for run in runs) else "1/sample"
    low, high = min(row["f"] for row in rows), max(row["f"] for row in rows)
    legend = alt.Legend(title=None, orient="top", columns=4, symbolType="stroke") if len(found) > 1 else None
    colour = alt.Color("r:N", scale=alt.Scale(domain=list(found), range=list(look.series[: len(found)])), legend=legend)
    panels = [
        _panel(field, name, scale, (low, high), f"Frequency ({clock})" if field == "c" else None, look).encode(
            color=colour
        )
        for field, name, scale in (
            ("u", "Input (dB)", alt.Scale(zero=False)),
            ("y", "Output (dB)", alt.Scale(zero=False)),
            ("c", "Coherence", alt.Scale(domain=[0, 1])),
        )
    ]
    shown = words.describe(runs[0]) if len(runs) == 1 else ", ".join(found)
    title = alt.TitleParams(words.headline(actuator, "spectra as measured"), subtitle=[shown])
    made: Chart = alt.vconcat(*panels, title=title, spacing=6, datasets=datasets({"spectra": rows})).configure(
        **look.config()
    )
    return made


def _panel(field: str, name: str, scale: alt.Scale, band: tuple[float, float], across: str | None, look: Look) -> Panel:
    axis = alt.Axis(values=decade_ticks(*band), format="~g", title=across, labels=across is not None)
    x = alt.X("f:Q", scale=alt.Scale(type="log", domain=list(band), nice=False), axis=axis)
    y = alt.Y(f"{field}:Q", axis=alt.Axis(title=name, minExtent=40), scale=scale)
    chart = alt.Chart(alt.NamedData("spectra"), width=look.across(880), height=_HEIGHT)
    panel: Panel = chart.mark_line(strokeWidth=1.2).encode(x=x, y=y)
    return panel


def _response(run: Run) -> Response | None:
    drives = next((name for name in _DRIVES if name in run.channels and name != run.output), None)
    return None if drives is None else response(run.channels[drives], run.measured, run.sample_rate)


def _rows(of: Response, run: str) -> list[dict[str, Any]]:
    places = _loudest(of)
    power = {"u": 10 * np.log10(of.uu / of.uu.max()), "y": 10 * np.log10(of.yy / of.yy.max())}
    columns = {"f": of.frequency} | power | {"c": of.coherence}
    short = [significant(column[places], 4) for column in columns.values()]
    return [dict(zip(columns, row, strict=True), r=run) for row in zip(*short, strict=True)]


def _loudest(of: Response) -> Places:
    """The line of the largest output power in each of the parts of a logarithmic axis: no peak is left out."""
    edges = np.geomspace(of.frequency[0], of.frequency[-1], _POINTS + 1)
    part = np.searchsorted(edges, of.frequency, side="right")
    order = np.lexsort((-of.yy, part))
    return np.sort(order[np.unique(part[order], return_index=True)[1]])


def _drawn(of: Recorded, look: Look, options: Options) -> Chart:
    return spectra(of.chosen(options.get("run"), MOST), of.actuator, look)


SPECTRA = Drawing("spectra", "Spectra", Recorded, _drawn, (RUN,), share=1.0)
