"""The tables of the report, as text."""

from __future__ import annotations

from collections.abc import Sequence

from ident.diagnosis.result import Diagnosis
from ident.figures.subjects import Step
from ident.residuals.breakdown import Breakdown, Group
from ident.residuals.budget import Budget
from ident.residuals.curves import Curve
from ident.residuals.trends import Trend
from ident.words.engineering import quantity
from ident.words.error import error_in_print
from ident.words.percent import percent_in_print, probability_said
from ident.words.titles import title

Row = tuple[str, ...]
_FIRST = "as fitted"
_MEANS = {
    "noise": "measurement noise (no model can remove it)",
    "linear": "linear model error (a better linear model would remove it)",
    "nonlinear": "nonlinear model error (only a nonlinear model would remove it)",
}


def budget_rows(budget: Budget | None) -> tuple[Row, ...]:
    """Part, what it is, its size, from, to."""
    if budget is None:
        return ()
    sizes = {"noise": budget.noise, "linear": budget.linear, "nonlinear": budget.nonlinear}
    return tuple(
        (
            name,
            means,
            "unknown" if sizes[name] is None else percent_in_print(sizes[name]),
            *(percent_in_print(bound) for bound in budget.bounds[name]),
        )
        for name, means in _MEANS.items()
    )


def group_tables(found: Breakdown) -> dict[str, list[Group]]:
    """The groups by what they have in common."""
    tables: dict[str, list[Group]] = {}
    for group in found.groups:
        tables.setdefault(group.by, []).append(group)
    return tables


def curve_rows(curves: Sequence[Curve]) -> tuple[Row, ...]:
    """Name, what is missing, against what, explained."""
    return tuple((c.name, c.missing, c.against, percent_in_print(max(c.explained, 0.0), 2)) for c in curves)


def trend_rows(trends: Sequence[Trend]) -> tuple[Row, ...]:
    """Parameter, condition, values, p: those that are clear."""
    return tuple(
        (t.parameter, t.condition, " → ".join(quantity(p.value, t.unit) for p in t.points), f"{t.p:.2g}")
        for t in trends
        if t.clear
    )


def ladder_steps(diagnosis: Diagnosis) -> list[Step]:
    """The ladder as its figure takes it, the fitted model first."""
    steps: list[Step] = [
        (title(rung.added) if rung.added else _FIRST, rung.error.get("fit"), rung.error.get("verify"))
        for rung in diagnosis.ladder
    ]
    first = diagnosis.baseline.error
    if first and not (diagnosis.ladder and diagnosis.ladder[0].added is None):
        steps.insert(0, (_FIRST, first.get("fit"), first.get("verify")))
    return steps


def candidate_rows(diagnosis: Diagnosis) -> tuple[Row, ...]:
    """Effect, probability, predicted error, errors, why."""
    return tuple(
        (
            title(c.effect),
            probability_said(c.probability),
            error_in_print(c.predicted_error),
            *(c.error_of(use).in_print() for use in ("fit", "held_out", "verify")),
            c.why,
        )
        for c in diagnosis.candidates
    )
