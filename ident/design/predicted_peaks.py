"""What a command would ask of a machine: the largest peaks over the corners of what its parameters may be.

A linear machine at rest answers the command u by y(t) = ∫ G(jω) U(jω) exp(jωt) dω/2π, where G has the poles of its
state matrices. One that is not linear is simulated, at the corners that make most of its linear part, and with its
effects at both ends of their spread.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy  # fft, which takes some time to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.chain.chain import Chain
from ident.chain.conditions import conditions
from ident.custom.definition import preset_with
from ident.design.spread import Spread, corners
from ident.effects.effect import usual_shapes
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
from ident.presets import Preset
from ident.rig.motion import commanded_peaks
from ident.run import Run
from ident.simulation.simulate import responses
from ident.simulation.steps import fastest_mode, steps_needed

Array = NDArray[np.float64]
_POWER = 1e-7  # of the power of the command's acceleration: lines above the frequency that leaves it are left out
_OVERSAMPLED = 8  # points for each period of the highest line: a peak between them is missed by 8 % at most
_PADDED = 1.0  # s at rest behind the command, in which the answer dies out
_NEAR = 0.8  # of the largest RMS over the corners: a corner below it has no larger peak
_GROWING = 1e-6  # of the fastest pole, 1/s: above it a pole is unstable, below it a position that nothing holds
_SIMULATED = 2  # corners for each limit at which a machine that is not linear is simulated


@dataclass(frozen=True)
class Peaks:
    """The largest sizes over the corners, by the name of the limit, SI; `stable` is false where a corner runs away.

    With `linear` they grow in proportion to the command.
    """

    sizes: Mapping[str, float]
    stable: bool = True
    linear: bool = True

    def times(self, factor: float) -> Peaks:
        """Those of the command times a factor."""
        return replace(self, sizes={name: factor * size for name, size in self.sizes.items()})


@dataclass(frozen=True, eq=False)
class UncertainMachine:
    """A chain with `values` by the equations' names, SI, each of which may be off by its half-width."""

    preset: Preset
    values: Mapping[str, float]
    half_widths: Mapping[str, float]
    actuator: Actuator
    seed: int = 0

    @cached_property
    def signals(self) -> dict[str, tuple[str, int]]:
        """For each limit that the model tells of, the signal and how often it is differentiated."""
        units, outputs = self.preset.chain.units, self.preset.chain.outputs
        x = "x" if units.get("x") == "m" else outputs.get("displacement", "")
        found = {"stroke": (x, 0), "speed": (x, 1), "acceleration": (x, 2)} if x else {}
        if units.get("v") == "m/s":
            found |= {"speed": ("v", 0), "acceleration": ("v", 1)}
        if units.get("D") == "N":
            found["force"] = ("D", 0)
        if self.actuator.piston_area is not None:
            sized = {"flow": ("Q", "m^3/s"), "supply_pressure": ("P", "Pa")}
            found |= {limit: (name, 0) for limit, (name, unit) in sized.items() if units.get(name) == unit}
        return found

    @property
    def is_linear(self) -> bool:
        """Whether peaks grow in proportion to the command."""
        return not self.preset.effects and self.preset.chain.is_linear

    def _chain(self, chain: Chain) -> Chain:
        """The chain that shows every signal which is looked at."""
        return replace(chain, outputs={name: name for name, _ in self.signals.values()})

    def _symbols(self, chain: Chain, run: Run, off: Mapping[str, Array]) -> dict[str, Array]:
        """The values of a chain's symbols (c,) at the corners."""
        known = conditions(run, self.actuator) | dict(self.values)
        count = len(next(iter(off.values()), np.zeros(1)))
        return {name: known[name] + off.get(name, np.zeros(count)) for name in chain.symbols}

    def peaks(self, run: Run) -> Peaks:
        """The peaks of a run that begins and ends at rest, over the corners."""
        off, found = self._linear(run)
        return self._with_flow(found.worst if self.is_linear else self._simulated(run, off, found))

    def linear_peaks(self, run: Run) -> Peaks:
        """The same of the linear part alone, which takes no simulation."""
        return self._with_flow(self._linear(run)[1].worst)

    def _linear(self, run: Run) -> tuple[dict[str, Array], _Corners]:
        """The deviations at the corners, and the peaks of the linear part there."""
        core = self._chain(self.preset.core)
        off = corners({name: w for name, w in self.half_widths.items() if name in core.symbols}, self.seed)
        return off, _linear_peaks(core, self._symbols(core, run, off), self.signals, run)

    def _with_flow(self, peaks: Peaks) -> Peaks:
        """With the flow that moves the piston, where the model has none of its own."""
        area = self.actuator.piston_area
        if area is None or "flow" in peaks.sizes or "speed" not in peaks.sizes:
            return peaks
        return replace(peaks, sizes={**peaks.sizes, "flow": area * peaks.sizes["speed"]})

    def _simulated(self, run: Run, off: Mapping[str, Array], linear: _Corners) -> Peaks:
        """The peaks by simulation: the fitted machine, and the worst corners with the effects at either end."""
        worst = list(dict.fromkeys(linear.worst_corners))
        of_effects = {p.in_equations for effect in self.preset.effects for p in effect.added} & self.half_widths.keys()
        lanes = [(0, 0.0), *((corner, sign) for corner in worst for sign in (-1.0, 1.0))]
        deviations = {name: np.array([values[corner] for corner, _ in lanes]) for name, values in off.items()}
        deviations |= {name: self.half_widths[name] * np.array([sign for _, sign in lanes]) for name in of_effects}
        chain = self._chain(self.preset.chain)
        symbols = self._symbols(chain, run, deviations or {"": np.zeros(len(lanes))})
        steps = self._steps(chain, symbols, run)
        answers: dict[str, Array] = {}
        with np.errstate(all="ignore"):
            for name, _ in self.signals.values():
                if name not in answers:
                    shown = replace(run, output=name, channels={**run.channels, name: np.zeros(len(run.command))})
                    wide = {key: value[None, :] for key, value in symbols.items()}
                    answers[name] = responses(chain, [shown], wide, steps)[:, 0, :]
            sizes = {
                limit: float(np.abs(_differences(answers[name], order, run.sample_rate)).max(initial=0.0))
                for limit, (name, order) in self.signals.items()
            }
        return Peaks(sizes, all(np.isfinite(size) for size in sizes.values()), linear=False)

    def _steps(self, chain: Chain, symbols: Mapping[str, Array], run: Run) -> int:
        """Into how many steps a sample is divided."""
        output = next(iter(chain.outputs))
        fastest = fastest_mode(chain, symbols, output) / run.sample_rate
        return int(steps_needed(chain, fastest, run.hold, chain.effects, kinks=self.preset.steps).max())


