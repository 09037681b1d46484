"""Where a model fails, as tables for a reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.cli.tables import output, table
from ident.words.percent import percent

if TYPE_CHECKING:
    from ident.residuals.budget import Budget
    from ident.residuals.survey import Survey


def show_survey(found: Survey) -> None:
    """Print errors by condition, the curves, the parameters that follow a condition, the budget."""
    console = output()
    rows = [(g.by, g.label, str(g.runs), percent(g.error), percent(g.mean)) for g in found.where.groups]
    console.print(table(("by", "", "runs", "error", "mean"), rows, numbers=("runs", "error", "mean")))
    if found.curves:
        curves = [(c.name, c.missing, c.against, percent(max(c.explained, 0.0))) for c in found.curves]
        console.print(table(("residual", "shows", "against", "explained"), curves, numbers=("explained",)))
    for trend in found.trends:
        if trend.clear:
            values = " → ".join(f"{point.value:.4g}" for point in trend.points)
            console.print(
                f"{trend.parameter} follows the {trend.condition}: {values} {trend.unit} (p = {trend.p:.2g})",
                markup=False,
            )
    if found.budget is not None:
        show_budget(found.budget)


def show_budget(budget: Budget) -> None:
    """Print what the error of the runs to fit is made of."""
    sizes = {"noise": budget.noise, "linear": budget.linear, "nonlinear": budget.nonlinear}
    rows = [(name, percent(size), *map(percent, budget.bounds[name])) for name, size in sizes.items()]
    numbers = ("size", "at least", "at most")
    output().print(table(("error budget", *numbers), rows, numbers=numbers))
    for note in budget.notes:
        output().print(f"note: {note}", markup=False)
