"""Other fits that a figure draws over the one that it is of, up to eight in all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ident.comparison.compare import RunComparison
from ident.comparison.side_by_side import MOST, titles
from ident.errors import Unusable
from ident.figures import words
from ident.fit.result import FitResult


def others_of(options: Mapping[str, Any]) -> tuple[FitResult, ...]:
    """The fits in the option `other`, one or several. Raises Unusable where they are none, or too many."""
    given = options.get("other") or ()
    others = (given,) if isinstance(given, FitResult) else tuple(given)
    if not all(isinstance(one, FitResult) for one in others):
        raise Unusable("bad-fit", f"other is {given!r}", "figure option other", "give one fit or several")
    if len(others) >= MOST:
        what = f"{len(others) + 1} fits in one figure"
        raise Unusable("bad-option", what, "figure option other", f"give {MOST - 1} others at most")
    return others


def titles_of(fits: Sequence[FitResult], compared: Sequence[RunComparison]) -> tuple[str, ...]:
    """What each fit is called in a legend, with its error on the run that is drawn."""
    named = zip(titles(fits), compared, strict=True)
    return tuple(f"{name}, {words.error(one.words)}" for name, one in named)
