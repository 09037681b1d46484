"""Another fit that a figure draws beside the one that it is of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.words.titles import title


def candidate_of(options: Mapping[str, Any]) -> FitResult | None:
    """The other fit that is drawn beside this one. Raises Unusable where it is none."""
    other = options.get("candidate")
    if other is not None and not isinstance(other, FitResult):
        raise Unusable("bad-fit", f"candidate is {other!r}", "figure option candidate", "give a fit")
    return other


def called(other: FitResult | None, fit: FitResult) -> str:
    """What the other fit is called: what it has more than this one, where it has no less."""
    if other is None:
        return ""
    more = [title(effect) for effect in other.effects if effect not in fit.effects]
    wider = other.model == fit.model and set(fit.effects) < set(other.effects)
    return " + ".join(more if wider else (other.model, *other.effects))
