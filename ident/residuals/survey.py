"""Everything that says where a fitted model fails, in one object."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from ident.comparison.compare import Comparison
from ident.errors import Unusable
from ident.residuals.breakdown import Breakdown, breakdown
from ident.residuals.budget import Budget, budget
from ident.residuals.curves import Curve, curve_fits, curves_of, traced
from ident.residuals.trends import Trend, trends
from ident.residuals.whiteness import Whiteness, by_use
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult
from ident.words.titles import data


@dataclass(frozen=True)
class Survey(TabularResult):
    """Errors by condition, the curves that explain most first, parameters that follow a condition, the budget."""

    where: Breakdown
    curves: tuple[Curve, ...]
    trends: tuple[Trend, ...]
    budget: Budget | None
    white: Mapping[str, Whiteness] = field(default_factory=dict)

    def listings(self) -> Iterator[Listing | str]:
        """Errors by condition, the curves, the parameters that follow a condition, the budget."""
        rows = [(g.by, g.label, str(g.runs), percent(g.error), percent(g.mean)) for g in self.where.groups]
        yield Listing("", ("by", "", "runs", "error", "mean"), rows, ("runs", "error", "mean"))
        if self.curves:
            curves = [(c.name, c.missing, c.against, percent(max(c.explained, 0.0))) for c in self.curves]
            yield Listing("", ("residual", "shows", "against", "explained"), curves, ("explained",))
        for trend in self.trends:
            if trend.clear:
                values = " → ".join(f"{point.value:.4g}" for point in trend.points)
                change = f"{values} {trend.unit} (p = {trend.p:.2g})"
                yield f"{trend.parameter} depends on the {trend.condition}: {change}; the model is missing an effect"
        for use, found in self.white.items():
            yield f"whiteness of the residual on {data(use)}: {found}"
        if self.budget is not None:
            yield from self.budget.listings()

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        groups: dict[str, list[dict[str, Any]]] = {}
        for group in self.where.groups:
            groups.setdefault(group.by, []).append({k: v for k, v in asdict(group).items() if k != "by"})
        return {
            "bands": {"edges": list(self.where.edges), "runs": [asdict(run) for run in self.where.runs]},
            "groups": groups,
            "curves": [curve.to_json() for curve in self.curves],
            "whiteness": {use: asdict(found) for use, found in self.white.items()},
            "trends": [asdict(trend) for trend in self.trends],
            "budget": None if self.budget is None else self.budget.to_json(),
        }


def survey(comparison: Comparison) -> Survey:
    """Where the model fails on the runs that it is stable at."""
    shown = breakdown(comparison)
    try:
        found = traced(comparison)
        return Survey(shown, curves_of(found, curve_fits(found)), trends(found), budget(comparison), by_use(comparison))
    except Unusable as error:
        if error.code != "unstable-model":
            raise
        return Survey(shown, (), (), None)
