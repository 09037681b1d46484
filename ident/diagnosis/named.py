"""The effects that a diagnosis names, in the form that a fit takes; and the settings of a fit with named effects."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from ident.custom.definition import Definition
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Diagnosis
from ident.effects import CATALOGUE, unknown
from ident.fit.added_effects import with_added_effects
from ident.fit.settings import Settings

Kept = Callable[[], Mapping[str, Definition]]
"""Returns the users' effects that are stored, by name."""


@dataclass(frozen=True)
class Named:
    """Effects that are added together, the definitions of users' effects among them, and the estimates of
    parameters."""

    effects: tuple[str, ...] = ()
    custom: tuple[Definition, ...] = ()
    parameters: Mapping[str, ParameterEstimate] = field(default_factory=dict)


def named(diagnosis: Diagnosis, name: str) -> Named | None:
    """The effects that the name of a candidate or of a proposed term adds to the diagnosed fit; None for other names.

    With a term come the terms before it, and the effects in addition to which it was found, without the fit's own.
    """
    terms = diagnosis.proposals or ()
    for count, term in enumerate(terms, 1):
        if term.effect["name"] == name:
            beside = tuple(effect for effect in term.beside if effect not in diagnosis.effects)
            definitions = tuple(dict(one.effect) for one in terms[:count])
            effects = (*beside, *(str(one["name"]) for one in definitions))
            return Named(effects, (*_own(diagnosis, beside), *definitions), term.parameters)
    for candidate in diagnosis.candidates:
        if candidate.effect == name:
            return Named((name,), _own(diagnosis, (name,)), candidate.parameters)
    return None


def of_fit(diagnosis: Diagnosis) -> Named:
    """The effects that the diagnosed fit had."""
    return Named(diagnosis.effects, _own(diagnosis, diagnosis.effects))


def names(diagnosis: Diagnosis) -> Iterator[str]:
    """Every name that :func:`named` takes: the candidates, best first, then the proposed terms."""
    yield from (candidate.effect for candidate in diagnosis.candidates)
    yield from (str(term.effect["name"]) for term in diagnosis.proposals or ())


def with_named(
    settings: Settings,
    wanted: Sequence[str],
    custom: Sequence[Definition] = (),
    diagnosis: Diagnosis | None = None,
    kept: Kept = dict,
) -> Settings:
    """The settings of a fit with effects by name, and with all effects that `custom` defines.

    A name is first sought in the catalogue and the definitions, then in the `diagnosis`, then among the effects
    that are `kept`, which are read only then. Raises Unusable as :func:`ident.fit.added_effects.with_added_effects`.
    """
    known = {effect.name for effect in CATALOGUE} | {str(one["name"]) for one in (*settings.custom, *custom)}
    effects: list[str] = []
    definitions = list(custom)
    for name in wanted:
        one = Named((name,)) if name in known else _looked_up(name, known, diagnosis, kept)
        effects += one.effects
        definitions += [definition for definition in one.custom if definition not in definitions]
    return with_added_effects(settings, effects, definitions)


def _looked_up(name: str, known: set[str], diagnosis: Diagnosis | None, kept: Kept) -> Named:
    """The effects of a name that is neither in the catalogue nor defined. Raises Unusable."""
    if diagnosis is not None and (one := named(diagnosis, name)) is not None:
        return one
    own = kept()
    if name in own:
        return Named((name,), (own[name],))
    raise unknown(name, (*known, *(names(diagnosis) if diagnosis is not None else ()), *own))


def _own(diagnosis: Diagnosis, effects: Sequence[str]) -> tuple[Definition, ...]:
    """The definitions of the users' effects among these, as they were given to the diagnosis."""
    return tuple(definition for definition in diagnosis.settings.get("custom", ()) if definition["name"] in effects)
