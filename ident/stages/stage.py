"""A stage: the core equations of one place of the chain."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.parameter import Parameter
from ident.stages.scale import Scale

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

    A stage that is exchanged for another must publish what the rest of the chain reads. Raises Unusable where an
    equation has no published left-hand side, a published quantity no equation, or a parameter no scale.
    """

    place: str
    """One of :data:`PLACES`."""
    publishes: tuple[Quantity, ...]
    """States and signals that its equations define, one equation each; other places and effects read them by name."""
    equations: tuple[Equation, ...]
    """What the place does without effects."""
    parameters: tuple[Parameter, ...] = ()
    """Parameters that it brings, with bounds for a machine of unknown size; a preset may state others."""
    scales: tuple[Scale, ...] = ()
    """How each of them is searched there; a preset may state others."""

    def __post_init__(self) -> None:
        published, defined = {q.name for q in self.publishes}, {e.target for e in self.equations}
        if self.place not in PLACES or published != defined:
            raise Unusable(
                "bad-stage",
                f"publishes {sorted(published)} but has equations for {sorted(defined)}",
                f"stage {self.place!r}",
                f"give each published quantity one equation, at one of the places {', '.join(PLACES)}",
            )
        brought, scaled = [parameter.name for parameter in self.parameters], [scale.name for scale in self.scales]
        if sorted(brought) != sorted(scaled):
            raise Unusable(
                "bad-stage",
                f"brings {sorted(brought)} but has scales for {sorted(scaled)}",
                f"stage {self.place!r}",
                "give each parameter one scale",
            )

    @property
    def reads(self) -> frozenset[str]:
        """What its equations read and it does not bring: of other stages, of the run and its actuator, of the clock."""
        own = {quantity.name for quantity in self.publishes}
        own |= {f"{name}__old" for name in own} | {parameter.name for parameter in self.parameters}
        return frozenset().union(*(equation.names for equation in self.equations)) - own

    def with_equations(self, *equations: tuple[str, str]) -> Stage:
        """The stage with other equations for some of its quantities: (text, meaning) pairs."""
        other = {e.target: e for e in (Equation(text, self.place, meaning) for text, meaning in equations)}
        return replace(self, equations=tuple(other.get(e.target, e) for e in self.equations))


def stage(
    place: str,
    publishes: tuple[Quantity, ...],
    *equations: tuple[str, str],
    parameters: tuple[Parameter, ...] = (),
    scales: tuple[Scale, ...] = (),
) -> Stage:
    """A stage from (text, meaning) pairs."""
    texts = tuple(Equation(text, place, meaning) for text, meaning in equations)
    return Stage(place, publishes, texts, parameters, scales)
