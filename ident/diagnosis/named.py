"""What a diagnosis names, as a fit takes it; and the settings of a fit with what was named, by every way of asking."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from ident.custom.definition import Definition
from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.result import Diagnosis
from ident.effects import CATALOGUE, unknown
from ident.fit.extended import extended
from ident.fit.settings import Settings

Kept = Callable[[], Mapping[str, Definition]]
"""Gives the own effects that are kept under names."""


@dataclass(frozen=True)
class Named:
    """Effects that are added together, the definitions of own ones among them, and what was found of the parameters."""

    effects: tuple[str, ...] = ()
    custom: tuple[Definition, ...] = ()
    parameters: Mapping[str, ParameterEstimate] = field(default_factory=dict)


def named(found: Diagnosis, name: str) -> Named | None:
    """What is added to the diagnosed fit by the name of a candidate or of a proposed term; None of any other name.

    With a term there are those before it and the effects in addition to which it was found, but for those of the fit.
    """
    terms = found.proposals or ()
    for count, term in enumerate(terms, 1):
        if term.effect["name"] == name:
            beside = tuple(effect for effect in term.beside if effect not in found.effects)
            definitions = tuple(dict(one.effect) for one in terms[:count])
            effects = (*beside, *(str(one["name"]) for one in definitions))
            return Named(effects, (*_own(found, beside), *definitions), term.parameters)
    for candidate in found.candidates:
        if candidate.effect == name:
            return Named((name,), _own(found, (name,)), candidate.parameters)
    return None


def of_fit(found: Diagnosis) -> Named:
    """The effects that the diagnosed fit had."""
    return Named(found.effects, _own(found, found.effects))


def names(found: Diagnosis) -> Iterator[str]:
    """Every name by which something is added: of the candidates, best first, then of the proposed terms."""
    yield from (candidate.effect for candidate in found.candidates)
    yield from (str(term.effect["name"]) for term in found.proposals or ())


def with_named(
    settings: Settings, wanted: Sequence[str], custom: Sequence[Definition] = (), found: Diagnosis | None = None,
    kept: Kept = dict,
) -> Settings:  # fmt: skip
    """The settings of a fit with effects by name, and with all that `custom` defines.

    A name is one of the catalogue or of a definition, else one that the diagnosis `found` gives, else one of an effect
    that is `kept`, which is asked only then. Raises Unusable as :func:`ident.fit.extended.extended`.
    """
    known = {effect.name for effect in CATALOGUE} | {str(one["name"]) for one in (*settings.custom, *custom)}
    effects: list[str] = []
    definitions = list(custom)
    for name in wanted:
        one = Named((name,)) if name in known else _looked_up(name, known, found, kept)
        effects += one.effects
        definitions += [definition for definition in one.custom if definition not in definitions]
    return extended(settings, effects, definitions)


def _looked_up(name: str, known: set[str], found: Diagnosis | None, kept: Kept) -> Named:
    """What a name stands for that is neither of the catalogue nor of a definition. Raises Unusable."""
    if found is not None and (one := named(found, name)) is not None:
        return one
    own = kept()
    if name in own:
        return Named((name,), (own[name],))
    raise unknown(name, (*known, *(names(found) if found is not None else ()), *own))


def _own(found: Diagnosis, effects: Sequence[str]) -> tuple[Definition, ...]:
    """The definitions of the own effects among these, as the diagnosis was given them."""
    return tuple(definition for definition in found.settings.get("custom", ()) if definition["name"] in effects)
