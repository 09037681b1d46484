"""Where every start of the polish ended: its error, and the parameters there over those of the best."""

from __future__ import annotations

from typing import Any

import altair as alt

from ident.errors import Unusable
from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, datasets
from ident.figures.study import Study
from ident.figures.theme import Look
from ident.fit.result import FitResult, Starts
from ident.matrix import Actuator

_ROUND = 1.1  # times the least: as far as an axis reaches at least, so that what agrees is seen to agree
_LIMIT = 8  # parameters, each with a colour of its own


def starts(actuator: Actuator, fit: FitResult, look: Look) -> Chart:
    """Ends in the order of their errors, the best first. Raises Unusable where the fit did not keep them."""
    found = fit.starts
    if found is None or not found.errors:
        raise Unusable(
            "no-starts",
            "this fit has stored no starts",
            "figure starts",
            "fit again by a search, with --option starts=30 for thirty of them",
        )
    shown = [name for name in fit.searched if name in found.values][:_LIMIT]
    tables = {"ends": _errors(found), "values": _values(found, shown)}
    x = alt.X(
        "n:Q",
        axis=alt.Axis(title="Optimiser start, sorted by final error (–)", format="d", tickMinStep=1),
        scale=alt.Scale(domain=[0.5, found.tried + 0.5], nice=False),
    )
    errors = [100 * found.errors[0] / _ROUND, 100 * found.errors[-1] * _ROUND]
    log = alt.Scale(type="log", nice=False, domain=errors)
    y = alt.Y("e:Q", scale=log, axis=alt.Axis(title="Final error, eq. 17 (%)", tickCount=4, format=".3~r"))
    upper = alt.Chart(alt.NamedData("ends"), width=look.across(560), height=150)
    line = upper.mark_line(color=look.faint, strokeWidth=1).encode(x=x, y=y)
    dots = upper.mark_circle(size=45, opacity=1, color=look.series[0]).encode(x=x, y=y, tooltip=["n:Q", "e:Q"])
    colours = alt.Scale(domain=shown, range=list(look.series[: len(shown)]))
    colour = alt.Color("p:N", title=None, scale=colours, legend=alt.Legend(orient="bottom", columns=_LIMIT))
    ends = [row["v"] for row in tables["values"]]
    wide = alt.Scale(domain=[min(1 / _ROUND, *ends), max(_ROUND, *ends)]) if ends else alt.Scale()
    ratio = alt.Y("v:Q", axis=alt.Axis(title="Value / value of the best start (–)", tickCount=5), scale=wide)
    lower = (
        alt.Chart(alt.NamedData("values"), width=look.across(560), height=190)
        .mark_line(point=True, strokeWidth=1)
        .encode(x=x, y=ratio, color=colour, tooltip=["p:N", "n:Q", "v:Q"])
    )
    title = alt.TitleParams(
        words.headline(actuator, f"final error of {found.tried} optimiser starts"),
        subtitle=[words.verdict(fit), f"{found}: their final error is within 0.1 % of the least"],
    )
    panels = [alt.layer(line, dots), lower] if shown else [alt.layer(line, dots)]
    chart: Chart = alt.vconcat(*panels, title=title, spacing=16, datasets=datasets(tables)).configure(**look.config())
    return chart


def _errors(found: Starts) -> list[dict[str, Any]]:
    return [{"n": n, "e": float(f"{100 * error:.5g}")} for n, error in enumerate(found.errors, 1)]


def _values(found: Starts, shown: list[str]) -> list[dict[str, Any]]:
    """What ended at nothing with the best has no ratio, and is not drawn."""
    return [
        {"p": name, "n": n, "v": float(f"{value / found.values[name][0]:.5g}")}
        for name in shown
        if found.values[name][0]
        for n, value in enumerate(found.values[name], 1)
    ]


def _draw(study: Study, look: Look, _: Options) -> Chart:
    return starts(study.matrix.actuator, study.fit, look)


STARTS = Drawing("starts", "Starts", Study, _draw)
