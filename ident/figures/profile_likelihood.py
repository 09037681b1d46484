"""The profile likelihood of a parameter: how much worse the fit is with it held elsewhere, and its 95 % interval."""

from __future__ import annotations

import altair as alt

from ident.comparison.profile import BOUND, Profile
from ident.figures import words
from ident.figures.drawing import Drawing, Options
from ident.figures.render import Chart, Panel, datasets
from ident.figures.subjects import Profiled
from ident.figures.theme import Look
from ident.fit.result import FitResult
from ident.matrix import Actuator

_HIGHEST = 4.0  # times its bound, as far as D is shown: beyond it only says that the value is out of the question


def profile_likelihood(found: Profile, actuator: Actuator, fit: FitResult, look: Look) -> Chart:
    """D above, the error of eq. (17) below; the band is the 95 % interval, the line within it the estimate."""
    estimate = fit.parameters[found.parameter].value
    factor, unit = words.engineering([*found.values, estimate], found.unit)
    rows = [
        {"v": float(f"{value * factor:.8g}"), "d": float(f"{deviance:.5g}"), "e": float(f"{100 * error:.6g}")}
        for value, error, deviance in zip(found.values, found.errors, found.deviance, strict=True)
    ]
    low, high = rows[0]["v"], rows[-1]["v"]
    ends = [low if found.lower is None else found.lower * factor, high if found.upper is None else found.upper * factor]
    span = alt.Scale(domain=[min(low, estimate * factor), max(high, estimate * factor)], nice=False, zero=False)
    x = alt.X("v:Q", scale=span, axis=alt.Axis(title=words.axis(found.parameter, unit)))
    top = min(max(found.deviance), _HIGHEST * BOUND) or 1.0
    upper = alt.Y(
        "d:Q",
        scale=alt.Scale(domain=[0, 1.05 * max(top, BOUND)], nice=False),
        axis=alt.Axis(title="D (–)", tickCount=5),
    )
    lower = alt.Y("e:Q", scale=alt.Scale(zero=False), axis=alt.Axis(title="Error, eq. 17 (%)", tickCount=4))
    bound = (
        alt.Chart(alt.InlineData(values=[{"b": BOUND}]))
        .mark_rule(color=look.faint, strokeDash=[4, 3])
        .encode(y=alt.Y("b:Q"))
    )
    panels = [
        alt.layer(
            _interval(ends, look), bound, *_line(x, upper, look, 0), _estimate(estimate * factor, look)
        ).properties(width=look.across(560), height=190),
        alt.layer(_interval(ends, look), *_line(x, lower, look, 1), _estimate(estimate * factor, look)).properties(
            width=look.across(560), height=110
        ),
    ]
    told = found.text.replace(found.unit, words.tidy_unit(found.unit)) if found.unit else found.text
    subtitle = [words.verdict(fit), told, "dashed: 95 % threshold · vertical line: estimate"]
    title = alt.TitleParams(words.headline(actuator, f"profile likelihood of {found.parameter}"), subtitle=subtitle)
    chart: Chart = alt.vconcat(*panels, title=title, spacing=14, datasets=datasets({"profile": rows})).configure(
        **look.config()
    )
    return chart


def _line(x: alt.X, y: alt.Y, look: Look, series: int) -> tuple[Panel, Panel]:
    """A line through the values, and a point at each."""
    tip = [
        alt.Tooltip("v:Q", title="Value"),
        alt.Tooltip("d:Q", title="D"),
        alt.Tooltip("e:Q", title="Error (%)"),
    ]
    of = alt.Chart(alt.NamedData("profile"))
    line = of.mark_line(clip=True, color=look.series[series]).encode(x=x, y=y)
    return line, of.mark_circle(clip=True, size=40, opacity=1, color=look.series[series]).encode(x=x, y=y, tooltip=tip)


def _interval(ends: list[float], look: Look) -> Panel:
    rows = alt.InlineData(values=[{"low": ends[0], "high": ends[1]}])
    band: Panel = alt.Chart(rows).mark_rect(color=look.faint, opacity=0.2).encode(x=alt.X("low:Q"), x2="high:Q")
    return band


def _estimate(value: float, look: Look) -> Panel:
    rows = alt.InlineData(values=[{"v": value}])
    upright: Panel = alt.Chart(rows).mark_rule(color=look.ink).encode(x=alt.X("v:Q"))
    return upright


def _drawn(of: Profiled, look: Look, _: Options) -> Chart:
    return profile_likelihood(of.profile, of.actuator, of.fit, look)


PROFILE_LIKELIHOOD = Drawing("profile", "Profile likelihood", Profiled, _drawn)
