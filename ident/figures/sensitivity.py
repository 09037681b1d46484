"""How the transfer function moves with specimen mass, stiffness and gain (the paper's Figs. 5 to 7)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import altair as alt
import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import settles
from ident.comparison.compare import fitted, response
from ident.errors import Unusable
from ident.figures import words
from ident.figures.chart_template import Filled, Frame, blank, frame
from ident.figures.drawing import Drawing, Options
from ident.figures.options import RUN
from ident.figures.render import Panel
from ident.figures.run_selection import selected_run
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import decade_ticks, excited_band, significant
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
from ident.run import Run, Specimen

MULTIPLES = tuple(float(value) for value in np.geomspace(0.1, 10, 11))
POINTS = 90
_HEADINGS = {"mass": "Mass", "stiffness": "Stiffness", "gain": "Gain Kp"}

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Varied = Callable[[Run, float], Run]


def loaded(runs: Sequence[Run]) -> Run:
    """The run with the middle specimen among those with mass and stiffness, or simply the middle run."""
    able = [run for run in runs if run.specimen and run.specimen.mass > 0 and run.specimen.stiffness > 0]
    ordered = sorted(able, key=lambda run: _of(run).stiffness / _of(run).mass) or list(runs)
    return ordered[len(ordered) // 2]


def sensitivity(run: Run, actuator: Actuator, fit: FitResult, look: Look) -> Filled:
    """Magnitude (dB) and phase (degrees) of the fitted model as one quantity of `run` goes from 0.1 to 10 times.

    A quantity that the run does not state, or that is 0, has no column; multiples that make the loop unstable are
    named, not drawn.
    """
    if "command" not in run.channels:
        what = "the machine is moved by what was recorded, not by a command"
        raise Unusable("unstable-model", what, "sensitivity", "see the time record instead")
    lower, upper = excited_band(run.command, run.sample_rate)
    frequency = np.geomspace(max(lower, upper / 400), 1.25 * upper, POINTS)
    varied = _variations(run)
    stable = {name: _stable(vary, run, actuator, fit) for name, (_, vary) in varied.items()}
    if not any(stable.values()):
        what = "the machine does not settle: it integrates its command, or is unstable"
        raise Unusable("unstable-model", what, "sensitivity", "see the time record instead")
    tables = {
        name: _rows(frequency, {x: response(fit, vary(run, x), actuator, frequency) for x in stable[name]})
        for name, (_, vary) in varied.items()
    }
    values = {
        "headline": words.headline(actuator, "sensitivity of the frequency response"),
        "told": [words.verdict(fit), f"About {words.describe(run)}, which is drawn dashed"],
        **{name: [text, _without(stable[name])] for name, (text, _) in varied.items()},
        **_ends(tables),
    }
    return Filled(_frame(tuple(varied), look), tables, values)


@lru_cache(maxsize=32)
def _frame(names: tuple[str, ...], look: Look) -> Frame:
    columns = [_column(name, look, first=name == names[0], width=look.across(600 / len(names))) for name in names]
    chart = alt.concat(
        *(panel for row in zip(*columns, strict=True) for panel in row),
        columns=len(names),
        spacing={"row": 12, "column": 22},
        bounds="flush",
        title=alt.TitleParams(blank("headline"), subtitle=blank("told")),
    )
    return frame(chart.resolve_scale(color="shared").configure(**look.config()))


def _variations(run: Run) -> dict[str, tuple[str, Varied]]:
    """What can be varied on this run: the run's own value in words, and how."""
    varied: dict[str, tuple[str, Varied]] = {}
    specimen = run.specimen
    if specimen is not None and specimen.mass > 0:
        varied["mass"] = (f"1 × = {specimen.mass:.4g} kg", _with_mass)
    if specimen is not None and specimen.stiffness > 0:
        varied["stiffness"] = (f"1 × = {specimen.stiffness / 1000:.4g} kN/m", _with_stiffness)
    stated = f"{run.Kp:g}" if run.gain is not None else "1 (not stated)"
    varied["gain"] = (f"1 × = {stated}", _with_gain)
    return varied


def _of(run: Run) -> Specimen:
    return run.specimen or Specimen()


def _with_mass(run: Run, factor: float) -> Run:
    return replace(run, specimen=replace(_of(run), mass=factor * _of(run).mass))


def _with_stiffness(run: Run, factor: float) -> Run:
    return replace(run, specimen=replace(_of(run), stiffness=factor * _of(run).stiffness))


