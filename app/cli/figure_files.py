"""Figures as files: every figure of a result in every format, in a folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from app.cli.output import write_bytes

FORMATS = ("svg", "png", "pdf", "json")


def write_figures(subject: object, out: Path) -> None:
    """Write the figures that there are of a subject, and say which."""
    from ident.figures import drawings

    names = tuple(drawings(subject))
    for name in names:
        write_figure(subject, name, out)
    print(f"wrote {', '.join(names)} to {out}")


def write_figure(subject: object, name: str, out: Path, stem: str = "", **options: Any) -> None:
    """Write one figure to `out`, as files of its name, or of that in `stem`."""
    from ident.figures import figure, render

    out.mkdir(parents=True, exist_ok=True)
    chart = figure(name, subject, **options)
    for format_ in FORMATS:
        write_bytes(render(chart, format_), out / f"{stem or name}.{format_}")
