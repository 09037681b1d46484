"""The control chart as bytes in every format."""

from __future__ import annotations

from app.context import Context
from app.errors import Failure
from app.statistics import service
from ident.figures import MEDIA, figure, render
from ident.figures.subjects import Charted
from ident.statistics import control_chart as chart_of
from ident.words.symbols import symbol


def control_chart(
    context: Context,
    parameter: str,
    batch: str | None,
    serial: str | None,
    model: str | None,
    kind: str,
    style: tuple[str, float],
) -> tuple[bytes, str]:
    """Individuals and moving ranges. Raises Failure where there are not two sets."""
    if kind not in MEDIA:
        raise Failure(404, "no-such-format", f"no figures as {kind!r}", "figure", f"use {', '.join(MEDIA)}")
    found = service.statistics(context, parameter, batch, serial, model)
    chart = chart_of([point.value for point in found.points])
    if chart is None:
        raise Failure(409, "too-few", "one set makes no chart", "parameter", "approve a second one")
    where = f"serial number {serial}" if serial is not None else f"batch {batch}" if batch else "every batch"
    limits = (found.limits.lower, found.limits.upper) if found.limits else (None, None)
    labels = [point.serial if serial is None else point.created_at[:10] for point in found.points]
    subject = Charted(chart, symbol(parameter, ""), found.unit, where, labels, limits)
    return render(figure("control-chart", subject, *style), kind), MEDIA[kind]
