"""The report: data, error, parameters, figures and diagnosis of one fit as one HTML page without script or network."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup

from app.pages import numbers
from app.pages.fit_view import combination_rows, error_rows, parameter_rows
from app.report.diagnosis import Diagnosis
from app.report.rows import budget_rows, candidate_rows, curve_rows, group_tables, trend_rows
from ident.check import check
from ident.compare import compare
from ident.errors import Unusable
from ident.figures import figure, ladder, look, render
from ident.figures.render import Chart
from ident.fit.result import FitResult
from ident.matrix import Matrix
from ident.presets import preset
from ident.residuals.survey import survey

FIGURES = {
    "bode": "Frequency response, measured and model",
    "residual-map": "Where the error is: runs over frequency",
    "residual-curve": "What the model lacks, against its own signals",
    "time": "A stretch of one run",
}
HERE = Path(__file__).parent
POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
"""Nothing is loaded, nothing runs."""


def document(matrix: Matrix, fit: FitResult, diagnosis: Diagnosis | None = None) -> str:
    """The whole page as text. Raises Unusable where the fit is of another model's data."""
    compared = compare(matrix, fit)
    found = survey(compared)
    model = preset(fit.model, fit.effects)
    steps = diagnosis.steps if diagnosis else []
    chart = ladder(steps, diagnosis.floor, matrix.actuator, look("light")) if diagnosis and steps else None
    page: str = _template().render(
        policy=POLICY,
        style=Markup((HERE / "templates" / "report.css").read_text(encoding="utf-8")),
        serial=matrix.actuator.serial,
        title=" + ".join((model.title, *(name.replace("_", " ") for name in fit.effects))),
        citation=model.citation,
        matrix=matrix,
        fit=fit,
        findings=check(matrix),
        errors=error_rows(fit),
        parameters=parameter_rows(fit),
        combinations=combination_rows(fit),
        budget=budget_rows(found.budget),
        budget_notes=found.budget.notes if found.budget else (),
        groups=group_tables(found.where),
        curves=curve_rows(found.curves),
        trends=trend_rows(found.trends),
        figures={name: _drawn(name, matrix, fit) for name in FIGURES},
        captions=FIGURES,
        diagnosis=diagnosis,
        candidates=candidate_rows(diagnosis) if diagnosis else (),
        ladder=_inline(chart, "ladder") if chart else "",
        seconds=numbers.quantity(fit.seconds, "s"),
    )
    return page


def _drawn(name: str, matrix: Matrix, fit: FitResult) -> Markup | str:
    """A figure; where the model or the data do not allow it, what that is."""
    try:
        return _inline(figure(name, matrix, fit), name)
    except Unusable as error:
        return str(error)


def _inline(chart: Chart, name: str) -> Markup:
    """A chart as SVG inside the page; its inner names get a prefix, so that no two figures share one."""
    drawn = render(chart, "svg").decode()
    return Markup(re.sub(r'( id="|url\(#|href="#)', rf"\g<1>{name}-", drawn))


@lru_cache
def _template() -> Template:
    loader = FileSystemLoader(HERE / "templates")
    made = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    made.filters["percent"] = numbers.percent
    return made.get_template("report.html")
