"""A matrix whose raw runs were removed by the rule: results from them are kept."""

from __future__ import annotations

from app.errors import Removed
from app.tables import MatrixRow


def check_there(row: MatrixRow) -> None:
    """Raise Removed where the raw runs of a matrix are gone."""
    if row.removed_at is not None:
        raise Removed(
            "removed-by-rule",
            f"its raw runs were removed by the rule on {row.removed_at[:10]}; results from them are kept",
            f"matrix {row.id}",
            "upload them again to work on them",
        )
