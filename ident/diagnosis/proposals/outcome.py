"""What a search for missing terms came to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ident.diagnosis.proposals.proposal import Proposal
from ident.diagnosis.refit import Refit
from ident.diagnosis.standing import contradiction
from ident.matrix import Run


@dataclass(frozen=True, kw_only=True)
class Refused:
    """The best term that stayed below the bar."""

    equation: str
    nats: float
    bar: float


@dataclass(frozen=True, kw_only=True)
class Proposals:
    """What was found, one term on top of the other, the best that was refused, and how many were looked at.

    `refit` is the model with all of it. Not `complete`, the time was over.
    """

    found: tuple[Proposal, ...] = ()
    refit: Refit | None = None
    refused: Refused | None = None
    looked_at: int = 0
    complete: bool = True

    def left(self, before: float, what: str = "fit") -> float:
        """The error with all of it on the fitted runs, or "held_out" from the fit in turn; `before` without."""
        error = self.found[-1].error.get(what) if self.found else None
        return before if error is None else error

    def instead(self, other: Refit, named: Sequence[str], runs: Sequence[Run]) -> Proposals:
        """The same, said to stand instead of what is `named`; where runs to verify speak for that `other`, so it is."""
        if not self.found or self.refit is None:
            return self
        *terms, last = (replace(one, instead_of=tuple(named)) for one in self.found)
        name = str(last.effect["name"])
        against = contradiction(name, runs, other.left(runs), self.refit.left(runs)) if runs else None
        if against is not None:
            last = replace(last, contradicted=replace(against, instead_of=tuple(named)))
        return replace(self, found=(*terms, last))
