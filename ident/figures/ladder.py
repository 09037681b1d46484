"""The error after each step of adding effects, on runs to fit and to verify, down to the noise floor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import altair as alt

from ident.errors import Unusable
from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, datasets
from ident.figures.subjects import Ladder, Step
from ident.figures.theme import Look
from ident.matrix import Actuator

_LABEL: dict[str, Any] = {"align": "left", "dx": 7, "dy": 12, "fontSize": 11}  # of a point: where its error is written


def ladder(steps: Sequence[Step], floor: float | None, actuator: Actuator, look: Look) -> Chart:
    """Steps from top to bottom, errors (fractions, drawn in per cent) to the right on a logarithmic axis.

    `floor` is the noise floor, drawn as a line. Raises Unusable without a step.
    """
    if not steps:
        raise Unusable("no-steps", "no step to draw", "figure ladder", "give at least the fitted model's error")
    order = [f"{place}. {label}" if place else label for place, (label, _, _) in enumerate(steps)]
    rows: list[dict[str, Any]] = [
        {"step": name, "e": float(f"{100 * error:.4g}"), "u": use, "t": words.percent(error)}
        for name, (_, fit, verify) in zip(order, steps, strict=True)
        for use, error in (("estimation data", fit), ("validation data", verify))
        if error is not None
    ]
    uses = [use for use in ("estimation data", "validation data") if any(row["u"] == use for row in rows)]
    colour = alt.Color(
        "u:N",
        title=None,
        scale=alt.Scale(domain=uses, range=list(look.series[: len(uses)])),
        legend=alt.Legend(orient="bottom", symbolType="circle", symbolOpacity=1),
    )
    lowest = min([row["e"] for row in rows] + ([100 * floor] if floor else []))
    scale = alt.Scale(type="log", domain=[0.8 * lowest, 1.5 * max(row["e"] for row in rows)], nice=False)
    x = alt.X("e:Q", scale=scale, axis=alt.Axis(title="Error, eq. 17 (%)", format="~r", tickCount=6))
    y = alt.Y("step:N", sort=order, axis=alt.Axis(title=None, labelLimit=320, grid=True, ticks=False, labelFontSize=12))
    base = alt.Chart(alt.NamedData("steps")).encode(x=x, y=y, color=colour)
    named = base.transform_filter(f"datum.u == '{uses[-1]}'")
    layers: list[alt.Chart] = [
        base.mark_line(strokeWidth=1.5, opacity=0.6).encode(order="row:Q").transform_window(row="row_number()"),
        base.mark_circle(size=70, opacity=1).encode(tooltip=[alt.Tooltip("step:N", title="Step"), "u:N", "t:N"]),
    ]
    if floor:
        at = alt.Chart(alt.NamedData("steps")).encode(x=alt.datum(100 * floor))
        layers.append(at.mark_rule(color=look.ink, strokeDash=[5, 3], strokeWidth=1.3))
    ground = named.mark_text(**_LABEL, stroke=look.ground, strokeWidth=4).encode(text="t:N")  # the rule ends before it
    layers += [ground, named.mark_text(**_LABEL).encode(text="t:N")]
    said = f"dashed: noise floor {words.percent(floor)}" if floor else "noise floor unknown"
    title = alt.TitleParams(words.headline(actuator, "the error with each effect added"), subtitle=[said])
    chart: Chart = alt.layer(
        *layers, width=460, height=max(80, 38 * len(steps)), title=title, datasets=datasets({"steps": rows})
    ).configure(**look.config())
    return chart


def _drawn(of: Ladder, look: Look, _: Options) -> Chart:
    return ladder(of.steps, of.floor, of.actuator, look)


LADDER = Drawing("ladder", "Error with each effect added", Ladder, _drawn)
