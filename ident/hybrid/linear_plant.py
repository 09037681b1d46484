"""The servo loop that a controller acts on: an identified chain with a specimen and a gain, command → displacement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain
from ident.chain.conditions import NEVER
from ident.custom.definition import preset_with
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.lags_as_states import with_states
from ident.linear import LinearModel
from ident.parameter import Parameter
from ident.presets import Preset
from ident.run import Specimen

Array = NDArray[np.float64]
OUTPUT = "displacement"


@dataclass(frozen=True)
class LinearPlant:
    """A fitted chain under fixed conditions: its linear part, its values by the equations' names, who is left out.

    `names` maps a parameter's name to its name in the equations; `parameters` are those of its model.
    """

    chain: Chain
    values: Mapping[str, float]
    conditions: Mapping[str, float]
    names: Mapping[str, str]
    left_out: tuple[str, ...]
    parameters: tuple[Parameter, ...] = ()

    @property
    def known(self) -> dict[str, float]:
        """Every symbol of the equations with its value, SI."""
        return {**self.conditions, **self.values}

    @property
    def model(self) -> LinearModel:
        """The plant without a batch: of the states that the displacement depends on."""
        return self._linearised({})

    def drawn(self, draws: Mapping[str, Array]) -> tuple[LinearModel, ...]:
        """A plant for each of the values (count,) of parameters, by their names; the others stay as fitted."""
        batch = self._linearised({self.names[name]: values for name, values in draws.items()})
        return tuple(LinearModel(batch.system[..., i]) for i in range(batch.system.shape[-1]))

    def _linearised(self, changed: Mapping[str, Array]) -> LinearModel:
        known: dict[str, Array | float] = {**self.known, **changed}
        model = self.chain.linearise({name: known[name] for name in self.chain.symbols}, OUTPUT)
        off = {name for name, value in self.conditions.items() if value == 0}
        return model.of_states(self.chain.observed(OUTPUT, off))


def linear_plant(
    fit: FitResult,
    specimen: Specimen,
    gain: float | None = None,
    piston_area: float | None = None,
    supply_pressure: float | None = None,
) -> LinearPlant:
    """The linear part of a fit with this specimen, gain Kp and piston area (m²).

    Effects that are linear stay, their lags and delays as states; a linear design knows nothing of the others, which
    `left_out` names. A fit made without an area has ratios to it as parameters, and needs none. Raises Unusable where
    the model has no displacement that a command drives, and where the fit needs an area that is not given.
    """
    preset = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    if preset.kind != "chain" or preset.data.driven_by != "command" or OUTPUT not in preset.chain.outputs:
        raise Unusable(
            "no-answer",
            f"the model {fit.model} has no command that moves a displacement",
            "fit",
            "give the fit of an actuator",
        )
    names = {name: preset.parameter(name).in_equations for name in fit.parameters}
    values = {names[name]: value for name, value in fit.values.items()}
    written = {effect.name: with_states(effect) for effect in preset.effects}
    kept = tuple(
        effect
        for name, effect in written.items()
        if preset.core.with_effects((effect,)).is_linear and values.get(_strength(name, names), 1.0)
    )
    chain = preset.core.with_effects(kept)
    known = {
        "Kp": preset.data.gains.get("Kp", 1.0) if gain is None else gain,
        "mL": specimen.mass,
        "k": specimen.stiffness,
        "cL": specimen.damping,
        "A": _area(preset, fit, piston_area),
        "Ir": 1.0,
        "Ps": supply_pressure or NEVER,
    }
    if missing := sorted(set(chain.symbols) - values.keys() - known.keys()):
        raise Unusable("bad-fit", f"no value of {', '.join(missing)}", "fit", f"give a fit of model {fit.model}")
    left_out = tuple(name for name, effect in written.items() if effect not in kept)
    return LinearPlant(chain, values, known, names, left_out, preset.parameters)


def _area(preset: Preset, fit: FitResult, stated: float | None) -> float:
    """The piston area that belongs to the values of a fit, m²: 1 where these are ratios to it."""
    ratios = preset.without_area or {}
    if not any(name in fit.parameters for name in ratios):
        return 1.0
    if stated is None:
        raise Unusable(
            "missing-area",
            "the fit was made with a piston area, which the case does not state",
            "case piston_area",
            "state it, for example piston_area: 497 mm^2",
        )
    return stated


def _strength(effect: str, names: Mapping[str, str]) -> str:
    """The first parameter of an effect, its strength, by its name in the equations."""
    return next((symbol for name, symbol in names.items() if name.startswith(f"{effect}.")), "")
