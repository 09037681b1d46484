"""Statistics in words: what a page and a terminal show of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ident.rig.conditions import CONDITIONS
from ident.words.engineering import quantity
from ident.words.error import ERROR
from ident.words.message import message
from ident.words.number import count, plain
from ident.words.percent import percent_in_print
from schemas.statistics import ConditionLawView, DependenceView, LevelView, StatisticsView


@dataclass(frozen=True)
class Called:
    """A set that is out of control or far from the others."""

    fit: str
    serial: str
    value: str
    why: str


def facts(found: StatisticsView) -> list[tuple[str, str]]:
    """The numbers beside the chart."""
    shown = dict(_numbers(found))
    return list(shown.items())


def _numbers(found: StatisticsView) -> Iterator[tuple[str, str]]:
    def of(value: float | None) -> str:
        return "–" if value is None else _quantity(value, found)

    yield "Sets", str(message("sets.newest" if found.left_out else "sets", count=found.n, model=found.model))
    if found.unstable:
        yield "Unstable on a run", f"{count(found.unstable, 'set')}, in no number here"
    yield "Mean", of(found.mean)
    yield "Standard deviation", of(found.deviation)
    yield "Smallest, largest", f"{of(found.minimum)}, {of(found.maximum)}"
    yield "Median", of(found.percentiles["50"])
    yield "5 % to 95 % quantile", f"{of(found.percentiles['5'])} to {of(found.percentiles['95'])}"
    if chart := found.control_chart:
        yield "Control limits, 3 σ", f"{of(chart.lower)} to {of(chart.upper)}"
        yield "Mean moving range", of(chart.mean_range)
    if limits := found.limits:
        yield "Limits of the product", f"{of(limits.lower)} to {of(limits.upper)}; {limits.outside} outside"
    if able := found.capability:
        yield "Cpk, 95 % interval", f"{plain(able.cpk, 3)} ({plain(able.low, 3)} to {plain(able.high, 3)})"
    elif found.no_capability:
        yield "Cpk", f"not given: {found.no_capability}"
    if drift := found.drift:
        told = "significant" if drift.significant else "within chance"
        yield "Drift a year", f"{of(drift.slope)} ± {of(drift.std_error)}, {told} (p = {plain(drift.p, 2)})"


def called(found: StatisticsView) -> list[Called]:
    """Every set that breaks a rule, jumps, or lies far out, in the order of the chart."""
    why: dict[int, list[str]] = {}
    chart = found.control_chart
    for signal in chart.signals if chart else ():
        why.setdefault(signal.place, []).append(signal.text)
    for place in chart.wide_ranges if chart else ():
        why.setdefault(place, []).append("further from the one before than ranges should be")
    places = {point.fit: place for place, point in enumerate(found.points)}
    for far in found.outliers:
        why.setdefault(places[far.fit], []).append(f"outlier, modified z-score {plain(far.score, 2)}")
    return [
        Called(
            found.points[place].fit,
            found.points[place].serial,
            _quantity(found.points[place].value, found),
            "; ".join(dict.fromkeys(texts)),
        )
        for place, texts in sorted(why.items())
    ]


def of_dependence(found: DependenceView) -> list[tuple[str, str]]:
    """What the law over a condition says, and what it says at the condition that was asked for."""
    sets = message("sets", count=found.n, model=found.model) if found.n else "none"
    shown = [("Sets", str(sets)), ("Law", found.text)]
    condition = CONDITIONS[found.over]
    if found.without:
        shown.append((f"Without the {condition.title}", count(found.without, "set")))
    if (at := found.at) is not None:
        place = f"At {condition.said(at.condition)}"
        shown.append((place, _level(at.level, found) if at.level else at.reason))
        if at.outcome is not None:
            said = {"inside": "within the limits", "outside": "outside the limits", "unknown": "inconclusive"}
            shown.append((f"{place}, against the limits", said[at.outcome]))
    return shown


def laws(found: DependenceView) -> list[tuple[str, str, str, str, str]]:
    """The laws that were tried: name, formula, probability, scatter, chance of the lack of fit."""
    return [
        (
            one.name,
            one.formula,
            percent_in_print(one.probability),
            percent_in_print(one.scatter) if one.relative else _quantity(one.scatter, found),
            _lack_of_fit(one),
        )
        for one in found.laws
    ]


def _lack_of_fit(law: ConditionLawView) -> str:
    if law.lack_of_fit is None:
        return "–"
    p = plain(law.lack_of_fit, 2)
    return p if law.holds else str(message("law.does_not_hold", p=p))


def _level(level: LevelView, found: DependenceView) -> str:
    value, low, high = (_quantity(one, found) for one in (level.value, level.lower, level.upper))
    return f"{value}, 95 % band {low} to {high}"


def _quantity(value: float, found: StatisticsView | DependenceView) -> str:
    """A value of the parameter with its unit; errors are in per cent."""
    if found.parameter.startswith(ERROR):
        return percent_in_print(value, 4)
    return quantity(value, found.unit)
