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
    """A term that helps beyond the bar: where it acts, its equation, the effect of its own that it is.

    `terms` counts the terms that were added up to this one, `shapes` the numbers within it that were fitted. `nats` are
    those of runs that neither the search nor the choice saw, `bar` what they had to exceed. `alike`, in the JSON
    ``class``, are the forms that the data cannot tell from it; `beside` the effects of the model that it was added to,
    `instead_of` those that the catalogue had named and that are not in it.
    `parameters` are those of the model with it, by name, and `view` is where its characteristic shows (see
    :func:`ident.residuals.views.view_called`); "" where that is no function of one signal.

    A `free_curve` is one: h in its equation is drawn through knots of its effect's curve, and no formula is known.

    Of a `hypothesis` there were too few runs to confirm it on others. `contradicted`: the error on runs to verify rises
    with it, or is above that of what it stands instead of. `unstable` has by use the runs on which the model is
    unstable with it.
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

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data, in the contract's words."""
        return {"class" if name == "alike" else name: entry for name, entry in written(self).items()}


def from_json(data: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a proposal in the names of its fields."""
    return {"alike" if name == "class" else name: entry for name, entry in data.items()}
