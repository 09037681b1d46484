"""The parameters of an actuator at a condition, against their limits."""

from __future__ import annotations

import math
from collections.abc import Mapping

from sqlalchemy.orm import Session

from app.limits.bounds_in_force import Bound
from app.limits.verdict import Judged
from app.parameters.error import NAMES
from app.statistics.dependence import judged_at, known
from app.statistics.repository import Chosen
from app.tables import SetRow, ValueRow
from ident.rig.conditions import PREFIX
from ident.statistics.dependence import Dependence


def at_condition(
    session: Session, row: SetRow, limits: Mapping[str, Bound], over: str, value: float
) -> dict[str, Judged]:
    """Each parameter of a set that has a limit, at a condition; an error of the fit has no law and is left out."""
    values = {one.name: one for one in row.values}
    return {
        name: _judged(session, row, values, limit, over, value)
        for name, limit in limits.items()
        if name in values and name not in NAMES
    }


def _judged(
    session: Session, row: SetRow, values: Mapping[str, ValueRow], limit: Bound, over: str, value: float
) -> Judged:
    """By the law of the actuator's own sets where it has one, else its own value moved by the law of its batch."""
    name, unit = limit.name, values[limit.name].unit
    own = known(session, name, over, Chosen(None, row.serial, row.model)).dependence
    if own.law is not None:
        return judged_at(name, unit, own, value, limit.lower, limit.upper)
    others = known(session, name, over, Chosen(row.batch or None, None, row.model)).dependence
    here = values.get(PREFIX + over)
    if others.law is None or here is None:
        return judged_at(name, unit, own, value, limit.lower, limit.upper)
    return _moved(values[name], here.value, others, value, limit)


def _moved(known: ValueRow, here: float, of_batch: Dependence, value: float, limit: Bound) -> Judged:
    """The value of the set in force, moved by the law of other sets: its error and that of the law are independent."""
    said, law = of_batch.condition.said(value), of_batch.law
    silent = of_batch.silent(value) or of_batch.silent(here)
    if law is None or silent is not None:
        return Judged(known.name, None, None, known.unit, limit.lower, limit.upper, at=said, why=str(silent or ""))
    change = law.change(here, value)
    moved = change.factor * known.value + change.shift
    error = None
    if known.std_error is not None:
        error = math.hypot(change.factor * known.std_error, change.std_error * (abs(moved) if law.relative else 1.0))
    return Judged(known.name, moved, error, known.unit, limit.lower, limit.upper, sure=law.sure, at=said)
