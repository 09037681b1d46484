"""Statistics of one parameter over the sets of a batch, or of one actuator over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import datetime

from sqlalchemy.orm import Session

from app.context import Context
from app.errors import Failure
from app.limits.repository import EVERY, in_batch
from app.statistics import repository
from app.statistics.repository import ERRORS, Chosen, Point
from ident.presets import PRESETS, parameter_names
from ident.statistics import (
    Capability,
    ControlChart,
    capability,
    control_chart,
    drift,
    outliers,
    outside,
    summary,
    withheld,
)
from ident.words.nearest import nearest
from schemas.statistics import (
    CapabilityView,
    ControlChartView,
    DriftView,
    OutlierView,
    PointView,
    ProductLimitsView,
    SignalView,
    StatisticsView,
)

MOST = 5000  # sets that are taken


def statistics(
    context: Context, parameter: str, batch: str | None, serial: str | None, model: str | None
) -> StatisticsView:
    """Of the sets in force, or of one serial number those that ever were; raises Failure where there are none."""
    with context.sessions() as session:
        points = repository.points(session, parameter, Chosen(batch, serial, model), MOST + 1)
        points, left_out = points[-MOST:], len(points) > MOST
        checked(session, points, parameter, Chosen(batch, serial, model))
        unstable, points = sum(bool(one.unstable) for one in points), [one for one in points if not one.unstable]
        if not points:
            raise Failure(
                409,
                "too-few",
                "the model of every set here is unstable on a run",
                "parameter",
                "approve a fit whose model is stable",
            )
        limit = in_batch(session, points[0].model, batch or EVERY).get(parameter)
    lower, upper = (limit.lower, limit.upper) if limit else (None, None)
    values = [point.value for point in points]
    found, chart = summary(values), control_chart(values)
    return StatisticsView(
        parameter=parameter,
        unit=points[0].unit,
        model=points[0].model,
        n=found.n,
        mean=found.mean,
        deviation=found.deviation,
        minimum=found.minimum,
        maximum=found.maximum,
        percentiles={str(share): value for share, value in found.percentiles.items()},
        control_chart=_chart(chart),
        capability=_capability(capability(values, lower, upper), lower, upper),
        outliers=_outliers(points),
        drift=_drift(points) if serial is not None else None,
        points=_points(points, chart),
        left_out=left_out,
        limits=limits_view(values, lower, upper, unstable),
        no_capability=withheld(values, lower, upper),
        unstable=unstable,
    )


def checked(session: Session, points: Sequence[Point], parameter: str, chosen: Chosen) -> None:
    """Raises Failure where there is nothing, or where values of several models would be mixed."""
    if not points:
        raise _nothing(parameter, chosen, lambda: repository.batches(session))
    models = sorted({point.model for point in points})
    if len(models) > 1:
        raise Failure(409, "several-models", f"the sets are of {', '.join(models)}", "model", "name one of them")


def _nothing(parameter: str, chosen: Chosen, batches: Callable[[], Sequence[str]]) -> Failure:
    """What is said where no set was found, with the nearest name of the first that is not known."""
    asked = (
        ("parameter", parameter, (*parameter_names(), *ERRORS)),
        ("model", chosen.model, PRESETS),
        ("batch", chosen.batch, batches() if chosen.batch else ()),
    )
    for where, name, known in asked:
        if name is not None and name not in known and (near := nearest(name, known)) is not None:
            return Failure(404, "no-sets", f"no approved set has the {where} {name!r}", where, f"did you mean {near}?")
    of = f" of {chosen.serial}" if chosen.serial else f" of batch {chosen.batch}" if chosen.batch else ""
    return Failure(
        404,
        "no-sets",
        f"no approved set{of} has {parameter!r}",
        "parameter",
        "approve a fit, or name another parameter",
    )


def _chart(chart: ControlChart | None) -> ControlChartView | None:
    if chart is None:
        return None
    return ControlChartView(
        centre=chart.centre,
        sigma=chart.sigma,
        lower=chart.lower,
        upper=chart.upper,
        mean_range=chart.mean_range,
        upper_range=chart.upper_range,
        wide_ranges=list(chart.wide_ranges),
        signals=[SignalView(place=one.place, rule=one.rule, text=one.text) for one in chart.signals],
    )


def _capability(found: Capability | None, lower: float | None, upper: float | None) -> CapabilityView | None:
    return None if found is None else CapabilityView(lower=lower, upper=upper, **vars(found))


def limits_view(
    values: Sequence[float], lower: float | None, upper: float | None, unstable: int
) -> ProductLimitsView | None:
    """What lies outside; an error whose model is unstable is above any upper limit."""
    if lower is None and upper is None:
        return None
    above = 0 if upper is None else unstable
    return ProductLimitsView(lower=lower, upper=upper, outside=outside(values, lower, upper) + above)


def _outliers(points: Sequence[Point]) -> list[OutlierView]:
    found = outliers([point.value for point in points])
    return [
        OutlierView(
            fit=points[one.place].fit, serial=points[one.place].serial, value=points[one.place].value, score=one.score
        )
        for one in found
    ]


def _drift(points: Sequence[Point]) -> DriftView | None:
    times = [datetime.fromisoformat(point.created_at).timestamp() for point in points]
    found = drift(times, [point.value for point in points])
    return None if found is None else DriftView(**vars(found), significant=found.significant)


def _points(points: Sequence[Point], chart: ControlChart | None) -> list[PointView]:
    ranges = (None, *chart.moving_ranges) if chart else (None,) * len(points)
    return [
        PointView(
            fit=one.fit,
            serial=one.serial,
            created_at=one.created_at,
            value=one.value,
            std_error=one.std_error,
            moving_range=range_,
        )
        for one, range_ in zip(points, ranges, strict=True)
    ]
