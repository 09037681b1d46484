"""The machine of a hybrid simulation: an identified chain that moves the physical specimen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import FORCE as INTERACTION
from ident.chain.chain import INPUT, INPUT_RATE, MEASURED, STEP, Chain
from ident.chain.conditions import conditions
from ident.custom.definition import preset_with
from ident.effects.effect import Effect
from ident.equations.grammar import TIME
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.lags_as_states import with_states
from ident.matrix import Actuator
from ident.parameter import Parameter
from ident.presets import Preset
from ident.run import Run
from ident.simulation.steps import fastest_mode, steps_needed
from ident.stages import MASS_SPRING_DAMPER, Quantity
from ident.stages.stage import Stage, stage

Array = NDArray[np.float64]
DISPLACEMENT, FORCE = "displacement", "force"
_BAND = 80.0  # Hz: a hybrid simulation moves its specimen by less
_SPECIMEN = stage(
    "load",
    (
        Quantity("xL", "m", "position of the specimen"),
        Quantity("vL", "m/s", "speed of the specimen"),
        Quantity("xk", "m", "stretch of the specimen's spring"),
        Quantity("S", "N", "reaction of the specimen's spring and damper"),
        Quantity("F", "N", "force on the specimen"),
    ),
    ("xL = x", "the specimen moves with the rod"),
    ("vL = v", "the specimen has the speed of the rod"),
    ("xk = xL", "the spring has no play"),
    ("S = k * xk + cL * vL", "spring and damper of the specimen"),
    ("F = S", "reading of a load cell between rod and specimen"),
)
"""A specimen that a machine moves whatever it takes, as one without an equation of forces does."""


@dataclass(frozen=True, eq=False)
class Machine:
    """A chain with its values by the equations' names, whose channels are what is measured beside the specimen.

    `displacement` is what the recorder reads, effects of the sensor in it. `force` is the load cell between rod and
    specimen: spring, damper and inertia of the specimen, not of the rod. `kinks` are
    the steps that those of the model's core ask for; `parameters` are those of its model.
    """

    chain: Chain
    values: Mapping[str, float]
    kinks: int = 1
    parameters: tuple[Parameter, ...] = ()

    def at(self, case: Case) -> dict[str, float]:
        """Every symbol of the chain under the conditions of a case."""
        return {**_conditions(case), **self.values}

    def steps(self, case: Case) -> int:
        """Into how many steps a sample is divided."""
        known = {name: np.array([value]) for name, value in self.at(case).items()}
        fastest = fastest_mode(self.chain, known, DISPLACEMENT) / case.sample_rate
        band = 2 * np.pi * _BAND / case.sample_rate
        on = [effect for effect in self.chain.effects if known[effect.added[0].in_equations][0]]
        return int(steps_needed(self.chain, fastest, "zoh", on, band, self.kinks)[0])

    @property
    def has_inertia(self) -> bool:
        """Whether forces accelerate it: a machine without moves its specimen whatever that takes."""
        return "a" in self.chain.units

    def moved_mass(self, case: Case) -> float:
        """The mass (kg) that a force on the specimen accelerates, rod and specimen; 0 where none does."""
        if not self.has_inertia:
            return 0.0
        still = dict.fromkeys((*self.chain.states, *(f"{name}__old" for name in self.chain.memories)), 0.0)
        still |= dict.fromkeys((INPUT, INPUT_RATE, *MEASURED, TIME), 0.0) | {STEP: 1.0}
        return float(self.chain.signals_at({**self.at(case), **still})["M"])

    @cached_property
    def small(self) -> Chain:
        """The chain as its poles are taken: lags and delays of the effects that are on as states, no others.

        A delay of the command is four sections of the Padé approximant of second order, one in the loop the one that
        simulates it.
        """
        return self.chain.with_effects(tuple(map(_as_states, self._on)))

    @property
    def _on(self) -> tuple[Effect, ...]:
        return tuple(effect for effect in self.chain.effects if self.values[effect.added[0].in_equations])

    @cached_property
    def nonlinear(self) -> tuple[str, ...]:
        """What is not linear at small signals, so that poles do not tell: the effects that are on, the core itself."""
        core = self.chain.with_effects(())
        if not core.is_linear:
            return ("the model itself",)
        return tuple(one.name for one in self._on if not core.with_effects((_as_states(one),)).is_linear)


_SECTIONS = 4
"""Of the Padé approximant of a command's delay: the phase of half a period is then right to 0.1°."""


def _as_states(effect: Effect) -> Effect:
    """An effect whose lags and delays are states of its own."""
    shifts = any(f"delay({INPUT}," in text.replace(" ", "") for text in effect.texts)
    return with_states(effect, _SECTIONS if shifts else 1)


