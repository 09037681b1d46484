"""What a search for missing terms came to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ident.diagnosis.discovery.proposal import Errors, Proposal
from ident.diagnosis.fitted_model import FittedModel
from ident.diagnosis.model_comparison import verified_change
from ident.diagnosis.verdict import contradiction
from ident.words.message import message, said


@dataclass(frozen=True, kw_only=True)
class RejectedTerm:
    """The best term that stayed below the bar, beside which effects, and the errors with it."""

    equation: str
    log_likelihood_gain: float
    bar: float
    beside: tuple[str, ...]
    error: Errors

    def sentences(self, looked_at: int) -> str:
        """In sentences."""
        verify = self.error["verify"]
        term = {"equation": self.equation, "looked_at": looked_at}
        evidence = {"gain": self.log_likelihood_gain, "bar": self.bar}
        return said(
            [
                message("refused.given", effects=self.beside, **term) if self.beside else message("refused", **term),
                message("refused.some_runs" if self.log_likelihood_gain > self.bar else "refused.little", **evidence),
                message("refused.error", error=self.error["fit"])
                if verify is None
                else message("refused.error_verify", error=self.error["fit"], verify=verify),
            ]
        )


@dataclass(frozen=True, kw_only=True)
class DiscoveryResult:
    """What was found, one term on top of the other, the best that was refused, and how many were looked at.

    `refit` is the model with all of it. So many terms were `left_out`, for no model can hold them or what they add is
    not finite. Not `complete`, the time was over.
    """

    found: tuple[Proposal, ...] = ()
    refit: FittedModel | None = None
    rejected: RejectedTerm | None = None
    looked_at: int = 0
    left_out: int = 0
    complete: bool = True

    def or_rejected(self, other: DiscoveryResult) -> DiscoveryResult:
        """The same where something was found; else of the terms that two searches refused the one with the smaller
        error.

        Their nats count from different models.
        """
        if self.found or other.rejected is None:
            return self
        refused = (one.rejected for one in (self, other) if one.rejected is not None)
        best = min(refused, key=lambda one: one.error["fit"] or 0.0)
        looked_at, left_out = self.looked_at + other.looked_at, self.left_out + other.left_out
        return replace(self, rejected=best, looked_at=looked_at, left_out=left_out)

    def notes(self, asked: bool | None) -> Iterator[str]:
        """What is said of a search that was stopped, left terms out, or ended below its bar; `asked`: it was wanted."""
        if not self.complete:
            yield str(message("terms.stopped"))
        if self.left_out:
            yield str(message("terms.left_out", looked_at=self.looked_at, left_out=self.left_out))
        if self.rejected is not None:
            yield self.rejected.sentences(self.looked_at)
        elif asked and not self.looked_at:
            yield str(message("terms.noise"))

    def error_with_terms(self, before: float, what: str = "fit") -> float:
        """The error with all of it on the fitted runs, or "held_out" from the fit in turn; `before` without."""
        error = self.found[-1].error.get(what) if self.found else None
        return before if error is None else error

    def dispensable(self, named: Sequence[str]) -> tuple[str, ...]:
        """Of what is `named` that which the model does as well without, beside the terms: it stood for them.

        Nothing, where the terms are a hypothesis, or stand in the place of all of it, or runs to verify speak against
        them.
        """
        last = self.found[-1] if self.found else None
        doubted = any(one.hypothesis or one.contradicted for one in self.found)
        if last is None or doubted or last.instead_of:
            return ()
        return tuple(name for name in named if name not in last.beside)

    def instead(self, other: FittedModel, named: Sequence[str]) -> DiscoveryResult:
        """The same, said to stand instead of what is `named`; where runs to verify speak for that `other`, so it is."""
        if not self.found or self.refit is None:
            return self
        *terms, last = (replace(one, instead_of=tuple(named)) for one in self.found)
        name = str(last.effect["name"])
        against = contradiction(verified_change(name, other, self.refit))
        if against is not None:
            last = replace(last, contradicted=replace(against, instead_of=tuple(named)))
        return replace(self, found=(*terms, last))
