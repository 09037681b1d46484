"""Figures of what was measured, before any fit."""

from __future__ import annotations

from typing import Any

from app.context import Context
from app.figures.figure_cache import drawn as drawn_of
from app.matrices import service
from ident.figures.subjects import Recorded
from ident.matrix import Actuator


def drawn(context: Context, matrix: str, name: str, kind: str, options: dict[str, Any]) -> tuple[bytes, str]:
    """A figure of a matrix as bytes and their media type."""

    def recorded(_: dict[str, Any]) -> Recorded:
        runs, levels = service.drawn_from(context, matrix)
        return Recorded(runs, Actuator(row.serial), levels)

    row = service.find(context, matrix)
    return drawn_of(context, f"matrix {matrix}", name, kind, options, recorded)
