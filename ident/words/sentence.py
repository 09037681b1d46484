"""Parts of a sentence: a phrase with its capital and full stop, and names in a list."""

from __future__ import annotations

from collections.abc import Sequence

MOST = 3
"""Names that a sentence lists as a rule: of more, the first ones and their number."""
_ENDS = (".", "?", "!")


def sentence(phrase: str) -> str:
    """The phrase with a capital letter and a full stop, which a question does without: ``Did you mean mm?``."""
    return f"{phrase[:1].upper()}{phrase[1:]}{'' if not phrase or phrase.endswith(_ENDS) else '.'}"


def all_of(names: Sequence[str]) -> str:
    """All of some names, at least one: "k1, k2 and k3"."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last


def one_of(names: Sequence[str]) -> str:
    """One of some names, at least one: "k1, k2 or k3"."""
    *others, last = names
    return f"{', '.join(others)} or {last}" if others else last


def first_of(names: Sequence[str], most: int = MOST) -> str:
    """The first of some names, and how many more there are: "k1, k2, k3 and 4 more"."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
