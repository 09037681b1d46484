"""Parameter sets as pages, CSV and Parquet."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from app.context import Context
from app.errors import Failure
from app.paging import cursor, keys_of
from app.parameters import repository
from app.parameters.repository import Wanted
from app.tables import ActuatorRow, FitRow
from schemas.parameters import ParameterSetPage, ParameterSetView, ValueView

_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # a spreadsheet would run a text cell that begins so
_MOST = 100_000  # rows of an export


def wanted(
    query: Mapping[str, str], *, approved_after: str | None, approved_before: str | None, **filters: Any
) -> Wanted:
    """What a request asks for; raises Failure where a time or a range cannot be read."""
    lowest, highest = _ranges(query)
    after, before = _moment(approved_after, "approved_after"), _moment(approved_before, "approved_before")
    return Wanted(approved_after=after, approved_before=before, lowest=lowest, highest=highest, **filters)


def _ranges(query: Mapping[str, str]) -> tuple[dict[str, float], dict[str, float]]:
    """NAME.min and NAME.max of a query string, in SI."""
    found: dict[str, dict[str, float]] = {"min": {}, "max": {}}
    for key, text in query.items():
        name, _, end = key.rpartition(".")
        if name and end in found:
            try:
                value = float(text)
            except ValueError:
                value = math.nan
            if not math.isfinite(value):
                raise Failure(422, "bad-range", f"{text[:40]!r} is not a number", key, "give a number in SI")
            found[end][name] = value
    return found["min"], found["max"]


def _moment(text: str | None, where: str) -> str | None:
    """A time of a query as the database stores times; a bare date is its midnight, UTC."""
    if text is None:
        return None
    try:
        time = datetime.fromisoformat(text)
        time = time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)
    except (ValueError, OverflowError):
        raise Failure(
            422, "bad-time", f"{text[:40]!r} is not a time", where, "write 2026-11-21 or 2026-11-21T08:00Z"
        ) from None
    return time.isoformat(timespec="microseconds")


def page(context: Context, wanted: Wanted, after: str | None, limit: int) -> ParameterSetPage:
    """A page of parameter sets."""
    with context.sessions() as session:
        rows = repository.sets(session, wanted, keys_of(after, 2), limit)
        items = [view(fit, actuator) for fit, actuator in rows]
    following = cursor(items[-1].created_at, items[-1].id) if len(items) == limit else None
    return ParameterSetPage(items=items, next=following)


def newest(context: Context, serials: Sequence[str]) -> dict[str, ParameterSetView]:
    """The newest parameter set of each of these actuators that has one."""
    with context.sessions() as session:
        return {fit.serial: view(fit, actuator) for fit, actuator in repository.newest(session, serials)}


def approved(context: Context, serials: Sequence[str]) -> dict[str, list[ParameterSetView]]:
    """The approved sets of each of these actuators that has some, oldest first."""
    found: dict[str, list[ParameterSetView]] = {}
    with context.sessions() as session:
        for fit, actuator in repository.approved(session, serials):
            found.setdefault(fit.serial, []).append(view(fit, actuator))
    return found


def csv_text(context: Context, wanted: Wanted) -> str:
    """All sets as CSV, a parameter a column with its unit in the header; text cells never begin a formula."""
    rows, names = _table(context, wanted)
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow([_cell(name) for name in names])
    writer.writerows([[_cell(row.get(name)) for name in names] for row in rows])
    return out.getvalue()


def parquet(context: Context, wanted: Wanted) -> bytes:
    """All sets as Parquet."""
    import pyarrow as pa  # noqa: PLC0415  slow to import, and seldom wanted
    import pyarrow.parquet as pq  # noqa: PLC0415

    rows, names = _table(context, wanted)
    sink = io.BytesIO()
    pq.write_table(pa.table({name: [row.get(name) for row in rows] for name in names}), sink)
    return sink.getvalue()


def _table(context: Context, wanted: Wanted) -> tuple[list[dict[str, Any]], list[str]]:
    sets = page(context, wanted, None, _MOST).items
    plain = ["id", "serial", "batch", "model", "created_at", "approved_at", "current", "error_fit", "error_verify"]
    rows, names = [], list(plain)
    for entry in sets:
        row: dict[str, Any] = {name: getattr(entry, name) for name in plain}
        for name, value in entry.parameters.items():
            title = f"{name} ({value.unit})"
            row[title], row[f"std_error {title}"] = value.value, value.std_error
            names += [column for column in (title, f"std_error {title}") if column not in names]
        rows.append(row)
    return rows, names


def _cell(value: Any) -> Any:
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


def view(fit: FitRow, actuator: ActuatorRow) -> ParameterSetView:
    """A set as it is sent."""
    return ParameterSetView(
        id=fit.id, serial=fit.serial, batch=actuator.batch, model=fit.model, created_at=fit.created_at,
        approved_at=fit.approved_at, current=fit.current, error_fit=fit.error_fit, error_verify=fit.error_verify,
        parameters={v.name: ValueView(value=v.value, unit=v.unit, std_error=v.std_error) for v in fit.values},
    )  # fmt: skip
