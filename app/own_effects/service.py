"""A lab's own catalogue: list, look, keep, drop."""

from __future__ import annotations

from sqlalchemy.exc import IntegrityError

from app.access.audited_changes import about
from app.context import Context
from app.errors import Failure, missing
from app.own_effects import repository
from app.own_effects.naming import every
from app.own_effects.own_effect import OwnEffect, proposed, view, written_down
from app.paging import cursor, keys_of
from ident.presets import preset
from schemas.catalogue import OwnEffectPage, OwnEffectRequest, OwnEffectView

__all__ = ["drop", "every", "get", "keep", "kept_as", "listed"]


def listed(context: Context, model: str | None, after: str | None, limit: int) -> OwnEffectPage:
    """A page of own effects; of those that a model can take a page may hold fewer than its limit."""
    if model is not None:
        preset(model)
    keys = keys_of(after, 1)
    with context.sessions() as session:
        rows = repository.page(session, keys[0] if keys else None, limit)
    entries = [entry for entry in map(repository.kept, rows) if model is None or entry.suits(model)]
    following = cursor(rows[-1].name) if len(rows) == limit else None
    return OwnEffectPage(items=[view(entry) for entry in entries], next=following)


def get(context: Context, name: str) -> OwnEffectView:
    """An own effect by name; raises Failure 404."""
    return view(_find(context, name))


def kept_as(context: Context, effect_id: str) -> OwnEffectView | None:
    """The own effect that was kept under this id."""
    with context.sessions() as session:
        row = repository.known(session, effect_id)
    return None if row is None else view(repository.kept(row))


def keep(context: Context, request: OwnEffectRequest, effect_id: str) -> tuple[OwnEffectView, bool]:
    """Keep an effect under a name; and whether it is new. Raises Unusable, and Failure 404, 409."""
    wanted = _wanted(context, request)
    about(f"own-effects/{wanted.name}")
    try:
        with context.sessions() as session:
            if repository.find(session, wanted.name) is None:
                repository.add(session, effect_id, wanted)
                session.commit()
    except IntegrityError:  # by a request that was quicker
        pass
    there = _find(context, wanted.name)
    if there.definition != wanted.definition:
        raise Failure(
            409,
            "name-in-use",
            f"another effect is saved as {wanted.name}",
            "name",
            "give it another name, or DELETE the one there first",
        )
    with context.sessions() as session:
        return view(there), repository.known(session, effect_id) is not None


def _wanted(context: Context, request: OwnEffectRequest) -> OwnEffect:
    """What is to be kept: a definition, or a term of a diagnosis."""
    if (request.definition is None) == (request.diagnosis is None):
        raise Failure(
            422,
            "bad-request",
            "neither a definition nor a diagnosis is given, or both",
            "definition",
            "give one of them",
        )
    if request.definition is not None:
        return written_down(request.definition, request.name, request.meaning, request.model or "")
    assert request.diagnosis is not None
    with context.sessions() as session:
        found = repository.diagnosis(session, request.diagnosis)
    if found is None:
        raise missing("diagnosis", request.diagnosis)
    return proposed(found, request.proposal, request.name, request.meaning, request.diagnosis)


def drop(context: Context, name: str) -> None:
    """Remove an own effect; fits carry theirs. Raises Failure 404."""
    with context.sessions.begin() as session:
        row = repository.find(session, name)
        if row is None:
            raise missing("own-effect", name, (kept.name for kept in every(context)))
        repository.drop(session, row)


def _find(context: Context, name: str) -> OwnEffect:
    with context.sessions() as session:
        row = repository.find(session, name)
    if row is None:
        raise missing("own-effect", name, (kept.name for kept in every(context)))
    return repository.kept(row)
