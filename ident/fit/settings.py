"""What a user may choose about a fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ident.errors import Unusable
from ident.fit.start import Start
from ident.plain import WHERE_KNOWN, Misfit, read, written

GENERAL = ("ga", "paper-ga", "differential-evolution", "cma-es")
"""Methods of any model; a preset may name more of its own."""
METHODS = (*GENERAL, "gradient", "inverse-dynamics", "ekf")


@dataclass(frozen=True)
class Settings:
    """A fit, but for its data. Two fits with equal settings and data give the same result, bit for bit.

    `custom` holds the definitions of effects of the user, as plain JSON data: those that `effects` names are in the
    model, like those of the catalogue. `bounds` maps a parameter's name to (lower, upper), `fixed` to the value it is
    held at, all SI. With every parameter fixed nothing is searched and the result is the error of that model. Without a
    `model` ("") that which fits is taken, of those that the channels allow. The search ends with the generation that
    goes beyond `budget`, s; with one, two fits need not be the same. `preprocessing` has false for each step that is
    switched off, see :data:`ident.preprocessing.STEPS`. `known_zeros` are channels of which rest tells the zero, and
    whose mean counts in the fit: see :mod:`ident.fit.known_zeros`. With a `start` the fit begins where an earlier one
    ended, and nothing is searched unless that asks for it.
    """

    model: str = "qian2014"
    effects: tuple[str, ...] = ()
    method: str = "ga"
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    fixed: Mapping[str, float] = field(default_factory=dict)
    load: str = "none"
    seed: int = 0
    options: Mapping[str, float] = field(default_factory=dict)  # of the method: population, keep, mutation, ...
    custom: tuple[Mapping[str, Any], ...] = ()
    budget: float | None = None
    preprocessing: Mapping[str, bool] = field(default_factory=dict, metadata=WHERE_KNOWN)
    known_zeros: tuple[str, ...] = field(default=(), metadata=WHERE_KNOWN)
    start: Start | None = field(default=None, metadata=WHERE_KNOWN)

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data; a start that is not there is left out."""
        data: dict[str, Any] = written(self)
        return data

    @classmethod
    def from_json(cls, data: object) -> Settings:
        """The inverse of :meth:`to_json`, of what any version wrote. Raises Unusable where it is no settings."""
        try:
            return read(cls, data)
        except Misfit as error:
            raise Unusable(
                "bad-fit",
                f"not the settings of a fit: {error}",
                "fit",
                "give the file that `servoident fit --json FILE` wrote",
            ) from None
