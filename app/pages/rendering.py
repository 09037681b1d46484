"""Templates to responses. They hold no inline script or style: the service's content security policy forbids both."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import Any

from fastapi import Request
from fastapi.responses import HTMLResponse
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from app.pages.manual import is_there
from ident.rig.conditions import CONDITIONS
from ident.words.engineering import printed_unit
from ident.words.error import ErrorOf
from ident.words.percent import percent_in_print
from ident.words.sentence import sentence
from ident.words.severity import level
from ident.words.titles import DATA, title

HERE = Path(__file__).parent
STATIC = HERE / "static"


def _edition() -> str:
    """Changes with any file under static, so that browsers may keep these files."""
    digest = sha256()
    for path in sorted(STATIC.iterdir()):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


EDITION = _edition()


def static(name: str) -> str:
    """The address of a static file."""
    return f"/static/{EDITION}/{name}"


def conditions() -> tuple[tuple[str, str], ...]:
    """The conditions that a form offers: name and title of each."""
    return tuple((name, one.title) for name, one in CONDITIONS.items())


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(HERE / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["percent"] = percent_in_print
    environment.filters["error"] = _error
    environment.filters["in_words"] = title
    environment.filters["sentence"] = sentence
    environment.filters["level"] = level
    environment.filters["unit"] = printed_unit
    environment.filters["use"] = DATA.__getitem__
    known: dict[str, Any] = {"static": static, "conditions": conditions, "has_manual": is_there}
    environment.globals.update(known)
    return environment


def _error(of: ErrorOf | float | None) -> str:
    """An error in words: of a number alone, or with the mean and the runs on which the model is unstable."""
    return (of if isinstance(of, ErrorOf) else ErrorOf(of)).in_print()


_TEMPLATES = _environment()


def page(request: Request, template: str, status: int = 200, **data: Any) -> HTMLResponse:
    """The page of a template, for who asks; who is not known is shown no way on."""
    who = getattr(request.state, "who", None)
    text = _TEMPLATES.get_template(template).render(here=request.url.path, who=who, **data)
    return HTMLResponse(text, status_code=status)


def problem(request: Request, status: int, title: str, what: str, remedy: str) -> HTMLResponse:
    """A page that says what is wrong and what to do."""
    return page(request, "problem.html", status, title=title, what=what, remedy=remedy)
