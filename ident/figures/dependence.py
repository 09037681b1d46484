"""A parameter of several sets over a condition of their tests, with its law and the 95 % band of the law."""

from __future__ import annotations

import textwrap
from typing import Any

import altair as alt
import numpy as np

from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart
from ident.figures.subjects import OverCondition
from ident.figures.theme import Look

_DRAWN = 81  # conditions of the line
_LETTERS = 88  # of a line of the caption


def dependence(of: OverCondition, look: Look) -> Chart:
    """Sets as points, the law of most evidence as a line in its band, dotted the limits of the product.

    A law that does not hold is dashed, without a band. The axis of a viscosity is logarithmic.
    """
    own, condition = of.dependence, of.dependence.condition
    given = [limit for limit in of.limits if limit is not None]
    factor, unit = words.engineering([*own.values, *given], of.unit)

    def shown(value: float) -> float:
        return float(f"{(value - condition.offset) / condition.factor:.6g}")

    rows = [
        {"x": shown(x), "y": float(f"{factor * y:.6g}"), "of": label}
        for x, y, label in zip(own.conditions, own.values, of.labels, strict=True)
    ]
    x = alt.X("x:Q", title=words.axis(condition.title, condition.shown or "1"), scale=alt.Scale(zero=False))
    viscous = own.law is not None and own.law.form.viscous
    scale = alt.Scale(type="log", nice=False) if viscous else alt.Scale(zero=False)
    y = alt.Y("y:Q", title=words.axis(of.quantity, unit), scale=scale)
    tooltip = [
        alt.Tooltip("of:N", title="Set of"),
        alt.Tooltip("x:Q", title=condition.title),
        alt.Tooltip("y:Q", title=of.quantity),
    ]
    points = alt.Chart(alt.InlineData(values=rows)).mark_circle(size=36, color=look.series[0], opacity=1)
    layers: list[Any] = [*_law(of, factor, shown, x, look), points.encode(x=x, y=y, tooltip=tooltip)]
    if given:
        limits = alt.InlineData(values=[{"y": factor * limit} for limit in given])
        layers.append(alt.Chart(limits).mark_rule(strokeDash=[2, 3], color=look.series[1]).encode(y="y:Q"))
    said = textwrap.wrap(str(own.text), look.across(_LETTERS))
    title = alt.TitleParams(f"{of.quantity} over the {condition.title}, {of.where}: {len(rows)} sets", subtitle=said)
    made: Chart = (
        alt.layer(*layers).properties(width=look.across(560), height=320, title=title).configure(**look.config())
    )
    return made


def _law(of: OverCondition, factor: float, shown: Any, x: alt.X, look: Look) -> list[Any]:
    """The line of the law, and the area of its band where it holds."""
    law = of.dependence.law
    if law is None:
        return []
    at = np.linspace(min(of.dependence.conditions), max(of.dependence.conditions), _DRAWN).tolist()
    levels = [(shown(one), law.at(one)) for one in at]
    rows = [
        {"x": place, "y": factor * level.value, "low": factor * level.lower, "high": factor * level.upper}
        for place, level in levels
    ]
    base = alt.Chart(alt.InlineData(values=rows))
    line = base.mark_line(color=look.ink, strokeWidth=1.5, strokeDash=[1, 0] if law.holds else [6, 4])
    drawn: list[Any] = [line.encode(x=x, y="y:Q")]
    if law.holds:
        drawn.insert(0, base.mark_area(color=look.series[0], opacity=0.2).encode(x=x, y="low:Q", y2="high:Q"))
    return drawn


def _drawn(of: OverCondition, look: Look, _: Options) -> Chart:
    return dependence(of, look)


DEPENDENCE = Drawing("dependence", "Parameter over a condition", OverCondition, _drawn)
