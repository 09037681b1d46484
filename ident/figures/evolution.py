"""The search as it converged: populations and errors over generations (the paper's Figs. 13, 14)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import altair as alt

from ident.errors import Unusable
from ident.figures import words
from ident.figures.choose import Option
from ident.figures.look import Look
from ident.figures.render import Chart
from ident.figures.thin import significant
from ident.fit.result import FitResult, Generation
from ident.matrix import Actuator

DEFAULT_PAIR = ("Z0", "c0")
DEFAULT_GENERATIONS = (1, 4, 8)


def evolution(
    actuator: Actuator,
    fit: FitResult,
    look: Look,
    *,
    x: str | None = None,
    y: str | None = None,
    generations: Option = None,
) -> Chart:
    """Scatter of two searched parameters at chosen generations, and best and mean error (%) over generation.

    Defaults: Z0 against c0 (or the first two searched) at generations 1, 4, 8 and the last. Raises Unusable where
    nothing was searched or a name was not.
    """
    if not fit.evolution:
        raise Unusable(
            "no-evolution", "no generations are kept in this fit", "figure evolution", "fit with free parameters"
        )
    panels: list[Any] = []
    pair = _pair(fit, x, y)
    pictured = [entry for entry in _pictured(fit, generations) if entry.population]
    if pair and pictured:
        panels.append(_scatter(fit, look, pair, pictured))
    panels.append(_history(fit, look, wide=bool(panels)))
    title = alt.TitleParams(
        words.headline(actuator, "how the search converged"),
        subtitle=[
            words.verdict(fit),
            f"Method {fit.method}, seed {fit.seed}, {fit.evaluations:,} evaluations · cross: the final estimate",
        ],
    )
    chart: Chart = (
        alt.vconcat(*panels, title=title, spacing=24, datasets=tables)
        .resolve_scale(color="independent")
        .configure(**look.config())
    )
    return chart


def _pair(fit: FitResult, x: str | None, y: str | None) -> tuple[str, str] | None:
    """The two parameters to draw; None where only one was searched."""
    for name in (x, y):
        if name is not None and name not in fit.searched:
            raise Unusable(
                "not-searched", f"{name!r} was not searched", "figure option", f"use {', '.join(fit.searched)}"
            )
    preferred = [name for name in (*DEFAULT_PAIR, *fit.searched) if name in fit.searched]
    first = x or next((name for name in preferred if name != y), None)
    second = y or next((name for name in preferred if name != first), None)
    return (first, second) if first and second else None


def _pictured(fit: FitResult, wanted: Option) -> list[Generation]:
    """Generations by number; the defaults are cut to those that there are, and the last one is always among them."""
    last = fit.evolution[-1].index
    if wanted is None:
        numbers = {number for number in DEFAULT_GENERATIONS if number < last} | {last}
    else:
        given = [wanted] if isinstance(wanted, str | float | int) else wanted
        try:
            numbers = {int(number) for number in given}
        except ValueError:
            raise Unusable("not-a-number", f"generations {wanted!r}", "figure option", "give whole numbers") from None
    chosen = [entry for entry in fit.evolution if entry.index in numbers]
    if not chosen:
        raise Unusable("no-such-generation", f"none of {sorted(numbers)}", "figure option", f"use 1 to {last}")
    return chosen


def _scatter(fit: FitResult, look: Look, pair: tuple[str, str], pictured: Sequence[Generation]) -> alt.HConcatChart:
    """One panel a generation, all on the same axes: the bounds of the search."""
    errors = [error for entry in pictured for error in entry.errors if math.isfinite(error)]
    ramp = alt.Scale(type="log", domain=_positive(errors), range=list(reversed(look.ramp)), clamp=True)
    colour = alt.Color(
        "e:Q", scale=ramp, legend=alt.Legend(title="Error (%)", orient="right", format=".3~g", tickCount=4)
    )
    width = max(150, 600 // len(pictured))
    panels = [
        _generation(fit, look, pair, entry, colour, width=width, first=place == 0)
        for place, entry in enumerate(pictured)
    ]
    return alt.hconcat(*panels, spacing=18, bounds="flush").resolve_scale(color="shared")


def _positive(errors: Sequence[float]) -> list[float]:
    """Ends of the colour scale in %, the worst tenth left out so that the good ones can be told apart."""
    ordered = sorted(100 * error for error in errors if error > 0) or [1.0, 10.0]
    low, high = ordered[0], ordered[int(0.9 * (len(ordered) - 1))]
    return significant([low, max(high, 1.05 * low)], 3)


def _generation(
    fit: FitResult, look: Look, pair: tuple[str, str], entry: Generation, colour: alt.Color, *, width: int, first: bool
) -> alt.LayerChart:
    places = [fit.searched.index(name) for name in pair]
    (fx, tx, dx), (fy, ty, dy) = (_axis(fit, name) for name in pair)
    errors = entry.errors or (float("nan"),) * len(entry.population)
    rows = [
        {"x": a, "y": b, "e": e if math.isfinite(e) else None}
        for a, b, e in zip(
            significant([fx * vector[places[0]] for vector in entry.population], 4),
            significant([fy * vector[places[1]] for vector in entry.population], 4),
            significant([100 * error for error in errors], 4),
            strict=True,
        )
    ]
    x = alt.X("x:Q", scale=alt.Scale(domain=dx, nice=False), axis=alt.Axis(title=tx, tickCount=4))
    y = alt.Y(
        "y:Q",
        scale=alt.Scale(domain=dy, nice=False),
        axis=alt.Axis(title=ty if first else None, labels=first, tickCount=5, format="~r"),
    )
    tips = [alt.Tooltip("x:Q", title=tx), alt.Tooltip("y:Q", title=ty), alt.Tooltip("e:Q", title="Error (%)")]
    cloud = alt.Chart(alt.Data(values=rows)).mark_circle(size=16, opacity=0.75, clip=True)
    found = alt.Chart(alt.Data(values=_found(fit, pair, fx, fy))).mark_point(
        shape="cross", size=110, color=look.ink, strokeWidth=1.4, filled=False
    )
    layers = cloud.encode(x=x, y=y, color=colour, tooltip=tips) + found.encode(x="x:Q", y="y:Q")
    heading = alt.TitleParams(f"Generation {entry.index}", fontSize=12, offset=6, frame="group")
    return layers.properties(width=width, height=190, title=heading)


def _axis(fit: FitResult, name: str) -> tuple[float, str, list[float]]:
    """(factor, title, domain) of a searched parameter: its bounds, or the range of the first population."""
    estimate = fit.parameters.get(name)
    place = fit.searched.index(name)
    seen = [vector[place] for entry in fit.evolution for vector in entry.population]
    ends = (min(seen), max(seen)) if estimate is None else (estimate.lower, estimate.upper)
    factor, unit = words.engineering(ends, "1" if estimate is None else estimate.unit)
    return factor, words.axis(name, unit), [factor * ends[0], factor * ends[1]]


def _found(fit: FitResult, pair: tuple[str, str], fx: float, fy: float) -> list[dict[str, float]]:
    """The final estimate, where both parameters have one."""
    if any(name not in fit.parameters for name in pair):
        return []
    return [{"x": fx * fit.parameters[pair[0]].value, "y": fy * fit.parameters[pair[1]].value}]


def _history(fit: FitResult, look: Look, wide: bool) -> alt.Chart:
    """Best and mean error in % over generation."""
    rows = [
        {"g": entry.index, "e": float(f"{100 * value:.5g}"), "s": name}
        for entry in fit.evolution
        for name, value in (("best", entry.best), ("mean", entry.mean))
        if math.isfinite(value) and value > 0
    ]
    colour = alt.Color(
        "s:N",
        scale=alt.Scale(domain=["best", "mean"], range=list(look.series[:2])),
        legend=alt.Legend(title=None, orient="top-right", symbolType="stroke", symbolSize=400),
    )
    return (
        alt.Chart(alt.Data(values=rows), width=720 if wide else 640, height=190)
        .mark_line(point=alt.OverlayMarkDef(size=18), strokeWidth=1.6)
        .encode(
            x=alt.X(
                "g:Q", title="Generation (–)", scale=alt.Scale(nice=False), axis=alt.Axis(format="d", tickMinStep=1)
            ),
            y=alt.Y(
                "e:Q",
                title="Error, eq. (17) (%)",
                scale=alt.Scale(type="log", nice=True),
                axis=alt.Axis(tickCount=5, format="~r"),
            ),
            color=colour,
            tooltip=[
                alt.Tooltip("g:Q", title="Generation"),
                alt.Tooltip("s:N", title="Of"),
                alt.Tooltip("e:Q", title="Error (%)"),
            ],
        )
    )
