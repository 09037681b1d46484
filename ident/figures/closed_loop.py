"""The closed loop of a designed controller: magnitude and phase to 30 Hz, and the band of the fitted covariance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt
import numpy as np
from numpy.typing import NDArray

from ident.figures.chart_template import unchecked
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel, Row, datasets
from ident.figures.subjects import Designed
from ident.figures.theme import Look
from ident.figures.thinning import significant
from ident.hybrid.controller_design import ControllerDesign
from ident.hybrid.robustness import SHOWN, frequencies

Complex = NDArray[np.complex128]
CONTROLLED, UNCONTROLLED, TARGET = "with the controller", "without", "target Gd/(1 + Gd)"
_LIMITS = (-15.0, 10.0)  # dB, the range of the paper's Fig. 18


def closed_loop(made: ControllerDesign, look: Look, name: str = "") -> Chart:
    """Wanted → measured displacement in dB and degrees (the paper's Fig. 18) over 0 to 30 Hz.

    The loop with and without the controller, dashed the target closed by itself without dead time (for a feedback
    controller: a path forward aims at 1), and as a band where 95 % of the draws from the fitted covariance lie. `name`
    is the actuator's.
    """
    with unchecked():
        return _closed_loop(made, look, name)


def _closed_loop(made: ControllerDesign, look: Look, name: str) -> Chart:
    curves = _curves(made)
    named = list(curves)
    colours = [look.series[0], look.series[1], look.faint][: len(named)]
    dashes = [[1, 0], [1, 0], [6, 4]][: len(named)]
    legend = alt.Legend(orient="bottom", symbolType="stroke", labelLimit=400)  # one: two that differ are warned of
    colour = alt.Color("s:N", title=None, scale=alt.Scale(domain=named, range=colours), legend=legend)
    dash = alt.StrokeDash("s:N", title=None, scale=alt.Scale(domain=named, range=dashes), legend=legend)
    panels = [
        _panel(made, look, colour, dash, "a", "Magnitude (dB)", named=False),
        _panel(made, look, colour, dash, "p", "Phase (°)", named=True),
    ]
    title = alt.TitleParams(
        f"{name} · reference to measured displacement" if name else "Reference to measured displacement",
        subtitle=_told(made),
    )
    tables = {"curves": _rows(curves), "band": _band(made)}
    chart: Chart = alt.vconcat(*panels, title=title, spacing=12, datasets=datasets(tables)).configure(**look.config())
    return chart


def _curves(made: ControllerDesign) -> dict[str, Complex]:
    frequency, design = frequencies(), made.design
    z = design.loop.points(frequency)
    found = {CONTROLLED: design.loop.response(frequency), UNCONTROLLED: design.loop.sampled.response(z)[:, 0, 0]}
    if design.structure == "feedback":
        closed = np.roots(np.polyadd(design.target.denominator, design.target.numerator))
        label = TARGET if closed.real.max() < 0 else f"{TARGET}, unstable without controller"
        target = design.target.rational.response(np.asarray(2j * np.pi * frequency, dtype=complex))
        found[label] = target / (1 + target)
    return found


def _rows(curves: dict[str, Complex]) -> list[Row]:
    rows: list[Row] = []
    for name, values in curves.items():
        decibel = significant(20 * np.log10(np.abs(values)), 5)
        degrees = significant(np.degrees(np.unwrap(np.angle(values))), 5)
        table = zip(significant(frequencies(), 4), decibel, degrees, strict=True)
        rows += [{"f": f, "a": a, "p": p, "s": name} for f, a, p in table]
    return rows


def _band(made: ControllerDesign) -> list[Row]:
    judged = made.robustness
    if judged is None or not judged.stable:
        return []
    columns = [significant(each, 5) for each in (judged.frequency, *judged.magnitude, *judged.phase)]
    return [{"f": f, "a": a, "A": b, "p": p, "P": q} for f, a, b, p, q in zip(*columns, strict=True)]


def _told(made: ControllerDesign) -> list[str]:
    design, found, judged = made.design, made.margins, made.robustness
    lines = [
        f"{design.controller.name}, γmin {design.stabilised.gamma_min:.3f}, "
        f"sensitivity peak {found.sensitivity_peak:.2f}"
    ]
    if judged is not None:
        lines.append(f"band: 95 % of {judged.draws} draws from the fitted covariance, {judged.stable} of them stable")
    return lines


def _panel(
    made: ControllerDesign, look: Look, colour: alt.Color, dash: alt.StrokeDash, field: str, what: str, *, named: bool
) -> Panel:
    """One quantity: the band as a ground, curves as lines."""
    axis = alt.Axis(labels=named, title="Frequency (Hz)" if named else None, tickCount=7)
    x = alt.X("f:Q", scale=alt.Scale(domain=[0, SHOWN], nice=False), axis=axis)
    scale = alt.Scale(domain=_ends(made)) if field == "a" else alt.Scale(zero=False)
    y = alt.Y(f"{field}:Q", scale=scale, axis=alt.Axis(title=what, tickCount=6))
    upper = {"a": "A:Q", "p": "P:Q"}[field]
    band = alt.Chart(alt.NamedData("band")).mark_area(color=look.series[0], opacity=0.25, clip=True)
    lines = alt.Chart(alt.NamedData("curves")).mark_line(strokeWidth=1.8, clip=True)
    tip: Sequence[Any] = [
        alt.Tooltip("s:N", title="Loop"),
        alt.Tooltip("f:Q", title="Frequency (Hz)", format=".4g"),
        alt.Tooltip(f"{field}:Q", title=what, format=".4g"),
    ]
    return alt.layer(
        band.encode(x=x, y=y, y2=upper),
        lines.encode(x=x, y=y, color=colour, strokeDash=dash, tooltip=tip),
        width=look.across(560),
        height=190 if field == "a" else 170,
    )


def _ends(made: ControllerDesign) -> list[float]:
    """The range of the magnitudes, at least a decibel to each side, and not below the paper's."""
    values = 20 * np.log10(np.abs(np.concatenate(list(_curves(made).values()))))
    return [float(max(_LIMITS[0], values.min() - 1.0)), float(max(1.0, values.max() + 1.0))]


def _drawn(of: Designed, look: Look, _: Options) -> Chart:
    return closed_loop(of.design, look, f"case {of.case}" if of.case else "")


CLOSED_LOOP = Drawing("closed-loop", "Closed loop", Designed, _drawn)