def _with_gain(run: Run, factor: float) -> Run:
    return replace(run, gain=factor * run.Kp)


def _stable(vary: Varied, run: Run, actuator: Actuator, fit: FitResult) -> list[float]:
    """The multiples at which the closed loop is stable: another one has no frequency response to measure."""
    model, _, values = fitted(fit, Matrix(actuator, (run,)))
    return [x for x in MULTIPLES if settles(model.core, values, vary(run, x), actuator)]


def _without(stable: Sequence[float]) -> str:
    """What is left out, for the line under the heading."""
    lost = [x for x in MULTIPLES if x not in stable]
    if not lost:
        return ""
    above = not stable or lost[0] > stable[-1]
    return f"unstable from {lost[0]:.2g} ×" if above else f"unstable at {', '.join(f'{x:.2g}' for x in lost)} ×"


def _rows(frequency: Real, answers: Mapping[float, Complex]) -> list[dict[str, Any]]:
    """f frequency, a magnitude (dB), p phase (deg), x multiple."""
    rows: list[dict[str, Any]] = []
    for multiple, answer in answers.items():
        magnitude = significant(20 * np.log10(np.abs(answer)), 4)
        phase = significant(np.degrees(np.unwrap(np.angle(answer))), 4)
        x = float(f"{multiple:.3g}")
        table = zip(significant(frequency, 4), magnitude, phase, strict=True)
        rows += [{"f": f, "a": a, "p": p, "x": x} for f, a, p in table]
    return rows


def _ends(tables: Mapping[str, list[dict[str, Any]]]) -> dict[str, list[float]]:
    """Of scales common to all columns, so that they can be compared, and the marks of the frequency axis."""
    rows = [row for table in tables.values() for row in table]
    magnitude, phase = ([min(row[field] for row in rows), max(row[field] for row in rows)] for field in ("a", "p"))
    frequency = [rows[0]["f"], rows[-1]["f"]]
    return {"frequency": frequency, "marks": decade_ticks(*frequency), "magnitude": magnitude, "phase": phase}


def _x(named: bool) -> alt.X:
    axis = alt.Axis(
        labels=named, title="Frequency (Hz)" if named else None, values=blank("marks"), format="~r", labelSeparation=4
    )
    return alt.X("f:Q", scale=alt.Scale(type="log", domain=blank("frequency"), nice=False), axis=axis)


def _y(field: str, limits: str, title: str, first: bool) -> alt.Y:
    axis = alt.Axis(title=title if first else None, labels=first, tickCount=6)
    return alt.Y(f"{field}:Q", scale=alt.Scale(domain=blank(limits), nice=True, zero=False), axis=axis)


def _column(name: str, look: Look, *, first: bool, width: int) -> list[Panel]:
    data = alt.NamedData(name)
    heading: dict[str, Any] = {
        "fontSize": 12,
        "subtitleFontSize": 11,
        "subtitlePadding": 2,
        "offset": 6,
        "frame": "group",
    }
    title = alt.TitleParams(_HEADINGS[name], subtitle=blank(name), **heading)
    magnitude = _panel(data, _x(named=False), _y("a", "magnitude", "Magnitude (dB)", first), look, width, title=title)
    return [magnitude, _panel(data, _x(named=True), _y("p", "phase", "Phase (°)", first), look, width)]


def _panel(data: alt.NamedData, x: alt.X, y: alt.Y, look: Look, width: int, **heading: Any) -> Panel:
    legend = alt.Legend(
        title="× run's value", orient="right", values=[0.1, 0.3, 1, 3, 10], format="~g", gradientLength=180
    )
    scale = alt.Scale(type="log", domain=[0.1, 10], range=list(look.ramp))
    lines = (
        alt.Chart(data)
        .mark_line(strokeWidth=1.3)
        .encode(x=x, y=y, color=alt.Color("x:Q", scale=scale, legend=legend), detail="x:Q")
    )
    own = (
        alt.Chart(data)
        .transform_filter("datum.x == 1")
        .mark_line(strokeWidth=2, color=look.ink, strokeDash=[5, 3])
        .encode(x=x, y=y)
    )
    return alt.layer(lines, own, width=width, height=190, **heading)


def _drawn(study: Study, look: Look, options: Options) -> Filled:
    run = selected_run(study.matrix, options) or loaded(study.matrix.of_use("verify") or study.matrix.runs)
    return sensitivity(run, study.matrix.actuator, study.fit, look)


SENSITIVITY = Drawing("sensitivity", "Sensitivity", Study, _drawn, (RUN,), share=0.62)
