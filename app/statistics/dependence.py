"""One parameter over a condition of the tests, from the stored sets of a batch, an actuator or a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from sqlalchemy.orm import Session

from app.context import Context
from app.limits.repository import EVERY, in_batch
from app.limits.verdict import Judged
from app.statistics import repository
from app.statistics.repository import Chosen, Point
from app.statistics.service import MOST, checked, limits_view
from app.tables import LimitRow
from ident.design.at_condition import condition_called, condition_value
from ident.statistics import ConditionLaw, Level
from ident.statistics.dependence import Dependence
from schemas.statistics import AtView, ConditionLawView, ConditionPointView, DependenceView, LevelView

_DRAWN = 81  # conditions of the band


@dataclass(frozen=True)
class Known:
    """The sets of a parameter that know a condition, their dependence, and how many do not know it."""

    points: Sequence[tuple[Point, float]]
    dependence: Dependence
    without: int
    left_out: bool


def over_condition(
    context: Context,
    parameter: str,
    asked: tuple[str, str | None],
    batch: str | None,
    serial: str | None,
    model: str | None,
) -> tuple[DependenceView, Dependence]:
    """What is sent, and the dependence behind it; `asked` are the condition, and its value where one is wanted.

    Raises Failure where there are no sets, and Unusable for what is asked.
    """
    (over, at), chosen = asked, Chosen(batch, serial, model)
    condition = condition_called(over)
    value = None if at is None else condition_value(over, at)
    with context.sessions() as session:
        found = known(session, parameter, over, chosen)
        first = found.points[0][0] if found.points else None
        limit = in_batch(session, first.model, chosen.batch or EVERY).get(parameter) if first else None
    own, values = found.dependence, found.dependence.values
    ends = (limit.lower, limit.upper) if limit else (None, None)
    view = DependenceView(
        parameter=parameter,
        unit=first.unit if first else "1",
        model=first.model if first else chosen.model or "",
        over=over,
        over_unit=condition.unit,
        n=len(found.points),
        without=found.without,
        left_out=found.left_out,
        points=[_point(*one) for one in found.points],
        laws=[_law(one) for one in own.laws],
        law=own.law.name if own.law else None,
        holds=own.law is not None and own.law.holds,
        text=str(own.text),
        band=_band(own),
        limits=limits_view(values, *ends, 0),
        at=None if value is None else _at(own, value, first, limit),
    )
    return view, own


def known(session: Session, parameter: str, over: str, chosen: Chosen) -> Known:
    """The sets that know the condition. Raises Failure where no set has the parameter, or several models have it."""
    points = repository.points(session, parameter, chosen, MOST + 1)
    points, left_out = points[-MOST:], len(points) > MOST
    checked(session, points, parameter, chosen)
    conditions = repository.conditions(session, over, [point.number for point in points])
    both = [(point, conditions[point.number]) for point in points if point.number in conditions and not point.unstable]
    dependence = Dependence.of(over, [x for _, x in both], [point.value for point, _ in both])
    return Known(both, dependence, len(points) - len(both), left_out)


def judged_at(
    name: str, unit: str, dependence: Dependence, value: float, lower: float | None, upper: float | None
) -> Judged:
    """A parameter at a condition against its limits: as sure as the law is, or not judged with the reason."""
    said, law = dependence.condition.said(value), dependence.law
    silent = dependence.silent(value)
    if law is None or silent is not None:
        return Judged(name, None, None, unit, lower, upper, at=said, why=str(silent or ""))
    level = law.at(value)
    return Judged(name, level.value, level.std_error, unit, lower, upper, sure=law.sure, at=said)


def _at(own: Dependence, value: float, first: Point | None, limit: LimitRow | None) -> AtView:
    level, unit = own.at(value), first.unit if first else "1"
    judged = judged_at("", unit, own, value, limit.lower if limit else None, limit.upper if limit else None)
    said = judged.reason if limit or level is None else ""
    return AtView(
        condition=value,
        level=_level(value, level) if level else None,
        outcome=judged.outcome if limit else None,
        reason=str(own.silent(value) or said).strip(),
    )


def _band(own: Dependence) -> list[LevelView]:
    law = own.law
    if law is None:
        return []
    return [_level(x, law.at(x)) for x in np.linspace(min(own.conditions), max(own.conditions), _DRAWN).tolist()]


def _level(condition: float, level: Level) -> LevelView:
    return LevelView(condition=condition, **level._asdict())


def _law(law: ConditionLaw) -> ConditionLawView:
    return ConditionLawView(
        name=law.name,
        formula=law.form.formula,
        probability=law.probability,
        scatter=law.scatter,
        relative=law.relative,
        lack_of_fit=law.lack_of_fit,
        holds=law.holds,
    )


def _point(point: Point, condition: float) -> ConditionPointView:
    return ConditionPointView(
        fit=point.fit, serial=point.serial, condition=condition, value=point.value, std_error=point.std_error
    )
