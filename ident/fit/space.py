"""The space of a search: a unit cube, each axis one parameter between its bounds, and the way to SI values."""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.effects.needs import shows_oil
from ident.equations.equation import Equation
from ident.errors import Unusable
from ident.fit.criteria import FIT_CRITERIA
from ident.fit.parameter_bounds import of_model
from ident.fit.run_sizes import measured_by
from ident.fit.run_sizes import run_sizes as sizes_of
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.presets import Preset
from ident.presets.convention import Convention, of_runs
from ident.rounding import TINY
from ident.run import Run
from ident.simulation.steps import FASTEST

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Axis:
    """One parameter's range: value = scale × ratio, the ratio between `lower` and `upper`."""

    name: str
    lower: float
    upper: float
    logarithmic: bool
    scale: Equation | None = None  # None: the ratio is the value itself, in SI


@dataclass(frozen=True)
class Space:
    """Axes searched, values held fixed, and what the axes' scales may read.

    `convention` names a parameter that no run can determine (without a specimen of known mass only ratios to the mass
    are seen): it is held at `fixed` and reported as undetermined; so is what `conventions` hold.
    `followed`: only models whose modes a simulation follows at the sample time are searched; where the user says where
    to look, all that are there.
    """

    axes: tuple[Axis, ...]
    order: tuple[str, ...]
    fixed: Mapping[str, float]
    typical: Mapping[str, float]
    convention: str | None = None
    conventions: tuple[Convention, ...] = ()
    scale_free: bool = False
    followed: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the searched parameters, one an axis."""
        return tuple(axis.name for axis in self.axes)

    @cached_property
    def spans(self) -> Array:
        """ln(upper/lower) of each logarithmic axis, 0 of a linear one, (p,)."""
        return np.array([float(np.log(axis.upper / axis.lower)) if axis.logarithmic else 0.0 for axis in self.axes])

    def values(self, points: Array) -> dict[str, Array]:
        """SI values of every parameter at points of the unit cube: (v, p) → name: (v,)."""
        known: dict[str, Array] = {name: np.full(len(points), value) for name, value in self.fixed.items()}
        axes = {axis.name: (axis, points[:, i]) for i, axis in enumerate(self.axes)}
        for name in self.order:
            if name in axes:
                axis, u = axes[name]
                known[name] = _ratio(axis, u) * _scale(axis, known, self.typical)
        return known

    def point(self, values: Mapping[str, float]) -> Array:
        """The point of the cube that has these values, (p,); outside the bounds it is clipped onto them."""
        known = {name: np.array(value) for name, value in values.items()}
        point = np.empty(len(self.axes))
        for i, axis in enumerate(self.axes):
            ratio = float(known[axis.name] / _scale(axis, known, self.typical))
            if axis.logarithmic:
                point[i] = np.log(max(ratio / axis.lower, TINY)) / np.log(axis.upper / axis.lower)
            else:
                point[i] = (ratio - axis.lower) / (axis.upper - axis.lower)
        return np.clip(point, 0.0, 1.0)

    def at_bound(self, name: str, point: Array) -> bool:
        """Whether a searched parameter ended at a bound of its axis."""
        edge = FIT_CRITERIA.optima.edge
        return not edge < float(point[self.names.index(name)]) < 1 - edge

    def bounds(self, values: Mapping[str, float]) -> dict[str, tuple[float, float]]:
        """Lower and upper SI bound of each searched parameter, the others being at `values`."""
        known = {name: np.array(value) for name, value in values.items()}
        scales = {axis.name: float(_scale(axis, known, self.typical)) for axis in self.axes}
        return {axis.name: (axis.lower * scales[axis.name], axis.upper * scales[axis.name]) for axis in self.axes}

    def reach(self, name: str, values: Mapping[str, float]) -> tuple[float, float]:
        """Lower and upper bound of a parameter, SI; both are its value where that is held."""
        return (self.fixed[name],) * 2 if name in self.fixed else self.bounds(values)[name]


def _ratio(axis: Axis, u: Array) -> Array:
    """The ratio at places of an axis. Within the axis it is within the bounds, which rounding alone would leave.

    A difference quotient at a bound asks for places outside of the axis: there the ratio goes on.
    """
    if axis.logarithmic:
        ratio = axis.lower * (axis.upper / axis.lower) ** u
    else:
        ratio = axis.lower + (axis.upper - axis.lower) * u
    return np.where((u >= 0) & (u <= 1), np.clip(ratio, axis.lower, axis.upper), ratio)


def _scale(axis: Axis, known: Mapping[str, Array], typical: Mapping[str, float]) -> Array:
    if axis.scale is None:
        return np.array(1.0)
    names = {name: known[name] if name in known else typical[name] for name in axis.scale.names}
    return np.asarray(axis.scale.value(names))


def search_space(preset: Preset, matrix: Matrix, settings: Settings, band: float) -> Space:
    """What to search for this machine.

    The bounds of the preset hold for the machine they were stated for: the same piston area, with gain and specimen
    of every run known. Any other machine is searched over scale-free ratios, without modes so fast for the sample time
    that they could not be followed. Bounds and values of the user come first, those of effects that the preset does
    not have are left out.
    """
    settings = of_model(settings, preset)
    runs = matrix.of_use("fit")
    given = {preset.parameter(name).in_equations: bounds for name, bounds in settings.bounds.items()}
    fixed = {preset.parameter(name).in_equations: value for name, value in settings.fixed.items()}
    area, known_for = matrix.actuator.piston_area, preset.search.bounds_hold_for
    same = known_for is not None and area is not None and abs(area / known_for - 1) < FIT_CRITERIA.ranges.same_area
    same = same and _stated(preset, runs)
    if all(run.stepped for run in runs):
        band /= FIT_CRITERIA.ranges.of_steps
    typical = sizes_of(matrix, runs, band)
    if preset.data.driven_by == "velocity":
        typical["V"] = typical["U"]  # the speed is prescribed, whether it was recorded or not
    force = _acting(runs, "force" if settings.load == "force" else "load_disturbance")
    if force:  # a mass that would need it
        typical["mL"] = force / (typical["V"] * band)
    of_effects = [p for effect in preset.effects for p in effect.added]
    known = _held(preset, typical) | {name: value for name, value in preset.data.gains.items() if name != "Kp"}
    fixed = {name: value for name, value in known.items() if name not in given} | fixed
    convention = None
    forced = force or preset.data.driven_by != "command"
    scales = preset.scales_by(_scaled_by(matrix, runs))
    free = {scale.name for scale in scales} - fixed.keys() - given.keys()
    if free & set(preset.data.share_force[:1]) and not (same or forced or _loaded(runs)):
        convention = preset.data.share_force[0]
        fixed[convention] = typical["mL"]
    held = tuple(one for one in of_runs(preset.data.conventions, runs) if not {*one.held} & {*fixed, *given})
    fixed = {name: value for one in held for name, value in one.held.items()} | fixed
    axes, fastest = [], FASTEST * min(run.sample_rate for run in runs)
    for scale in scales:
        if scale.name in fixed:
            continue
        if scale.name in given or same:
            parameter = preset.parameter(scale.name)
            lower, upper = given.get(scale.name, (parameter.lower, parameter.upper))
            parameter = parameter.within(lower, upper)
            axes.append(Axis(scale.name, lower, upper, parameter.logarithmic))
        else:
            axes.append(Axis(scale.name, *scale.slower_than(fastest / band), scale.logarithmic, scale.equation))
    of_any_sign = {*preset.crossing, *(name for one in held for name in one.held)}
    _refuse_bad_values(fixed, {p.in_equations for p in of_effects} | known.keys() | of_any_sign)
    order = tuple(scale.name for scale in scales)
    bounded = {*settings.bounds, *settings.fixed} - {p.name for p in of_effects}
    return Space(tuple(axes), order, fixed, typical, convention, held, not same, not (same or bounded))


def _scaled_by(matrix: Matrix, runs: tuple[Run, ...]) -> str:
    """The channel whose scales hold; "", a pressure's, for a speed where nothing shows oil.

    There a drive behind a spring would pass for a cylinder: both are of third order.
    """
    channel = measured_by(runs)
    return channel if channel != "velocity" or shows_oil(runs, matrix.actuator.states_oil) else ""


def _held(preset: Preset, typical: Mapping[str, float]) -> dict[str, float]:
    """What is held of effects where no bound or value is given: shapes, and the strength of what is there wholly."""
    whole = {effect.added[0].in_equations: effect.strength.upper for effect in preset.effects if effect.whole}
    return whole | {
        p.in_equations: p.relative * typical["L"] if p.relative and preset.search.relative_ways else p.value
        for effect in preset.effects
        for p in effect.added[1:]
        if not p.searched
    }


def _stated(preset: Preset, runs: tuple[Run, ...]) -> bool:
    """Whether of every run all is stated that its model reads: the gain of a loop, and what the machine moves."""
    loop, load = preset.chain.reads("Kp"), not preset.data.alone
    return all(not (loop and run.gain is None) and not (load and run.specimen is None) for run in runs)


def _loaded(runs: tuple[Run, ...]) -> bool:
    """True where a specimen's known mass, spring or damper gives forces a scale."""
    return any(run.specimen is not None and run.specimen.scales_forces for run in runs)


def _acting(runs: tuple[Run, ...], channel: str) -> float:
    """The deviation of a force that was measured, over the runs that have it."""
    found = [float(np.std(run.channels[channel])) for run in runs if channel in run.channels]
    return float(np.mean(found)) if found else 0.0


def _refuse_bad_values(fixed: Mapping[str, float], of_effects: AbstractSet[str]) -> None:
    for name, value in fixed.items():
        if not np.isfinite(value) or (value <= 0 and name not in of_effects):
            raise Unusable("bad-value", f"{name} = {value:g}", "values held fixed", "give a positive finite value")
