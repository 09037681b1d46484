"""The rule: raw runs of sets that were superseded or never approved need not be kept for longer than so many days.

What was found from them stays. Nothing is removed that was not shown before: whoever confirms says the digest of it.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import timedelta
from typing import Any

from sqlalchemy.orm import Session

from app.context import Context
from app.errors import Failure
from app.matrices.levels import KEY
from app.retention import repository
from app.tables import MatrixRow, before, now
from schemas.retention import RawView, RetentionView

_FRESH = 3600.0  # s for which a blob that was stored lately stays: an upload of the same may not be recorded yet


@dataclass(frozen=True)
class Goer:
    """A matrix whose raw runs go, whether one of its sets was ever in force, and the blobs that go with it."""

    row: MatrixRow
    approved: bool
    blobs: tuple[str, ...]


def shown(context: Context) -> RetentionView:
    """What the rule would remove now."""
    sizes = _sizes(context)
    with context.sessions() as session:
        return _view(context, _goers(context, session), sizes)


def carry_out(context: Context, digest: str) -> RetentionView:
    """Remove what was shown with this digest. Raises Failure 409 where it would be something else by now."""
    sizes = _sizes(context)
    with context.sessions.begin() as session:
        goers = _goers(context, session, held=True)
        view = _view(context, goers, sizes)
        if view.days is None:
            raise Failure(
                409, "no-rule", "the service has no rule for raw runs", "retention", "start it with --keep-raw DAYS"
            )
        if view.digest != digest:
            raise Failure(
                409,
                "not-as-shown",
                "the list of runs to delete has changed since it was shown",
                "digest",
                "show the list again, and confirm the new digest",
            )
        for goer in goers:
            goer.row.removed_at, goer.row.source = now(), {}
    remove_unnamed(context, {blob for goer in goers for blob in goer.blobs})
    return view


def _goers(context: Context, session: Session, held: bool = False) -> list[Goer]:
    days = context.settings.keep_raw
    if days is None:
        return []
    found = repository.superfluous(session, before(timedelta(days=days)), held)
    needed = set(_in_use(session, [row.id for row, _ in found]))
    goers: list[Goer] = []
    for row, approved in found:
        own = tuple(sorted(set(_blobs(row.source)) - needed))
        needed.update(own)  # of two that share a blob the first one takes it along
        goers.append(Goer(row, approved, own))
    return goers


def _in_use(session: Session, but: Iterable[str] = ()) -> Iterator[str]:
    """Every blob that a record needs, but for those of these matrices."""
    for source in repository.sources(session, but):
        yield from _blobs(source)
    yield from repository.histories(session)


def _blobs(source: Mapping[str, Any]) -> Iterator[str]:
    """The blobs that the source of a matrix names."""
    yield from source.get("files", {}).values()
    yield from (source[name] for name in ("zip", "description", KEY) if name in source)


def _sizes(context: Context) -> dict[str, int]:
    return {blob.sha256: blob.size for blob in context.storage.blobs()} if context.settings.keep_raw is not None else {}


def _view(context: Context, goers: Sequence[Goer], sizes: Mapping[str, int]) -> RetentionView:
    items = [
        RawView(
            matrix=goer.row.id,
            serial=goer.row.serial,
            created_at=goer.row.created_at,
            why="superseded" if goer.approved else "never approved",
            bytes=sum(sizes.get(b, 0) for b in goer.blobs),
        )
        for goer in goers
    ]
    told = json.dumps([[goer.row.id, goer.blobs] for goer in goers])
    return RetentionView(
        days=context.settings.keep_raw,
        items=items,
        bytes=sum(item.bytes for item in items),
        digest=hashlib.sha256(told.encode()).hexdigest(),
    )


def remove_unnamed(context: Context, blobs: set[str]) -> None:
    """Remove blobs that no record names: what stays behind, by a kill say, `servoident tidy` removes."""
    with context.sessions() as session:
        free = blobs - set(_in_use(session))
    for blob in list(context.storage.blobs()) if free else []:
        if blob.sha256 in free and time.time() - blob.changed >= _FRESH:
            context.storage.remove(blob.sha256)