JOINED = ("specimen position", "specimen speed", "specimen acceleration")
"""Channels of a machine whose specimen is joined to others, in addition to what is measured."""
FELT = "fx"
"""The symbol of what the others make it feel, N, where small signals are taken."""


@lru_cache(maxsize=64)
def joined(chain: Chain, felt: str = INTERACTION) -> Chain:
    """The chain whose specimen is pushed back by an interaction `felt` (N), an input or a symbol, and shows its motion.

    S = … + E, with E what the specimens of other actuators make it feel.
    """
    stages = tuple(_pushed(one, felt) if one.place == MASS_SPRING_DAMPER.place else one for one in chain.stages)
    own = "a" if "a" in chain.units else "vL"
    shown = dict(zip(JOINED, ("xL", "vL", own), strict=True))
    return replace(chain, stages=stages, outputs={**chain.outputs, **shown})


def _pushed(load: Stage, felt: str) -> Stage:
    own = next(equation for equation in load.equations if equation.target == "S")
    return load.with_equations((f"S = {own.python} + {felt}", f"{own.meaning}; what joins it to others"))


def machine(fit: FitResult, case: Case, effects: Mapping[str, float] | None = None) -> Machine:
    """The machine of a fit with the specimen of a case; `effects` are values of further ones by name, SI.

    Raises Unusable where the model has no command that moves a displacement, or the specimen's inertia has no place.
    """
    added = tuple(name.partition(".")[0] for name in effects or {})
    preset = preset_with(
        fit.model, tuple({**dict.fromkeys(fit.effects), **dict.fromkeys(added)}), fit.settings.get("custom", ())
    )
    if preset.kind != "chain" or preset.data.driven_by != "command" or DISPLACEMENT not in preset.chain.outputs:
        raise Unusable(
            "no-answer",
            f"the model {fit.model} has no command that moves a displacement",
            "fit",
            "give the fit of an actuator",
        )
    if "Ps" in preset.core.symbols and case.supply_pressure is None:
        raise Unusable(
            "not-stated", "this model depends on the supply pressure", "case supply_pressure", "state it, with its unit"
        )
    preset = _with_specimen(preset, case)
    values = {p.in_equations: p.value for effect in preset.effects for p in effect.added}
    values |= {preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    values |= {preset.parameter(name).in_equations: value for name, value in (effects or {}).items()}
    values |= _stated(preset, fit, case)
    if missing := sorted(set(preset.chain.symbols) - values.keys() - _conditions(case).keys()):
        raise Unusable("bad-fit", f"no value of {', '.join(missing)}", "fit", f"give a fit of model {fit.model}")
    return Machine(preset.chain, values, preset.steps, preset.parameters)


def actuator(case: Case) -> Actuator:
    """What the case states of the actuator."""
    return Actuator("hybrid", piston_area=case.piston_area, supply_pressure=case.supply_pressure)


def _conditions(case: Case) -> dict[str, float]:
    run = Run("hybrid", "", case.sample_rate, {}, specimen=case.physical, gain=case.gain)
    return conditions(run, actuator(case))


def _stated(preset: Preset, fit: FitResult, case: Case) -> dict[str, float]:
    """What the fit knew beforehand and does not hold: its piston area, and gains that its model states."""
    found = dict(preset.data.gains)
    ratios = {name for name, _ in (preset.without_area or {}).values()}
    if "A" in preset.chain.symbols:
        known = case.piston_area or preset.search.bounds_hold_for
        if not ratios & set(fit.parameters) and known is None:
            raise Unusable("missing-area", "the fit was made with a piston area", "case piston_area", "state it")
        found["A"] = 1.0 if ratios & set(fit.parameters) or known is None else known
    return found


def _with_specimen(preset: Preset, case: Case) -> Preset:
    """The model whose channel of force is that on the specimen."""
    chain = preset.chain
    if "F" in chain.units:
        return replace(preset, chain=replace(chain, outputs={**chain.outputs, FORCE: "F"}))
    if case.physical.mass:
        raise Unusable(
            "no-inertia",
            f"the model {preset.name} has no force that would move a mass",
            "physical mass",
            "leave the mass to the numerical part, or take a model with a load",
        )
    stages = tuple(_beside(one) if one.place == MASS_SPRING_DAMPER.place else one for one in chain.stages)
    return replace(preset, chain=replace(chain, stages=stages, outputs={**chain.outputs, FORCE: "F"}))


def _beside(load: Stage) -> Stage:
    publishes, equations = (*load.publishes, *_SPECIMEN.publishes), (*load.equations, *_SPECIMEN.equations)
    return Stage(load.place, publishes, equations, load.parameters, load.scales)
