"""Names in a sentence."""

from __future__ import annotations

from collections.abc import Sequence

MOST = 3
"""Names that a sentence lists as a rule: of more, the first ones and their number."""


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
