"""The report as one HTML page without script or network."""

from __future__ import annotations

import re
from base64 import b64encode
from functools import lru_cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined, Template
from markupsafe import Markup, escape

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
    """A chart as SVG inside the page, one picture with its caption as its name.

    Its inner names get a prefix, so that no two figures share one. Its marks have no names of their own to be read out.
    """
    if isinstance(figure.chart, str):
        return figure.chart
    drawn = render(figure.chart, "svg").decode()
    named = re.sub(r'( id="|url\(#|href="#)', rf"\g<1>{figure.name}-", drawn)
    silent = re.sub(r"<[^>]*>", lambda tag: re.sub(r' (?:role|aria-[a-z]+)="[^"]*"', "", tag[0]), named)
    return Markup(silent.replace("<svg", f'<svg role="img" aria-label="{escape(figure.caption)}"', 1))


@lru_cache
def _template() -> Template:
    loader = FileSystemLoader(HERE / "templates")
    made = Environment(loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    made.filters["drawn"] = _inline
    made.filters["picture"] = _picture
    return made.get_template("report.html")
