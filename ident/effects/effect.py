"""A physical effect that a chain may lack: one strength, off at zero, at one place."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

from ident.cached import cached_property
from ident.effects.needs import Need
from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.parameter import Parameter
from ident.run import Run
from ident.stages import PLACES


@dataclass(frozen=True)
class Effect:
    """What is added to the chain at `place`. Raises Unusable where place or strength are not of the form below."""

    name: str
    """An identifier without two underscores; the file of the effect has it, in capitals its value."""
    place: str
    """One of :data:`ident.stages.PLACES`: its equations stand behind those of the stage there."""
    meaning: str
    """What it is, as a clause."""
    strength: Parameter
    """Off at 0, its default: the chain is then exactly unchanged. The first of its parameters."""
    texts: tuple[str, ...]
    """Equations: they redefine signals of the chain and give the rates and memories of its own states.

    A state of the chain, such as the pressure P, is not redefined: what its rate reads is, as the leakage L.
    An equation reads a signal that the effect redefines as it was left by what stands before, every other name in its
    final value, and a memory of the effect in the equation of a memory as it was at the start of the step.
    `servoident effects --signals MODEL` lists the signals (:mod:`ident.presets.signal_table`).
    """
    shape: tuple[Parameter, ...] = ()
    """Its other parameters: held at their defaults unless a fit frees them, or `searched` with the strength."""
    looks: str = ""
    """What it looks like in data, as a clause."""
    source: str = ""
    """Where its equation is from."""
    steps: int = 1
    """Into how many steps a sample has to be divided so that its kinks are met closely enough."""
    stride: float = 1e-5
    """Share of its range by which its strength is moved for a sensitivity: far where it acts in jumps."""
    units: Mapping[str, str] = field(default_factory=dict, hash=False)
    """Unit of each signal that it redefines, for which its strength is made; "" is any.

    A chain that has such a signal in another unit refuses it.
    """
    does: str = ""
    """What it does in a few words, where its name is of a part that a machine need not have."""
    of_specimen: bool = False
    """Whether it is a specimen's: no diagnosis names it where nothing is known of a specimen."""
    of_place: bool = False
    """Whether it acts at places of a way, such as its ends: no diagnosis names it of what turns round."""
    needs: Need | None = None
    """What a matrix must have for a diagnosis to look for it (:mod:`ident.effects.needs`); None is nothing."""
    shown: bool = False
    """Whether a record that has what it needs shows it by itself: it then comes before what explains as much."""
    whole: bool = False
    """Whether it is there wholly or not at all: what has it then has the upper bound of its strength."""
    undone: Callable[[Run], Run] | None = None
    """A run as it would be without what the effect does to its output, as far as its record tells; None tells nothing.

    A linear fit of such runs leads to the model with the effect, one of what was recorded may lead nowhere.
    """
    takes_over: tuple[str, ...] = ()
    """Symbols of a machine's springs, of which a part is this effect's at small motions: its strength over its way."""
    slides: bool = False
    """Whether its strength is the force against a motion while it slides or yields, the same to both sides."""
    unless: str = ""
    """A symbol of a machine that no diagnosis names it of: one that has it in its core, or has no such part."""
    own: bool = False
    """Whether its bounds were stated for this machine by who wrote it; then they hold for a machine of any size."""

    def __post_init__(self) -> None:
        _ = self.equations
        if self.place not in PLACES or not self.name.isidentifier() or "__" in self.name:
            raise Unusable(
                "bad-effect",
                f"place {self.place!r}",
                f"effect {self.name!r}",
                f"choose a place from {', '.join(PLACES)} and an identifier as name",
            )
        if self.strength.value != 0 or not self.strength.lower <= 0 <= self.strength.upper:
            raise Unusable(
                "bad-effect",
                "0 is not in the bounds of the strength, or not its default",
                f"effect {self.name!r}",
                "let the strength be 0 where the effect is off",
            )

    @cached_property
    def equations(self) -> tuple[Equation, ...]:
        """The equations, parsed and checked."""
        return tuple(Equation(text, self.place, self.meaning) for text in self.texts)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Strength and shape."""
        return (self.strength, *self.shape)

    @cached_property
    def added(self) -> tuple[Parameter, ...]:
        """Strength and shape as parameters of a model that has the effect, the strength first."""
        return tuple(parameter.of_effect(self.name) for parameter in self.parameters)

    @property
    def has_searched_shapes(self) -> bool:
        """Whether shapes are searched with the strength: it is then tried at many of them, for itself."""
        return any(parameter.searched for parameter in self.shape)

    def suits(self, matrix: Matrix) -> bool:
        """Whether a matrix has what it needs."""
        return self.needs is None or self.needs(matrix)

    def symbol(self, name: str) -> str:
        """The name of one of its own quantities in the equations of a whole chain."""
        return f"{self.name}__{name}"

    def names_in(self, equation: Equation, core: frozenset[str]) -> dict[str, str]:
        """What the names of one of its equations are in a whole chain; those of the `core` stay."""
        own = {e.target for e in self.equations} - core
        memories = {e.target for e in self.equations if e.is_memory}
        names = {name: self.symbol(name) for name in own}
        names |= {parameter.symbol: parameter.in_equations for parameter in self.added}
        if equation.is_memory:
            names |= {name: f"{self.symbol(name)}__old" for name in memories}
        return names


def undoable(matrix: Matrix, effects: Iterable[Effect]) -> tuple[Effect, ...]:
    """The effects that a matrix may have and that can be undone in its records."""
    return tuple(effect for effect in effects if effect.undone is not None and effect.suits(matrix))


def undone(matrix: Matrix, effects: Iterable[Effect]) -> Matrix:
    """The matrix with each run as it would be without these effects, which :func:`undoable` gave."""
    runs = matrix.runs
    for effect in effects:
        assert effect.undone is not None
        runs = tuple(map(effect.undone, runs))
    return replace(matrix, runs=runs) if runs is not matrix.runs else matrix


def off_values(effects: Iterable[Effect]) -> dict[str, float]:
    """The values of effects' parameters where they are off, by the equations' names."""
    return {parameter.in_equations: parameter.value for effect in effects for parameter in effect.added}


def usual_shapes(effects: Iterable[Effect]) -> dict[str, float]:
    """The defaults of effects' shapes, by the equations' names: of one that an effect had not when it was fitted."""
    return {parameter.in_equations: parameter.value for effect in effects for parameter in effect.added[1:]}
