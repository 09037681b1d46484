"""What the page shows that draws runs as they were measured, before any fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from urllib.parse import urlencode

from app.errors import Failure, missing
from app.pages.figure_forms import Field
from app.pages.run_view import Conditions, conditions
from ident.figures.signals import MOST
from ident.readers.run import SHORTEST
from schemas.matrix import MatrixView, RunView


@dataclass(frozen=True)
class SignalsView:
    """The runs with those that are drawn; `duration` is that of the longest, `shortest` what can be zoomed to.

    Times are in s, or in samples where the clock is unknown. `alone` is the one run that is drawn, None of several.
    """

    id: str
    serial: str
    removed: str | None
    runs: tuple[tuple[Conditions, bool], ...]
    query: str
    fields: tuple[Field, ...]
    duration: float
    shortest: float
    alone: RunView | None


def signals_view(matrix: MatrixView, wanted: Sequence[str]) -> SignalsView:
    """The page of some runs by id, the first where none is named. Raises Failure 404, and 422 for too many."""
    known = {run.id: run for run in matrix.runs}
    for name in wanted:
        if name not in known:
            raise missing("run", name)
    if len(wanted) > MOST:
        raise Failure(422, "too-many-runs", f"{len(wanted)} runs are chosen", "run", f"choose {MOST} at most")
    drawn = [known[name] for name in dict.fromkeys(wanted)] or matrix.runs[:1]
    clock = "s" if drawn[0].time_unit == "s" else "samples"
    return SignalsView(
        id=matrix.id,
        serial=matrix.serial,
        removed=matrix.removed_at,
        runs=tuple((conditions(run), run in drawn) for run in matrix.runs),
        query=urlencode([("run", run.id) for run in drawn]),
        fields=(Field("start", f"Start ({clock})"), Field("seconds", f"Length ({clock})")),
        duration=max(run.duration for run in drawn),
        shortest=SHORTEST / max(run.sample_rate for run in drawn),
        alone=drawn[0] if len(drawn) == 1 else None,
    )
