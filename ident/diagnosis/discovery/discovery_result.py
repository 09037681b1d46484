"""The result of a search for missing terms."""

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
    """The best term below the bar, the effects that it is in addition to, and the errors with it."""

    equation: str
    log_likelihood_gain: float
    bar: float
    beside: tuple[str, ...]
    error: Errors

    def sentences(self, looked_at: int) -> str:
        """The sentences that report it."""
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
    """The proposed terms, each in addition to those before, the best rejected term, and the number `looked_at`.

    `refit` is the model with all proposed terms. `left_out` counts the terms that no model can have, or whose response
    is not finite. `complete` is false where the time was over.
    """

    proposals: tuple[Proposal, ...] = ()
    refit: FittedModel | None = None
    rejected: RejectedTerm | None = None
    looked_at: int = 0
    left_out: int = 0
    complete: bool = True

    def or_rejected(self, other: DiscoveryResult) -> DiscoveryResult:
        """This result where it has terms; else with the rejected term of the smaller error, of this search and the
        other.

        The log-likelihood gains of the two are not comparable, because they count from different models.
        """
        if self.proposals or other.rejected is None:
            return self
        refused = (one.rejected for one in (self, other) if one.rejected is not None)
        best = min(refused, key=lambda one: one.error["fit"] or 0.0)
        looked_at, left_out = self.looked_at + other.looked_at, self.left_out + other.left_out
        return replace(self, rejected=best, looked_at=looked_at, left_out=left_out)

    def notes(self, asked: bool | None) -> Iterator[str]:
        """The notes on a search that was stopped, left terms out, or ended below its bar; `asked`: the user wanted
        it."""
        if not self.complete:
            yield str(message("terms.stopped"))
        if self.left_out:
            yield str(message("terms.left_out", looked_at=self.looked_at, left_out=self.left_out))
        if self.rejected is not None:
            yield self.rejected.sentences(self.looked_at)
        elif asked and not self.looked_at:
            yield str(message("terms.noise"))

    def error_with_terms(self, before: float, what: str = "fit") -> float:
        """The error with all proposed terms on the estimation data, or "held_out"; `before` where there are no
        terms."""
        error = self.proposals[-1].error.get(what) if self.proposals else None
        return before if error is None else error

    def dispensable(self, named: Sequence[str]) -> tuple[str, ...]:
        """The `named` effects that are redundant with the terms, because they imitated them.

        There are none where the terms are a hypothesis, or replace all effects, or validation data contradict them.
        """
        last = self.proposals[-1] if self.proposals else None
        doubted = any(one.hypothesis or one.contradicted for one in self.proposals)
        if last is None or doubted or last.instead_of:
            return ()
        return tuple(name for name in named if name not in last.beside)

    def instead(self, other: FittedModel, named: Sequence[str]) -> DiscoveryResult:
        """The terms in place of the `named` effects, and contradicted where validation data prefer the `other`
        model."""
        if not self.proposals or self.refit is None:
            return self
        *terms, last = (replace(one, instead_of=tuple(named)) for one in self.proposals)
        name = str(last.effect["name"])
        against = contradiction(verified_change(name, other, self.refit))
        if against is not None:
            last = replace(last, contradicted=replace(against, instead_of=tuple(named)))
        return replace(self, proposals=(*terms, last))
