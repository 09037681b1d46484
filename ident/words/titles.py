"""Names of the program as a reader reads them."""

from __future__ import annotations

from collections.abc import Iterable

_PERSONS = {"coulomb": "Coulomb", "stribeck": "Stribeck"}
"""Words of a name that are names of persons."""


def title(name: str) -> str:
    """The name of an effect, a channel or a use of runs in words: dead_zone → dead zone, Coulomb with a capital."""
    return " ".join(_PERSONS.get(word, word) for word in name.split("_"))


def with_effects(model: str, effects: Iterable[str]) -> str:
    """A model's title and what was added to it: "Qian 2014 + dead zone"."""
    return " + ".join((model, *map(title, effects)))


def of_parameter(name: str, meaning: str) -> str:
    """What a parameter means, with its effect in front: dead_zone.half_width → "dead zone: half the width"."""
    effect, dot, _ = name.partition(".")
    return f"{title(effect)}: {meaning}" if dot else meaning
