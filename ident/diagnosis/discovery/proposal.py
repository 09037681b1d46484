"""A term that a search proposes, in the contract's words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ident.diagnosis.parameter_estimate import ParameterEstimate
from ident.diagnosis.verification import Contradiction
from ident.plain import WHERE_KNOWN, written
from ident.words.error import ErrorOf

Errors = Mapping[str, float | None]


@dataclass(frozen=True, kw_only=True)
class Proposal:
    """A term whose gain exceeds the bar: its place, its equation, and its definition as an effect.

    `terms` counts the terms that were added up to this one, `shapes` the numbers within it that were fitted. `nats` is
    the gain on runs that neither the search nor the choice saw, `bar` the least gain. `alike`, in the JSON ``class``,
    are the forms that the data cannot distinguish from it; `beside` the effects of the model that it was added to,
    `instead_of` the named effects of the catalogue that the model does not have. `parameters` are the parameters of the
    model with the term, by name, and `view` is the view that shows its characteristic (see
    :func:`ident.residuals.views.view_called`); "" where the term is no function of one signal.

    With `free_curve` h in its equation is drawn through the knots of its effect's curve, and no formula is known.

    A `hypothesis` could not be confirmed on other runs, because there were too few. `contradicted`: the error on
    validation data rises with the term, or is above the error with the effects that it replaces. `unstable` has by use
    the runs on which the model is unstable with it.
    """

    place: tuple[str, ...]
    equation: str
    effect: Mapping[str, Any]
    strength: float = 0.0
    std_error: float | None = None
    unit: str = "1"
    terms: int = 1
    shapes: int = 0
    parameters: Mapping[str, ParameterEstimate] = field(default_factory=dict)
    view: str = ""
    error: Errors = field(default_factory=dict)
    nats: float = 0.0
    bar: float = 0.0
    alike: tuple[str, ...] = ()
    beside: tuple[str, ...] = ()
    instead_of: tuple[str, ...] = ()
    meaning: str = ""
    formula: str = ""
    hypothesis: bool = False
    free_curve: bool = False
    contradicted: Contradiction | None = None
    unstable: Mapping[str, tuple[str, ...]] = field(default_factory=dict, metadata=WHERE_KNOWN)

    def error_of(self, use: str) -> ErrorOf:
        """The error on the runs of a use as a reader reads it."""
        return ErrorOf(self.error.get(use), unstable=self.unstable.get(use, ()))

    def corrected_by(self, last: Proposal) -> bool:
        """Whether later terms, the `last` of them among them, bring down the validation error that the term raised."""
        left = last.error.get("verify")
        return self.contradicted is not None and left is not None and left < self.contradicted.before

    def to_json(self) -> dict[str, Any]:
        """The proposal as plain JSON data, in the contract's words."""
        return {"class" if name == "alike" else name: entry for name, entry in written(self).items()}


def from_json(data: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a proposal in the names of its fields."""
    return {"alike" if name == "class" else name: entry for name, entry in data.items()}
