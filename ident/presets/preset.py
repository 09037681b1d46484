"""A preset: one paper's model as a choice of stages, with its parameters and its citation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ident.chain import CONDITIONS, Chain
from ident.errors import Unusable
from ident.expression import Equation
from ident.parameter import Parameter


@dataclass(frozen=True)
class Scale:
    """How to search a parameter of a machine of unknown size: value = ratio × `text`, `lower` ≤ ratio ≤ `upper`.

    `text` may read conditions (their typical value over the runs), parameters that stand before it, and W, the
    angular frequency up to which the command excites the machine (rad/s).
    """

    name: str
    text: str
    lower: float
    upper: float

    @property
    def equation(self) -> Equation:
        """The scale as an equation of the grammar."""
        return Equation(f"{self.name} = {self.text}")


@dataclass(frozen=True)
class Combined:
    """A combination of parameters that data may determine where its factors are not: `text` in the grammar."""

    text: str
    unit: str
    meaning: str

    @property
    def equation(self) -> Equation:
        """The combination as an equation of the grammar."""
        return Equation(f"combination = {self.text}")


@dataclass(frozen=True)
class Preset:
    """A model by name.

    `bounds_hold_for` is the piston area (m²) of the machine that the parameters' bounds were stated for; another
    machine is searched over `scales`. `without_area` gives the name and unit of what a parameter becomes when the
    area is unknown. Raises Unusable where an equation reads what is neither a parameter nor a condition.
    """

    name: str
    title: str
    citation: str
    chain: Chain
    parameters: tuple[Parameter, ...]
    scales: tuple[Scale, ...]
    bounds_hold_for: float | None = None
    without_area: Mapping[str, tuple[str, str]] | None = None
    combinations: tuple[Combined, ...] = ()
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        known = {parameter.name for parameter in self.parameters} | CONDITIONS.keys()
        unknown = set(self.chain.symbols) - known
        if unknown or {scale.name for scale in self.scales} != {p.name for p in self.parameters}:
            raise Unusable(
                "bad-preset",
                f"its equations read {sorted(unknown)}, or a parameter has no scale",
                f"preset {self.name}",
                "declare a parameter and a scale for each name",
            )

    @property
    def equations(self) -> tuple[Equation, ...]:
        """Every equation of the model, in the order of the chain."""
        return self.chain.equations

    def parameter(self, name: str) -> Parameter:
        """The parameter called `name`, also under its name without area; raises Unusable with the names there are."""
        for parameter in self.parameters:
            alias = (self.without_area or {}).get(parameter.name, ("", ""))[0]
            if name in (parameter.name, alias):
                return parameter
        raise Unusable(
            "unknown-parameter",
            f"model {self.name} has no parameter {name!r}",
            "bounds or values",
            f"choose from {', '.join(p.name for p in self.parameters)}",
        )
