"""A name that is not known: the nearest one that is, as the remedy of a refusal."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches

_NEAR = 0.6
"""Ratio of difflib (twice the letters in common over all letters) from which on a name may be meant."""
_NEAR_IF_SHORT, _SHORT = 0.5, 3
"""The same of a name of at most three letters, one of which may be wrong."""
_WORDS = frozenset(("a", "as", "at", "in", "is", "it", "no", "of", "on", "or", "to"))
"""Names that are read as words of the sentence: in is a unit, too."""
_PLAIN = re.compile(r"\S+")
"""A name that needs no quotes in a sentence."""


def did_you_mean(name: object, known: Iterable[str], otherwise: str = "") -> str:
    """The remedy ``did you mean dead_zone?`` with the known name that is nearest; where none is near, `otherwise`.

    Where several known names contain the given one, all of them are said: ``did you mean pressure_a or pressure_b?``

    Without `otherwise` the known names are listed. Neither case, separators nor spaces count for how near a name is;
    what is no text, such as a number in its place, is taken as it would be written.
    """
    names = list(dict.fromkeys(known))
    *others, near = _containing(str(name), names) or [nearest(str(name), names)]
    if near is not None:
        first = f"{', '.join(map(quoted, others))} or " if others else ""
        return f"did you mean {first}{quoted(near)}?"
    return otherwise or (f"choose from {', '.join(names)}" if names else "leave it out")


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name that is nearest to a misspelt one; None where none is near."""
    spelt: dict[str, str] = {}
    for one in known:
        spelt.setdefault(_letters(one), one)
    letters = _letters(name)
    near = get_close_matches(letters, spelt, 1, _NEAR_IF_SHORT if len(letters) <= _SHORT else _NEAR)
    return spelt[near[0]] if near and letters else None


def quoted(name: str | None) -> str:
    """A name as it stands in a sentence: in quotes where it has spaces, or could be read as a word of it."""
    return name if name is not None and _PLAIN.fullmatch(name) and name not in _WORDS else repr(name)


def _containing(name: str, known: Iterable[str]) -> list[str | None]:
    """The known names that contain a longer one as one of their words."""
    letters = _letters(name)
    words = ((one, re.split(r"[\W_]+", one.casefold())) for one in known)
    return [one for one, of in words if len(letters) > _SHORT and letters in of]


def _letters(name: str) -> str:
    """What counts of a name."""
    return re.sub(r"[\W_]+", "", name.casefold())
