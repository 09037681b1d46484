"""The search as it converged: populations and errors over generations (the paper's Figs. 13, 14)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import altair as alt

from ident.custom.definition import preset_with
from ident.errors import Unusable
from ident.figures import words
from ident.figures.drawing import Choices, Drawing, Offer, Option, Options, Several
from ident.figures.render import Chart, Panel, datasets
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.figures.thinning import significant
from ident.fit.result import FitResult, Generation
from ident.matrix import Actuator

DEFAULT_GENERATIONS = (1, 4, 8)
_DECADES = 30.0  # ratio of the ends above which an axis is logarithmic


def evolution(
    actuator: Actuator,
    fit: FitResult,
    look: Look,
    *,
    x: str | None = None,
    y: str | None = None,
    generations: Several = None,
) -> Chart:
    """Scatter of two searched parameters at chosen generations, and best and mean error (%) over generation.

    Defaults: Z0 against c0 (or the first two searched) at generations 1, 4, 8 and the last. Raises Unusable where
    nothing was searched or a name was not.
    """
    if not fit.evolution:
        raise Unusable(
            "no-evolution", "this fit has stored no generations", "figure evolution", "fit with free parameters"
        )
    panels: list[Panel | alt.HConcatChart] = []
    tables: dict[str, list[dict[str, Any]]] = {"history": _history_rows(fit)}
    pair = _pair(fit, x, y)
    pictured = [entry for entry in _pictured(fit, generations) if entry.population]
    if pair and pictured:
        axes = (_Axis.of(fit, pair[0], pictured), _Axis.of(fit, pair[1], pictured))
        tables |= {_table(entry): _points(entry, axes) for entry in pictured}
        tables["found"] = _found(fit, axes)
        panels.append(_scatter(look, axes, pictured))
    panels.append(_history(look, wide=bool(panels)))
    title = alt.TitleParams(
        words.headline(actuator, "how the search converged"),
        subtitle=words.wrapped(
            [
                words.verdict(fit),
                f"Method {fit.method}, seed {fit.seed}, {fit.evaluations:,} evaluations",
                "cross: the final estimate, after the refinement (Levenberg-Marquardt) that follows the search",
            ],
            look,
        ),
    )
    chart: Chart = (
        alt.vconcat(*panels, title=title, spacing=24, datasets=datasets(tables))
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
    usual = [
        name for wanted in preset_with(fit.model).display.shown for name in fit.searched if name.split("/")[0] == wanted
    ]  # Z0, Z0/A^2
    preferred = [*usual, *fit.searched]
    first = x or next((name for name in preferred if name != y), None)
    second = y or next((name for name in preferred if name != first), None)
    return (first, second) if first and second else None


def _pictured(fit: FitResult, wanted: Several) -> list[Generation]:
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


@dataclass(frozen=True)
class _Axis:
    """One searched parameter as an axis: its values are multiplied by `factor` to be in the unit of `title`."""

    name: str
    place: int
    factor: float
    title: str
    domain: tuple[float, float]
    wide: bool  # logarithmic

    @classmethod
    def of(cls, fit: FitResult, name: str, pictured: Sequence[Generation]) -> _Axis:
        """Reaches over the bounds of the search and over what was tried outside the final ones."""
        place, estimate = fit.searched.index(name), fit.parameters[name]
        tried = [vector[place] for entry in pictured for vector in entry.population]
        low, high = min(*tried, estimate.lower), max(*tried, estimate.upper)
        wide = low > 0 and high > _DECADES * low
        factor, unit = words.whole(estimate.unit) if wide else words.engineering((low, high), estimate.unit)
        return cls(name, place, factor, words.axis(name, unit), (factor * low, factor * high), wide)

    @property
    def scale(self) -> alt.Scale:
        """Linear, or logarithmic where the values span decades."""
        low, high = self.domain
        if self.wide:
            return alt.Scale(type="log", domain=[low, high], nice=False)
        return alt.Scale(domain=[low, high], nice=False)

    @property
    def format(self) -> str:
        """Of the labels: in full where the axis is linear; powers of ten where decades need them."""
        return "~g" if self.wide else "~r"


def _table(entry: Generation) -> str:
    return f"generation{entry.index}"


def _points(entry: Generation, axes: tuple[_Axis, _Axis]) -> list[dict[str, Any]]:
    """x and y in the axes' units, e the error in %."""
    errors = entry.errors or (math.nan,) * len(entry.population)
    x, y = ([axis.factor * vector[axis.place] for vector in entry.population] for axis in axes)
    table = zip(significant(x, 4), significant(y, 4), significant([100 * error for error in errors], 4), strict=True)
    return [{"x": a, "y": b, "e": e if math.isfinite(e) else None} for a, b, e in table]


def _found(fit: FitResult, axes: tuple[_Axis, _Axis]) -> list[dict[str, Any]]:
    """The final estimate."""
    x, y = (axis.factor * fit.parameters[axis.name].value for axis in axes)
    return [{"x": x, "y": y}]


