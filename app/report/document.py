"""The report as one HTML page without script or network."""

from __future__ import annotations

import re
from base64 import b64encode
from functools import lru_cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup

from app.report.blocks import Figure
from app.report.content import content
from app.report.sheet import NOTHING_STATED, Logo, Sheet
from ident.diagnosis.result import Diagnosis
from ident.figures import render
from ident.fit.result import FitResult
from ident.matrix import Matrix

HERE = Path(__file__).parent
POLICY = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
"""Nothing is loaded, nothing runs."""


def document(matrix: Matrix, fit: FitResult, diagnosis: Diagnosis | None = None, sheet: Sheet = NOTHING_STATED) -> str:
    """The whole page as text. Raises Unusable where the fit is of another model's data."""
    style = Markup((HERE / "templates" / "report.css").read_text(encoding="utf-8"))
    page: str = _template().render(report=content(matrix, fit, diagnosis, sheet), policy=POLICY, style=style)
    return page


def _picture(logo: Logo) -> str:
    """A logo inside the page."""
    return f"data:{logo.media};base64,{b64encode(logo.content).decode()}"


def _inline(figure: Figure) -> Markup | str:
    """A chart as SVG inside the page; its inner names get a prefix, so that no two figures share one."""
    if isinstance(figure.chart, str):
        return figure.chart
    drawn = render(figure.chart, "svg").decode()
    return Markup(re.sub(r'( id="|url\(#|href="#)', rf"\g<1>{figure.name}-", drawn))


@lru_cache
def _template() -> Template:
    loader = FileSystemLoader(HERE / "templates")
    made = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    made.filters["drawn"] = _inline
    made.filters["picture"] = _picture
    return made.get_template("report.html")
