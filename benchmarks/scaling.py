"""How the time of a simulation grows with runs, length, effects and cores; it also draws docs/pictures/scaling.svg."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import altair as alt
import numpy as np
from numpy.typing import NDArray

from benchmarks.table import Table, seconds_of
from ident.chain.conditions import conditions
from ident.effects import EFFECTS
from ident.figures.render import Chart, Panel, render
from ident.figures.theme import LOOKS, Look
from ident.matrix import Actuator
from ident.parallel import cores, each
from ident.presets import preset
from ident.run import Run, Specimen
from ident.simulation.simulate import responses
from tests.reference import qian_reference as reference

BASE = {"runs": 28, "seconds": 2.0, "effects": 8, "cores": cores()}
AXES: Mapping[str, tuple[float, ...]] = {
    "runs": (1, 4, 14, 28, 84),
    "seconds": (0.5, 1, 2, 4, 8),
    "effects": (0, 4, 8, 16, 33),
    "cores": tuple(range(1, cores() + 1)),
}
DECADES = (1, 3, 10, 30, 100, 300, 1000, 3000)  # ms
VECTORS, REPEATS = 16, 5  # vectors a run: as many as the kernel takes side by side
TITLES = {"runs": "Runs", "seconds": "Seconds a run", "effects": "Effects in the kernel", "cores": "Cores"}
BASE_TEXT = f"{BASE['runs']} runs of {BASE['seconds']:g} s with {BASE['effects']} effects on {BASE['cores']} cores"
PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "scaling.svg"
SLACK, SHARE = 1.25, 0.8


def work(runs: float, seconds: float, effects: float, cores: float) -> Callable[[], object]:
    """The simulation of a matrix with the first effects of the catalogue: their strengths do not change the time."""
    model = preset("qian2014", tuple(effect.name for effect in EFFECTS[: int(effects)]))
    known = {p.in_equations: np.full((1, VECTORS), p.value) for p in model.parameters}
    todo: list[tuple[Run, Mapping[str, Any]]] = []
    for trial in reference.trials()[: int(runs)]:
        samples = round(seconds * reference.SAMPLE_RATE)
        u = reference.band_limited_noise(samples, trial.amplitude, np.random.default_rng(len(todo)))
        specimen = Specimen(trial.cell.mass, trial.cell.stiffness, trial.cell.damping)
        run = Run(
            trial.id,
            "",
            reference.SAMPLE_RATE,
            {"command": u, "displacement": u},
            specimen=specimen,
            gain=trial.cell.gain,
        )
        of_run = {
            name: np.array([[value]]) for name, value in conditions(run, Actuator("", piston_area=497e-6)).items()
        }
        todo.append((run, known | of_run))

    def one(pair: tuple[Run, Mapping[str, Any]]) -> NDArray[np.float64]:
        return responses(model.chain, [pair[0]], pair[1])

    if cores == 1:
        return lambda: [one(pair) for pair in todo]
    return lambda: each(one, todo)


def measured() -> list[dict[str, Any]]:
    """For every axis and value: what was varied, its value, the time (s), and the time a step and vector (ns)."""
    found = []
    for axis, values in AXES.items():
        works = [work(**(BASE | {axis: value})) for value in values]
        for warm in works:
            warm()
        for value, taken in zip(values, seconds_of(*works, repeats=REPEATS), strict=True):
            given = BASE | {axis: value}
            steps = given["runs"] * given["seconds"] * reference.SAMPLE_RATE * VECTORS
            found.append({"axis": axis, "value": value, "time": taken, "each": 1e9 * taken / steps})
    return found


def measure() -> Table:
    """One quantity varied at a time."""
    found = measured()
    PICTURE.write_bytes(render(picture(found), "svg"))
    each_step = {axis: [row["each"] for row in found if row["axis"] == axis] for axis in AXES}
    grows = max(each_step[axis][-1] / each_step[axis][-2] for axis in ("runs", "seconds"))
    faster = each_step["cores"][0] / each_step["cores"][-1]
    return Table(
        "Scaling",
        f"Runge-Kutta steps at 4096 Hz, {VECTORS} vectors a run; one quantity varied from {BASE_TEXT}.\n\n"
        "![Time of a simulation over runs, seconds, effects and cores](pictures/scaling.svg)",
        ("varied", "value", "time", "per step and vector"),
        [(row["axis"], f"{row['value']:g}", f"{1e3 * row['time']:.1f} ms", f"{row['each']:.1f} ns") for row in found],
        f"in proportion to runs and seconds at their largest step within {100 * (SLACK - 1):.0f} %, and "
        f"{100 * SHARE:.0f} % of what the cores promise",
        grows <= SLACK and faster >= SHARE * AXES["cores"][-1],
    )


def picture(found: list[dict[str, Any]]) -> Chart:
    """Four panels with one scale of time; dashed is proportion, through the longest simulation or one core."""
    look, milliseconds = LOOKS["light"], [1e3 * row["time"] for row in found]
    y = alt.Scale(type="log", domain=[0.7 * min(milliseconds), 1.5 * max(milliseconds)], nice=False)
    panels = [_panel([row for row in found if row["axis"] == axis], y, look, axis) for axis in AXES]
    title = alt.TitleParams(
        "Time of a simulation",
        subtitle=f"One quantity varied from {BASE_TEXT}, {VECTORS} vectors a run. Dashed: in proportion",
    )
    chart: Chart = alt.hconcat(*panels, spacing=16, title=title).configure(**look.config())
    return chart


def _panel(rows: list[dict[str, Any]], y: alt.Scale, look: Look, axis: str) -> Panel:
    first = axis == next(iter(AXES))
    anchor = rows[0] if axis == "cores" else rows[-1]
    data = [{"x": row["value"], "y": 1e3 * row["time"], "p": _proportion(axis, row, anchor)} for row in rows]
    values = [row["value"] for row in rows]
    line = alt.Scale(type="linear", domain=[values[0], values[-1]], padding=10, nice=False)
    scale = alt.Scale(type="log", domain=line.domain, padding=10, nice=False) if axis in ("runs", "seconds") else line
    digits = ".1~f" if axis == "seconds" else "d"
    x = alt.X("x:Q", scale=scale, axis=alt.Axis(title=TITLES[axis], values=values, format=digits))
    time = alt.Axis(title="Time (ms)" if first else None, labels=first, values=list(DECADES), format="~r")
    base = alt.Chart(alt.InlineData(values=data))
    drawn = base.mark_line(color=look.series[0], strokeWidth=2, point={"color": look.series[0], "size": 36})
    layers = [drawn.encode(x=x, y=alt.Y("y:Q", scale=y, axis=time))]
    if axis != "effects":
        dashed = base.mark_line(color=look.faint, strokeWidth=1.2, strokeDash=[5, 4], clip=True)
        layers.insert(0, dashed.encode(x=x, y=alt.Y("p:Q", scale=y, axis=time)))
    return alt.layer(*layers, width=150, height=200)


def _proportion(axis: str, row: dict[str, Any], anchor: dict[str, Any]) -> float:
    ratio = float(row["value"] / anchor["value"])
    return float(1e3 * anchor["time"] * (1 / ratio if axis == "cores" else ratio))
