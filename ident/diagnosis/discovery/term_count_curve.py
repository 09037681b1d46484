"""The error against the number of proposed terms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ident.diagnosis.discovery.proposal import Errors, Proposal

if TYPE_CHECKING:
    from ident.diagnosis.result import Rung


@dataclass(frozen=True)
class TermCount:
    """The number of first `terms`, the number of `shapes` within them that were fitted, and the errors with them.

    `latest` is the equation of the last of them; with no terms, the effects of the catalogue in the model.
    """

    terms: int
    shapes: int
    latest: str
    error: Errors


def term_count_curve(proposals: Sequence[Proposal], ladder: Sequence[Rung]) -> tuple[TermCount, ...]:
    """The errors from none of the terms to all; `ladder` is the diagnosis's. () where nothing is proposed."""
    if not proposals:
        return ()
    steps = ladder[:1] if proposals[0].instead_of else ladder  # terms in place of the catalogue's begin without those
    named = ", ".join(rung.added for rung in steps if rung.added)
    shapes = [sum(one.shapes for one in proposals[:terms]) for terms in range(len(proposals) + 1)]
    rest = zip(proposals, shapes[1:], strict=True)
    return (
        TermCount(0, 0, named, steps[-1].error),
        *(TermCount(terms, of, one.equation, one.error) for terms, (one, of) in enumerate(rest, 1)),
    )