def _differences(samples: Array, order: int, rate: float) -> Array:
    return np.diff(samples, order, axis=0) * rate**order


@dataclass(frozen=True)
class _Corners:
    """The peaks of a linear machine, and which corners make the most of each."""

    worst: Peaks
    worst_corners: tuple[int, ...]


def _linear_peaks(
    chain: Chain, symbols: Mapping[str, Array], signals: Mapping[str, tuple[str, int]], run: Run
) -> _Corners:
    """The peaks of a chain's linear part at the corners that `symbols` (c,) are."""
    models = {name: chain.linearise(symbols, name) for name in dict.fromkeys(name for name, _ in signals.values())}
    model = next(iter(models.values()))
    poles, modes = np.linalg.eig(model.A)
    with np.errstate(all="ignore"):
        drive = np.linalg.solve(modes, model.B[..., None].astype(complex))[..., 0]
    if np.any(poles.real > _GROWING * np.abs(poles).max()) or not np.all(np.isfinite(drive)):
        return _Corners(Peaks(dict.fromkeys(signals, np.inf), stable=False), (0,))
    frequency, lines, points = _lines(run.command, run.sample_rate)
    s = 2j * np.pi * frequency
    with np.errstate(all="ignore"):
        each = drive[..., None] / (s - poles[..., None])  # (c, n, f): the modes' answers
    each = np.where(np.isfinite(each), each, 0.0)  # at rest what integrates is where it is
    sizes, worst = {}, []
    for limit, (name, order) in signals.items():
        shown = np.einsum("cn,cnf->cf", np.einsum("cn,cnm->cm", models[name].C, modes), each)
        answer = (shown + models[name].D[..., None]) * s**order * lines
        power = np.sum(np.abs(answer) ** 2, axis=-1)
        near = np.flatnonzero(power >= _NEAR**2 * power.max())
        waves = scipy.fft.irfft(answer[near], points) * points
        tops = np.abs(waves).max(axis=-1)
        sizes[limit] = float(tops.max())
        worst += near[np.argsort(-tops)[:_SIMULATED]].tolist()
    return _Corners(Peaks(sizes), tuple(worst))


