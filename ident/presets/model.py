"""A model by name: a chain of stages with the parameters that they bring, and its citation."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Literal, Self, TypeVar

from ident.cached import cached_property
from ident.chain.chain import Chain
from ident.chain.channels import READABLE
from ident.chain.conditions import CONDITIONS
from ident.chain.refused_effects import unfit
from ident.effects.effect import Effect
from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.parameter import Parameter
from ident.presets.stroke_centre import about_stroke_centre
from ident.stages import MASS_SPRING_DAMPER, MEASURED_LOAD
from ident.words.nearest import did_you_mean
from ident.words.run_name import run_name

Kind = Literal["chain", "bench"]
"""Who serves a model: what fits chains to test runs, or Kononykhin's procedures for the records of a bench."""
T = TypeVar("T")


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

    def exponent(self, name: str) -> float:
        """The power in which the combination has a parameter that multiplies or divides all of it; else 0."""
        if name not in self.equation.names:
            return 0.0
        others = {other: 1.0 + 0.37 * place for place, other in enumerate(sorted(self.equation.names))}
        once, twice, again = (float(self.equation.value({**others, name: of})) for of in (1.0, 2.0, 4.0))
        if once == 0.0 or once * twice <= 0.0 or not math.isclose(twice * twice, once * again, rel_tol=1e-9):
            return 0.0  # it stands in a sum
        return round(math.log2(twice / once), 6)


