"""Own effects that a request names, as the definitions that they are: a fit carries what it was made with."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any, TypeVar

from app.context import Context
from app.own_effects import repository
from app.own_effects.own_effect import OwnEffect
from ident.custom.definition import definition_of, is_name
from ident.effects import CATALOGUE, unknown
from ident.errors import Unusable
from ident.words.nearest import did_you_mean
from schemas.diagnosis import DiagnosisRequest
from schemas.fit import Chosen, FitRequest

Asked = TypeVar("Asked", FitRequest, DiagnosisRequest)
_CATALOGUE = frozenset(effect.name for effect in CATALOGUE)


def every(context: Context) -> tuple[OwnEffect, ...]:
    """All own effects of the lab, by name."""
    with context.sessions() as session:
        return tuple(map(repository.kept, repository.every(session)))


def with_kept(context: Context, request: Asked) -> Asked:
    """The request with the definition of each kept effect that stands among its `effects`, or by name in `custom`.

    What it defines itself and the catalogue's come first. Raises Unusable, with the nearest name, for one that is not
    known.
    """
    return request.model_copy(update={"custom": _custom(context, request)})


def _custom(context: Context, request: Chosen) -> list[dict[str, Any] | str]:
    """What a request defines, and what is kept under the names that it gives in addition."""
    custom = list(defined(context, request.custom))
    there = {str(definition_of(definition)["name"]) for definition in custom} | _CATALOGUE
    wanted = [name for name in dict.fromkeys(request.effects) if name not in there]
    found = _named(context, wanted)
    if strange := [name for name in wanted if name not in {entry.name for entry in found}]:
        raise unknown(strange[0], (*there, *(entry.name for entry in every(context))))
    return [*custom, *(dict(entry.definition) for entry in found)]


def defined(context: Context, custom: Iterable[dict[str, Any] | str]) -> Iterable[dict[str, Any] | str]:
    """The definitions; a text that is a name stands for the effect that is kept under it."""
    for definition in custom:
        if not (isinstance(definition, str) and is_name(definition.strip())):
            yield definition
            continue
        name = definition.strip()
        found = _named(context, [name])
        if not found:
            remedy = did_you_mean(name, (entry.name for entry in every(context)), "see /api/v1/own-effects")
            raise Unusable("no-such-effect", f"there is no own effect {name!r}", "custom", remedy)
        yield dict(found[0].definition)


def _named(context: Context, names: Collection[str]) -> list[OwnEffect]:
    if not names:
        return []
    with context.sessions() as session:
        return list(map(repository.kept, repository.named(session, names)))