def _lines(command: Array, rate: float) -> tuple[Array, NDArray[np.complex128], int]:
    """The frequencies (f,) and lines (f,) of a command that is followed by rest, and the points that show its peaks."""
    padded = np.concatenate([command, np.zeros(min(len(command), round(_PADDED * rate)))])
    lines = np.fft.rfft(padded) / len(padded)
    frequency = np.fft.rfftfreq(len(padded), 1 / rate)
    power = np.cumsum((np.abs(lines) * frequency**2) ** 2)
    kept = min(int(np.searchsorted(power, (1 - _POWER) * power[-1])) + 2, len(lines))
    points = int(scipy.fft.next_fast_len(min(_OVERSAMPLED * kept, len(padded)), real=True))
    return np.asarray(frequency[:kept], float), lines[:kept], points


def uncertain_machine(fit: FitResult, spread: Spread, like: Run, actuator: Actuator | None = None) -> UncertainMachine:
    """The machine of a fit, driven as the run `like`; `actuator` is what is stated of it where the fit says nothing.

    Raises Unusable where its model answers no command, or a value is missing.
    """
    named = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    if named.kind != "chain" or named.data.driven_by != "command":
        raise Unusable("no-answer", f"the model {fit.model} answers no command", "fit", "give the fit of an actuator")
    ratios = {name for name, _ in (named.without_area or {}).values()} & set(fit.parameters)
    stated = fit.actuator or actuator or Actuator("")
    area = None if ratios else stated.piston_area or named.search.bounds_hold_for
    stated = replace(stated, piston_area=area)
    preset, _ = named.for_matrix(Matrix(stated, (like,)))
    values = dict(preset.data.gains) | usual_shapes(named.effects)
    values |= {preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    if missing := [p.name for p in preset.parameters if p.in_equations not in values]:
        raise Unusable("bad-fit", f"no value of {', '.join(missing)}", "fit", f"give a fit of model {fit.model}")
    own = {p.in_equations for p in preset.parameters}
    widths = {name: width for name, width in spread.half_widths(fit, preset).items() if name in own}
    return UncertainMachine(preset, values, widths, stated)


def peaks_of_command(run: Run, actuator: Actuator) -> Peaks:
    """What the command alone tells, as if the machine followed it exactly: motion, the specimen's force, piston flow.

    Of a command that is no way nothing is told.
    """
    if run.units.get("command", "m") != "m":
        return Peaks({})
    sizes, specimen = commanded_peaks(run.command, run.sample_rate), run.specimen
    if specimen is not None:
        speed = np.gradient(run.command) * run.sample_rate
        force = specimen.mass * np.gradient(speed) * run.sample_rate + specimen.damping * speed
        sizes["force"] = float(np.abs(force + specimen.stiffness * run.command).max())
    if actuator.piston_area is not None:
        sizes["flow"] = actuator.piston_area * sizes["speed"]
        if "force" in sizes:
            sizes["supply_pressure"] = sizes["force"] / actuator.piston_area
    return Peaks(sizes)