@dataclass(frozen=True)
class Model:
    """The stages of `chain`, with the parameters that they bring, and the effects that were added to it.

    Raises Unusable where an equation reads what no stage brings and no condition is, where two stages mean different
    parameters by one name, and where something is stated of a parameter that no stage brings.
    """

    name: str
    title: str
    citation: str
    chain: Chain
    stated: tuple[Parameter, ...] = ()
    """Take the place of the stages' parameters of these names, where a paper states other bounds."""
    listed: tuple[str, ...] = ()
    """Parameters that results list first; then those stated, then those of the stages along the chain."""
    without_area: Mapping[str, tuple[str, str]] | None = None
    """Name and unit of what a parameter becomes where the piston area is unknown."""
    combinations: tuple[Combined, ...] = ()
    """What the data may determine where they do not determine its factors."""
    notes: tuple[str, ...] = ()
    """What a reader of the paper has to know, such as its misprints."""
    kind: Kind = "chain"
    steps: int = 1
    """Steps of the integration in a sample that the kinks of its core ask for."""
    absolute: tuple[str, ...] = ()
    """Outputs whose zero is the model's own, so that a fit counts their mean."""
    crossing: tuple[str, ...] = ()
    """Parameters that may well be nothing: their standard error is no share of the value."""
    static_gains: tuple[str, ...] = ()
    """Parameters that lead from command to output, in the output's unit over the command's."""
    middle: float = 0.0
    """Middle of the stroke, m, about which effects act."""

    def __post_init__(self) -> None:
        where, brought = f"preset {self.name}", {p for stage in self.chain.stages for p in stage.parameters}
        own = [parameter.name for parameter in brought]
        if twice := {name for name in own if own.count(name) > 1}:
            raise Unusable(
                "bad-preset",
                f"its stages mean different parameters by {', '.join(sorted(twice))}",
                where,
                "rename one of them",
            )
        if idle := {*self.listed, *(p.name for p in self.stated), *self._stated_otherwise} - set(own):
            raise Unusable(
                "bad-preset",
                f"no stage brings {', '.join(sorted(idle))}, which it states",
                where,
                "leave it out, or let a stage bring it",
            )
        if unknown := set(self.chain.symbols) - self.known:
            readers = ", ".join(stage.place for stage in self.chain.stages if stage.reads & unknown)
            raise Unusable(
                "bad-preset",
                f"no stage brings {', '.join(sorted(unknown))}, read at {readers}",
                where,
                "let a stage bring it as a parameter or publish it",
            )

    @property
    def _stated_otherwise(self) -> frozenset[str]:
        """Further parameters of which something is stated."""
        return frozenset()

    @property
    def known(self) -> set[str]:
        """The symbols that equations and scales may read: parameters, conditions of a run, channels."""
        return {parameter.in_equations for parameter in self.parameters} | CONDITIONS.keys() | set(READABLE)

    @property
    def effects(self) -> tuple[Effect, ...]:
        """The effects added to its chain."""
        return self.chain.effects

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters of its stages, as stated where they are, and of its effects."""
        of_stages = {parameter.name: parameter for stage in self.chain.stages for parameter in stage.parameters}
        stated = {parameter.name: parameter for parameter in self.stated}
        of_effects = {parameter.name: parameter for effect in self.effects for parameter in effect.added}
        return in_order(of_stages | stated | of_effects, (*self.listed, *stated))

    @property
    def is_linear(self) -> bool:
        """Whether the command alone drives a linear chain: each run is then reduced once (:mod:`ident.fit.reduction`).

        With effects a chain counts as nonlinear even where its equations are linear: at strength zero some have a
        state that nothing reads, or a time constant of nothing.
        """
        return not self.effects and self.chain.is_linear

    @cached_property
    def core(self) -> Chain:
        """The chain without effects."""
        return self.chain.with_effects(())

    @property
    def equations(self) -> tuple[Equation, ...]:
        """Every equation of the model, in the order of the chain."""
        return self.chain.equations

    def parameter(self, name: str) -> Parameter:
        """The parameter called `name`, also under its name without area, or an effect's by its name alone.

        Raises Unusable with the nearest name.
        """
        for parameter in self.parameters:
            alias = (self.without_area or {}).get(parameter.name, ("", ""))[0]
            if name in (parameter.name, parameter.in_equations, alias):
                return parameter
        for effect in self.effects:
            for parameter in effect.parameters:
                if name == f"{effect.name}.{parameter.symbol}" or (
                    name == effect.name and parameter == effect.strength
                ):
                    return self.parameter(f"{effect.name}.{parameter.name}")
        raise Unusable(
            "unknown-parameter",
            f"model {self.name} has no parameter {name!r}",
            "bounds or values",
            did_you_mean(name, self._called),
        )

    @property
    def _called(self) -> tuple[str, ...]:
        """What a parameter is found by: its name, that without an area, that of an effect for its strength."""
        without = (name for name, _ in (self.without_area or {}).values())
        return (*(p.name for p in self.parameters), *without, *(effect.name for effect in self.effects))

    def with_effects(self, effects: tuple[Effect, ...]) -> Self:
        """The model with effects added to its chain; their parameters are called effect__parameter in the equations.

        Raises Unusable where the model has no place for an effect.
        """
        if not effects:
            return self
        known = self.known | {parameter.in_equations for effect in effects for parameter in effect.added}
        chain = self.chain.with_effects(tuple(about_stroke_centre(effect, self.middle) for effect in effects))
        if set(chain.symbols) - known:
            raise unfit(next(e for e in effects if set(self.chain.with_effects((e,)).symbols) - known))
        return replace(self, chain=chain)

    def takes(self, effect: Effect) -> bool:
        """Whether the model has a place for an effect and no circle of signals with it."""
        try:
            _ = self.with_effects((effect,)).chain.signals
        except Unusable:
            return False
        return True

    def with_measured_load(self, matrix: Matrix) -> Self:
        """The model with the force measured on the specimen in place of the specimen's equation."""
        bare = [run.id for run in matrix.runs if "force" not in run.channels]
        if bare:
            raise Unusable("missing-channel", "no force channel", run_name(bare[0]), "fit without the measured load")
        self.refuse_without_specimen()
        stages = tuple(MEASURED_LOAD if stage is MASS_SPRING_DAMPER else stage for stage in self.chain.stages)
        return replace(self, chain=replace(self.chain, stages=stages))

    def refuse_without_specimen(self) -> None:
        """Raise Unusable where the model has no specimen whose force could be measured instead."""
        if MASS_SPRING_DAMPER not in self.chain.stages:
            raise Unusable("unknown-load", f"model {self.name} has no specimen", "load", "use none")


def in_order(found: Mapping[str, T], first: Iterable[str]) -> tuple[T, ...]:
    """What was found, by these names first."""
    return tuple(found[name] for name in dict.fromkeys((*first, *found)))
