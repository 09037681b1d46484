"""What is said where nothing was found: the nearest of the names that there are."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping


def tell_nearest(asked: Mapping[str, str | None], known: Callable[[str], Iterable[str]]) -> None:
    """Say on standard error, of each name that was asked for and is not there, which known one is nearest."""
    from ident.words.nearest import nearest

    for where, name in asked.items():
        names = list(known(where)) if name else []
        if name and name not in names and (near := nearest(name, names)) is not None:
            print(f"there is no {where} {name!r}; did you mean {near}?", file=sys.stderr)