def _scatter(look: Look, axes: tuple[_Axis, _Axis], pictured: Sequence[Generation]) -> alt.HConcatChart:
    """One panel a generation, all on the same axes."""
    errors = [error for entry in pictured for error in entry.errors if math.isfinite(error)]
    ramp = alt.Scale(type="log", domain=_ends(errors), range=list(reversed(look.ramp)), clamp=True)
    legend = alt.Legend(title="Error (%)", orient="right", format="~r", tickCount=4)
    colour = alt.Color("e:Q", scale=ramp, legend=legend)
    width = max(95, look.across(600 / len(pictured)))
    panels = [
        _generation(entry, axes, look, colour, first=entry is pictured[0]).properties(width=width) for entry in pictured
    ]
    row: alt.HConcatChart = alt.hconcat(*panels, spacing=18, bounds="flush").resolve_scale(color="shared")
    return row


def _ends(errors: Sequence[float]) -> list[float]:
    """Ends of the colour scale in %, the worst tenth left out so that the good ones can be told apart."""
    ordered = sorted(100 * error for error in errors if error > 0) or [1.0, 10.0]
    low, high = ordered[0], ordered[int(0.9 * (len(ordered) - 1))]
    return significant([low, max(high, 1.05 * low)], 3)


def _generation(entry: Generation, axes: tuple[_Axis, _Axis], look: Look, colour: alt.Color, *, first: bool) -> Panel:
    across, up = axes
    x = alt.X(
        "x:Q",
        scale=across.scale,
        axis=alt.Axis(
            title=across.title,
            tickCount=4,
            format=across.format,
            labelOverlap="greedy",
            labelSeparation=6,
            labelBound=True,
        ),
    )
    ticks = alt.Axis(title=up.title if first else None, labels=first, tickCount=5, format=up.format)
    y = alt.Y("y:Q", scale=up.scale, axis=ticks)
    named = {"x:Q": across.title, "y:Q": up.title, "e:Q": "Error (%)"}
    tips = [alt.Tooltip(field, title=title) for field, title in named.items()]
    cloud = alt.Chart(alt.NamedData(_table(entry))).mark_circle(size=16, opacity=0.75, clip=True)
    cross = alt.Chart(alt.NamedData("found")).mark_point(
        shape="cross", size=110, color=look.ink, strokeWidth=1.4, filled=False
    )
    heading = alt.TitleParams(f"Generation {entry.index}", fontSize=12, offset=6, frame="group")
    layers = (cloud.encode(x=x, y=y, color=colour, tooltip=tips), cross.encode(x="x:Q", y="y:Q"))
    return alt.layer(*layers, height=190, title=heading)


def _history_rows(fit: FitResult) -> list[dict[str, Any]]:
    """g generation, e error in %, s which."""
    return [
        {"g": entry.index, "e": float(f"{100 * value:.5g}"), "s": name}
        for entry in fit.evolution
        for name, value in (("best", entry.best), ("mean", entry.mean))
        if math.isfinite(value) and value > 0
    ]


def _history(look: Look, wide: bool) -> Panel:
    """Best and mean error in % over generation."""
    colour = alt.Color(
        "s:N",
        scale=alt.Scale(domain=["best", "mean"], range=list(look.series[:2])),
        legend=alt.Legend(title=None, orient="top-right", symbolType="stroke", symbolSize=400),
    )
    x = alt.X("g:Q", scale=alt.Scale(nice=False), axis=alt.Axis(title="Generation (–)", format="d", tickMinStep=1))
    y_axis = alt.Axis(title="Error, eq. (17) (%)", tickCount=5, format="~r")
    y = alt.Y("e:Q", scale=alt.Scale(type="log", nice=True), axis=y_axis)
    tips = [
        alt.Tooltip("g:Q", title="Generation"),
        alt.Tooltip("s:N", title="Of"),
        alt.Tooltip("e:Q", title="Error (%)"),
    ]
    panel: Panel = (
        alt.Chart(alt.NamedData("history"), width=look.across(720 if wide else 640), height=190)
        .mark_line(point=alt.OverlayMarkDef(size=18), strokeWidth=1.6)
        .encode(x=x, y=y, color=colour, tooltip=tips)
    )
    return panel


def _searched(of: Offer) -> Choices:
    """The parameters of the search, where there are two to set against each other."""
    return (("", "default"), *((name, name) for name in of.fit.searched)) if len(of.fit.searched) > 1 else ()


def _drawn(study: Study, look: Look, options: Options) -> Chart:
    return evolution(study.matrix.actuator, study.fit, look, **options)


EVOLUTION = Drawing(
    "evolution",
    "Evolution",
    Study,
    _drawn,
    (Option("x", "Across", str | None, _searched), Option("y", "Up", str | None, _searched), Option("generations")),
    share=0.63,
)
