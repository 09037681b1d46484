"""Own effects that a request names, as the definitions that they are: a fit carries what it was made with."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any, TypeVar

from app.context import Context
from app.own_effects import repository
from app.own_effects.kept import Kept
from ident.custom.definition import definition_of, is_name
from ident.effects import CATALOGUE
from ident.errors import Unusable
from schemas.diagnosis import DiagnosisRequest
from schemas.fit import Chosen, EffectsRequest, FitRequest

Asked = TypeVar("Asked", FitRequest, DiagnosisRequest, EffectsRequest)
_CATALOGUE = frozenset(effect.name for effect in CATALOGUE)


def every(context: Context) -> tuple[Kept, ...]:
    """All own effects of the lab, by name."""
    with context.sessions() as session:
        return tuple(map(repository.kept, repository.every(session)))


def with_kept(context: Context, request: Asked, known: Collection[str] = ()) -> Asked:
    """The request with the definition of each kept effect that stands among its `effects`, or by name in `custom`.

    What it defines itself, what is `known` and the catalogue's come first. Raises Unusable for a name in `custom` that
    is not kept.
    """
    return request.model_copy(update={"custom": _custom(context, request, known)})


def _custom(context: Context, request: Chosen | EffectsRequest, known: Collection[str]) -> list[dict[str, Any] | str]:
    """What a request defines, and what is kept under the names that it gives beside."""
    custom = list(_defined(context, request.custom))
    there = {str(definition_of(definition)["name"]) for definition in custom} | _CATALOGUE | set(known)
    single = [request.effect] if isinstance(request, EffectsRequest) and request.effect is not None else []
    wanted = [name for name in dict.fromkeys((*single, *request.effects)) if name not in there]
    return [*custom, *(dict(entry.definition) for entry in _named(context, wanted))]


def _defined(context: Context, custom: Iterable[dict[str, Any] | str]) -> Iterable[dict[str, Any] | str]:
    """The definitions; a text that is a name stands for the effect that is kept under it."""
    for definition in custom:
        if not (isinstance(definition, str) and is_name(definition.strip())):
            yield definition
            continue
        name = definition.strip()
        found = _named(context, [name])
        if not found:
            raise Unusable("no-such-effect", f"there is no own effect {name!r}", "custom", "see /api/v1/own-effects")
        yield dict(found[0].definition)


def _named(context: Context, names: Collection[str]) -> list[Kept]:
    if not names:
        return []
    with context.sessions() as session:
        return list(map(repository.kept, repository.named(session, names)))
