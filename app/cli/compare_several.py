"""`servoident compare` with several fits: tables and figures of them all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from app.cli.figure_files import draw_study, study_figures, write_figures
from app.cli.output import STANDARD_OUTPUT, write_json

if TYPE_CHECKING:
    from ident.fit.result import FitResult
    from ident.matrix import Matrix

NAME = "side-by-side"


def compare_several(
    matrix: Matrix,
    fits: Sequence[FitResult],
    json: Path | None,
    out: Path | None,
    figures: Sequence[str] = (),
    options: Mapping[str, Any] = MappingProxyType({}),
) -> None:
    """Each fit against every run of the matrix, whatever it was fitted to; all of them in the `figures` asked for."""
    from app.cli.tables import show
    from ident.comparison.side_by_side import of_comparisons
    from ident.workflows import compare

    asked = None if out is None else study_figures(matrix, fits[0], figures, options, fits[1:])
    found = of_comparisons([compare(matrix, fit) for fit in fits])
    if json is not None:
        columns = [
            {
                "name": one.name,
                "serial": one.serial,
                "model": one.fit.model,
                "effects": list(one.fit.effects),
                "error": dict(one.error),
                "error_with_mean": {use: of.with_mean for use, of in one.words.items()},
                "aic": one.fit.aic,
                "parameters": one.fit.records(),
            }
            for one in found.columns
        ]
        write_json({"fits": columns, "runs": found.records()}, json)
    if json != STANDARD_OUTPUT:
        show(found.listings())
    if out is not None and asked is not None:
        from ident.figures.subjects import Compared

        write_figures(Compared(found, matrix.actuator), out)
        draw_study(*asked, out)
