"""What a user may choose about a fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

GENERAL = ("ga", "paper-ga", "differential-evolution", "cma-es")
"""Methods of any model; a preset may name more of its own."""
METHODS = (*GENERAL, "gradient", "inverse-dynamics")


@dataclass(frozen=True)
class Settings:
    """A fit, but for its data. Two fits with equal settings and data give the same result, bit for bit.

    `custom` holds the definitions of effects of the user, as plain JSON data: those that `effects` names are in the
    model, like those of the catalogue. `bounds` maps a parameter's name to (lower, upper), `fixed` to the value it is
    held at, all SI. With every parameter fixed nothing is searched and the result is the error of that model.
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

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        lists = {"effects": list(self.effects), "custom": [dict(definition) for definition in self.custom]}
        return asdict(self) | lists | {"bounds": {k: list(v) for k, v in self.bounds.items()}}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Settings:
        """The inverse of :meth:`to_json`."""
        bounds = {name: (float(lo), float(hi)) for name, (lo, hi) in data.get("bounds", {}).items()}
        lists = {name: tuple(data.get(name, ())) for name in ("effects", "custom")}
        return cls(**{**data, **lists, "bounds": bounds})
