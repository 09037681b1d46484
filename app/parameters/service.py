"""Parameter sets as pages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pydantic_core import to_json

from app.context import Context
from app.errors import Failure
from app.paging import cursor, keys_of
from app.parameters import export, repository
from app.parameters.set_query import SetQuery, wanted
from app.tables import SetRow
from schemas.parameters import ParameterSetPage, ParameterSetView

__all__ = ["SetQuery", "export", "page", "page_as_json", "wanted"]


def page(context: Context, wanted: SetQuery, after: str | None, limit: int) -> ParameterSetPage:
    """A page of parameter sets."""
    return ParameterSetPage(**_page(context, wanted, after, limit))


def page_as_json(context: Context, wanted: SetQuery, after: str | None, limit: int) -> bytes:
    """The same as it is sent: a line asks all day, and to check each value of what is stored takes half the time."""
    return to_json(_page(context, wanted, after, limit), inf_nan_mode="null")


def _page(context: Context, wanted: SetQuery, after: str | None, limit: int) -> dict[str, Any]:
    before = _number(after)
    with context.sessions() as session:
        rows = repository.sets(session, wanted, before, limit)
    following = cursor(str(rows[-1].number)) if len(rows) == limit else None
    return {"items": [_plain(row) for row in rows], "next": following}


def _number(after: str | None) -> int | None:
    keys = keys_of(after, 1)
    if keys is None:
        return None
    if not keys[0].isascii() or not keys[0].isdecimal() or len(keys[0]) > 18:
        raise Failure(422, "bad-cursor", "the cursor is not one that a page gave", "cursor", "start without a cursor")
    return int(keys[0])


def newest(context: Context, serials: Sequence[str]) -> dict[str, ParameterSetView]:
    """The newest parameter set of each of these actuators that has one."""
    with context.sessions() as session:
        return {row.serial: view(row) for row in repository.newest(session, serials)}


def approved(context: Context, serials: Sequence[str]) -> dict[str, list[ParameterSetView]]:
    """The approved sets of each of these actuators that has some, oldest first."""
    found: dict[str, list[ParameterSetView]] = {}
    with context.sessions() as session:
        for row in repository.approved(session, serials):
            found.setdefault(row.serial, []).append(view(row))
    return found


def view(row: SetRow | repository.FoundSet) -> ParameterSetView:
    """A set as it is sent."""
    if isinstance(row, SetRow):
        values = [(v.number, v.name, v.value, v.unit, v.std_error) for v in row.values]
        own = [getattr(row, name) for name in repository.COLUMNS]
        row = repository.FoundSet._make([*own, values, row.approved_at, row.current])
    return ParameterSetView(**_plain(row))


def _plain(row: repository.FoundSet) -> dict[str, Any]:
    return {
        "id": row.fit,
        "serial": row.serial,
        "batch": row.batch,
        "model": row.model,
        "created_at": row.created_at,
        "approved_at": row.approved_at,
        "current": row.current,
        "error_fit": row.error_fit,
        "error_verify": row.error_verify,
        "error_with_mean_fit": row.error_with_mean_fit,
        "error_with_mean_verify": row.error_with_mean_verify,
        "unstable_fit": row.unstable_fit,
        "unstable_verify": row.unstable_verify,
        "parameters": {
            name: {"value": value, "unit": unit, "std_error": error} for _, name, value, unit, error in row.values
        },
        "lineage": {
            "data_hash": row.data_hash,
            "effects": row.effects,
            "seed": row.seed,
            "version": row.version,
            "equations": row.equations,
            "who": row.who,
        },
    }
