"""Names of the program as a reader reads them: effects, parameters, and what runs are used for.

Files and JSON keep the names `fit`, `held_out` and `verify` of a use.
"""

from __future__ import annotations

from collections.abc import Iterable

from ident.words.engineering import printed_unit

_PERSONS = {"coulomb": "Coulomb", "stribeck": "Stribeck"}
"""Words of a name that are names of persons."""
DATA = {"fit": "estimation", "held_out": "held-out", "verify": "validation"}
"""The parameters are estimated on the first. The last are used neither by a fit nor by a ranking (Ljung 1999, 16.5)."""


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


def symbol(name: str, of: str) -> str:
    """The symbol of a parameter, with the divisor of a ratio such as ``Z0/A^2``: Z₀/A²; its name where it has none."""
    _, slash, divisor = name.partition("/")
    return f"{of or name}/{printed_unit(divisor)}" if slash and of else of or name


def data(use: str) -> str:
    """ "estimation data", "held-out data", "validation data"."""
    return f"{DATA[use]} data"


def runs(use: str) -> str:
    """ "estimation runs", "held-out runs", "validation runs"."""
    return f"{DATA[use]} runs"
