"""A stage: the core equations of one place of the chain."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ident.equations.equation import Equation
from ident.errors import Unusable

PLACES = ("controller", "valve", "spool", "flow", "pressure", "load", "sensor")
"""The seven places, in the order of the signal."""


@dataclass(frozen=True)
class Quantity:
    """A state or signal of the chain: the name its equations use, unit, meaning."""

    name: str
    unit: str
    meaning: str


@dataclass(frozen=True)
class Stage:
    """One place of the chain.

    `publishes` names the states and signals that its equations define; other places read them by name. A stage that
    is exchanged for another must publish what the rest of the chain reads. Raises Unusable where an equation has no
    published left-hand side, or a published quantity no equation.
    """

    place: str
    publishes: tuple[Quantity, ...]
    equations: tuple[Equation, ...]

    def __post_init__(self) -> None:
        published, defined = {q.name for q in self.publishes}, {e.target for e in self.equations}
        if self.place not in PLACES or published != defined:
            raise Unusable(
                "bad-stage",
                f"publishes {sorted(published)} but has equations for {sorted(defined)}",
                f"stage {self.place!r}",
                f"give each published quantity one equation, at one of the places {', '.join(PLACES)}",
            )

    def with_equations(self, *equations: tuple[str, str]) -> Stage:
        """The stage with other equations for some of its quantities: (text, meaning) pairs."""
        other = {e.target: e for e in (Equation(text, self.place, meaning) for text, meaning in equations)}
        return replace(self, equations=tuple(other.get(e.target, e) for e in self.equations))


def stage(place: str, publishes: tuple[Quantity, ...], *equations: tuple[str, str]) -> Stage:
    """A stage from (text, meaning) pairs."""
    return Stage(place, publishes, tuple(Equation(text, place, meaning) for text, meaning in equations))
