"""An identified machine of another size, or with another specimen: what scales with what, and its linear model.

The flow gain Z0 is the gain of the valve times the piston area, so Z0 ∝ A; the compressibility Ka = Vt/(4 βe) goes
with the oil volume, so Ka ∝ A × stroke where no volume is named (Qian et al. 2014, eqs. 4, 8). All else is
carried over.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.custom.definition import preset_with
from ident.effects import CATALOGUE
from ident.effects.effect import Effect
from ident.errors import Unusable
from ident.fit.bulk_modulus import COMPRESSIBILITY
from ident.fit.result import FitResult
from ident.hybrid.lags_as_states import with_states
from ident.linear import LinearModel
from ident.matrix import Actuator
from ident.parameter import Parameter
from ident.presets.preset import Preset
from ident.run import Run, Specimen
from ident.stability.loop import SHORTEST
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
FLOW_GAIN = "m^4/s"
"""The unit of the flow gain that has the piston area in it."""
DELAY_SECTIONS = 4
"""Of the Padé approximant of a delay: see :func:`ident.hybrid.lags_as_states.with_states`."""
SIZES = {"area": "area", "stroke": "length", "volume": "volume"}
"""What may be changed of a cylinder, with its dimension."""
_CATALOGUE = frozenset(effect.name for effect in CATALOGUE)
_FIELDS = {"area": "piston_area", "stroke": "stroke", "volume": "volume"}


@dataclass(frozen=True)
class Change:
    """What is to be changed, SI: `sizes` of the cylinder (:data:`SIZES`), `values` of parameters by name.

    `specimen` is what the machine moves then, nothing where it has no mass, stiffness or damping. `known` are sizes of
    the machine that was fitted which its fit does not hold.
    """

    sizes: Mapping[str, float] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    specimen: Specimen = field(default_factory=Specimen)
    known: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Carried:
    """One parameter before and after the change, in `unit`, and by what it changed, in words."""

    unit: str
    before: float
    after: float
    why: str


@dataclass(frozen=True)
class ChangedMachine:
    """The machine after a change. `parameters` are by name, SI; `left_out` the effects that have no linear response."""

    preset: Preset
    parameters: Mapping[str, Carried]
    actuator: Actuator
    specimen: Specimen
    left_out: tuple[str, ...] = ()

    @cached_property
    def chain(self) -> Chain:
        """The equations, lags and delays of effects as states; of those that are on, before or after the change."""
        on = (effect for effect in self.preset.effects if self._is_on(effect))
        return self.preset.core.with_effects(tuple(with_states(effect, DELAY_SECTIONS) for effect in on))

    def _is_on(self, effect: Effect) -> bool:
        strength = self.parameters.get(effect.added[0].name)
        return strength is None or bool(strength.before or strength.after)

    @property
    def output(self) -> str:
        """The channel whose response is shown: the first that the model has."""
        return next(iter(self.chain.outputs))

    @property
    def has_gain(self) -> bool:
        """Whether there is a loop with a gain Kp."""
        return "Kp" in self.chain.symbols

    @cached_property
    def values(self) -> dict[str, float]:
        """Every symbol of the equations but Kp, SI."""
        known = conditions(Run("what if", "", 1.0, {}, specimen=self.specimen), self.actuator)
        known |= {self.preset.parameter(name).in_equations: entry.after for name, entry in self.parameters.items()}
        known |= {p.in_equations: max(known[p.in_equations], SHORTEST) for p in self._times}
        return {symbol: known[symbol] for symbol in self.chain.symbols}

    @property
    def _times(self) -> tuple[Parameter, ...]:
        """The strengths of effects that are times, by which states divide."""
        return tuple(effect.added[0] for effect in self.preset.effects if effect.strength.unit == "s")

    def linear(self, gain: Array, factors: Mapping[str, Array] | None = None) -> LinearModel:
        """The linearised chain at gains Kp; parameters named in `factors` are that many times as large.

        All arrays broadcast to the shape of the batch.
        """
        values: dict[str, Array | float] = {**self.values, **({"Kp": gain} if self.has_gain else {})}
        for name, factor in (factors or {}).items():
            symbol = self.preset.parameter(name).in_equations
            values[symbol] = self.values[symbol] * factor
        shape = np.broadcast_shapes(np.shape(gain), *(np.shape(value) for value in values.values()))
        with np.errstate(all="ignore"):
            model = self.chain.linearise({name: np.broadcast_to(v, shape) for name, v in values.items()}, self.output)
        if not all(np.isfinite(matrix).all() for matrix in (model.A, model.B, model.C, model.D)):
            raise Unusable(
                "out-of-range",
                "the equations of the changed machine leave the range of a computer",
                "set",
                "correct the values",
            )
        return model


def changed_machine(fit: FitResult, change: Change) -> ChangedMachine:
    """The machine of a fit after a change.

    Raises Unusable for a model without a chain, a name that is none of its parameters or sizes, a value that is not
    positive where it must be, and where something would have to scale with a size that is not known.
    """
    custom = tuple(fit.settings.get("custom", ()))
    effects = tuple(dict.fromkeys((*fit.effects, *_added(change.values))))
    whole = preset_with(fit.model, effects, custom)
    if whole.kind != "chain":
        raise Unusable(
            "no-what-if",
            f"{fit.model} is fitted to records of a bench",
            "fit",
            "give a regulator, for the margins of its position loop, or a fit of test runs",
        )
    kept = tuple(name for name in effects if _is_linear(preset_with(fit.model, (name,), custom)))
    before = _known(fit, change.known)
    after = _resized(before, change.sizes)
    scaled = _scaled(fit, whole, before, after, change)
    preset = preset_with(fit.model, kept, custom)
    own = {p.in_equations for p in preset.parameters}
    parameters = {name: entry for name, entry in scaled.items() if whole.parameter(name).in_equations in own}
    left_out = tuple(name for name in effects if name not in kept)
    return ChangedMachine(preset, parameters, after, change.specimen, left_out)


def model_of(fit: FitResult, values: Iterable[str]) -> Preset:
    """The model of a fit, with the effects of the catalogue that the names of values, ``effect.parameter``, add."""
    custom = tuple(fit.settings.get("custom", ()))
    return preset_with(fit.model, tuple(dict.fromkeys((*fit.effects, *_added(values)))), custom)


def _added(values: Iterable[str]) -> Iterator[str]:
    """The effects that parameters belong to, where the catalogue has them."""
    return (effect for name in values if (effect := name.partition(".")[0]) in _CATALOGUE and "." in name)


def _is_linear(preset: Preset) -> bool:
    return preset.core.with_effects(tuple(with_states(effect) for effect in preset.effects)).is_linear


def _known(fit: FitResult, stated: Mapping[str, float]) -> Actuator:
    """The machine that was fitted, with what is stated of it beside its fit."""
    actuator = fit.actuator or Actuator("")
    for name, value in stated.items():
        there = getattr(actuator, _FIELDS[name])
        if there is not None and not np.isclose(there, value, rtol=1e-6):
            raise Unusable(
                "two-sizes",
                f"the fit was made with {name} {there:.6g}, not {value:.6g}",
                f"fitted {name}",
                "change it instead, or fit again",
            )
    if "area" in stated and any("A^" in name for name in fit.parameters):
        raise Unusable(
            "missing-area",
            "the fit knows only ratios to the piston area",
            "fitted area",
            "state piston_area in matrix.yaml and fit again",
        )
    return _with_sizes(actuator, stated)


def _with_sizes(actuator: Actuator, sizes: Mapping[str, float]) -> Actuator:
    return replace(
        actuator,
        piston_area=sizes.get("area", actuator.piston_area),
        stroke=sizes.get("stroke", actuator.stroke),
        volume=sizes.get("volume", actuator.volume),
    )


def _resized(before: Actuator, sizes: Mapping[str, float]) -> Actuator:
    """The machine with the new sizes; a volume that is stated goes with area × stroke unless it is named."""
    for name, value in sizes.items():
        if not (np.isfinite(value) and value > 0):
            raise Unusable("bad-size", f"{name} is {value:g}", f"set {name}", "give a size above 0")
    after = _with_sizes(before, sizes)
    if "volume" not in sizes and before.volume is not None and sizes:
        after = replace(after, volume=before.volume * _ratio(before, after, ("area", "stroke"), sizes))
    return after


def _ratio(before: Actuator, after: Actuator, names: tuple[str, ...], sizes: Mapping[str, float]) -> float:
    """How many times as large the product of these sizes is; raises Unusable where one was not known."""
    ratio = 1.0
    for name in names:
        if name in sizes:
            old = getattr(before, _FIELDS[name])
            if old is None:
                raise Unusable(
                    "missing-size",
                    f"{name} is to change, but the fit does not hold what it was",
                    f"set {name}",
                    f"state it of the fitted machine (--fitted {name}=…)",
                )
            ratio *= getattr(after, _FIELDS[name]) / old
    return ratio


def _scaled(fit: FitResult, preset: Preset, before: Actuator, after: Actuator, change: Change) -> dict[str, Carried]:
    """Every parameter of the fit, scaled, carried over, or as it was set."""
    named = {preset.parameter(name).in_equations: value for name, value in change.values.items()}
    fitted = {preset.parameter(name).in_equations for name in fit.parameters}
    added = {p.in_equations: p for effect in preset.effects if effect.name not in fit.effects for p in effect.added}
    if strange := [name for name in change.values if preset.parameter(name).in_equations not in fitted | added.keys()]:
        raise Unusable(
            "unknown-parameter",
            f"the fit has no parameter {strange[0]!r}",
            "set",
            did_you_mean(strange[0], (*SIZES, *fit.parameters)),
        )
    found = {}
    for name, entry in fit.parameters.items():
        symbol = preset.parameter(name).in_equations
        if symbol in named:
            if not np.isfinite(named[symbol]) or named[symbol] <= 0 < entry.lower:
                raise Unusable("bad-number", f"{name} is {named[symbol]:g}", f"set {name}", "give a value above 0")
            found[name] = Carried(entry.unit, entry.value, named[symbol], "as set")
            continue
        factor, why = _factor(entry.unit, before, after, change.sizes)
        found[name] = Carried(entry.unit, entry.value, entry.value * factor, why)
    for symbol, one in added.items():
        found[one.name] = Carried(one.unit, one.value, named.get(symbol, one.value), "as set, an effect more")
    return found


def _factor(unit: str, before: Actuator, after: Actuator, sizes: Mapping[str, float]) -> tuple[float, str]:
    """What a parameter of this unit is multiplied by, and why."""
    if unit == FLOW_GAIN and "area" in sizes:
        return _ratio(before, after, ("area",), sizes), "∝ A"
    if unit == COMPRESSIBILITY and "volume" in sizes:
        return _ratio(before, after, ("volume",), sizes), "∝ volume"
    if unit == COMPRESSIBILITY and {"area", "stroke"} & set(sizes):
        return _ratio(before, after, ("area", "stroke"), sizes), "∝ A × stroke"
    return 1.0, "carried over"
