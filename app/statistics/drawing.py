"""The charts of the statistics as bytes in every format."""

from __future__ import annotations

from app.context import Context
from app.errors import Failure
from app.statistics import service
from app.statistics.dependence import over_condition
from ident.figures import MEDIA, figure, render
from ident.figures.subjects import Charted, OverCondition
from ident.statistics import control_chart as chart_of
from ident.words.error import ERROR
from ident.words.titles import symbol

Style = tuple[str, float]


def control_chart(
    context: Context, parameter: str, batch: str | None, serial: str | None, model: str | None, kind: str, style: Style
) -> tuple[bytes, str]:
    """Individuals and moving ranges. Raises Failure where there are not two sets."""
    _check(kind)
    found = service.statistics(context, parameter, batch, serial, model)
    chart = chart_of([point.value for point in found.points])
    if chart is None:
        raise Failure(409, "too-few", "one set makes no chart", "parameter", "approve a second one")
    limits = (found.limits.lower, found.limits.upper) if found.limits else (None, None)
    labels = [point.serial if serial is None else point.created_at[:10] for point in found.points]
    subject = Charted(chart, symbol(parameter, ""), _unit(parameter, found.unit), _where(batch, serial), labels, limits)
    return render(figure("control-chart", subject, *style), kind), MEDIA[kind]


def dependence(
    context: Context,
    parameter: str,
    over: str,
    batch: str | None,
    serial: str | None,
    model: str | None,
    kind: str,
    style: Style,
) -> tuple[bytes, str]:
    """A parameter over a condition. Raises Failure where no set knows the condition."""
    _check(kind)
    found, own = over_condition(context, parameter, (over, None), batch, serial, model)
    if not found.points:
        raise Failure(409, "too-few", found.text.rstrip("."), "over", "state it in the block test of matrix.yaml")
    limits = (found.limits.lower, found.limits.upper) if found.limits else (None, None)
    labels = [point.serial for point in found.points]
    subject = OverCondition(
        own, symbol(parameter, ""), _unit(parameter, found.unit), _where(batch, serial), labels, limits
    )
    return render(figure("dependence", subject, *style), kind), MEDIA[kind]


def _unit(parameter: str, unit: str) -> str:
    """The unit in which a figure shows the parameter; errors, which are stored as fractions, are in per cent."""
    return "%" if parameter.startswith(ERROR) else unit


def _check(kind: str) -> None:
    """Raise Failure for a format that there is not."""
    if kind not in MEDIA:
        raise Failure(404, "no-such-format", f"no figures as {kind!r}", "figure", f"use {', '.join(MEDIA)}")


def _where(batch: str | None, serial: str | None) -> str:
    return f"serial number {serial}" if serial is not None else f"batch {batch}" if batch else "every batch"
