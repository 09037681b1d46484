"""What moves inside the model in each run, beside the residual and the model's sensitivities, on the coarse clock."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import Chain, integrates, settles
from ident.chain.conditions import conditions
from ident.comparison.compare import Comparison, fitted
from ident.errors import Unusable
from ident.fit.normal_matrices import first_state
from ident.fit.simulated_runs import SimulatedRuns, every_run
from ident.linear import LinearModel
from ident.matrix import Actuator
from ident.parallel import each
from ident.presets import Preset
from ident.residuals.decimation import Response, averaged, stride
from ident.residuals.views import View, injected, showing
from ident.run import Run
from ident.simulation.simulate import Simulation

Array = NDArray[np.float64]
Band = tuple[float | None, float | None]
"""Lower and upper frequency (Hz), None where it is open."""
Item = TypeVar("Item")
Outcome = TypeVar("Outcome")
_MOST = 400_000  # coarse samples of all runs together; records are cut to their beginnings
_NUDGE = 1e-4  # relative, for sensitivities


@dataclass(frozen=True)
class Trace:
    """One run: residual (n,) in the output's unit, the sensitivities of the output (n, p), the signals by name (n,).

    `moved` holds the sensitivities of each signal (n, p): both are per relative change of a parameter.
    """

    run: Run
    rate: float
    residual: Array
    sensitivities: Array
    signals: Mapping[str, Array]
    moved: Mapping[str, Array]

    @property
    def alike(self) -> object:
        """What a linear response depends on."""
        return _alike(self.run, self.rate)


@dataclass(frozen=True)
class Traces:
    """All runs; `values` are those of the fit under the equations' names.

    `_paths` keeps the responses of the views that were asked for.
    """

    preset: Preset
    actuator: Actuator
    values: Mapping[str, float]
    chain: Chain
    runs: tuple[Trace, ...]
    parameters: tuple[str, ...]
    _paths: dict[str, list[Response]] = field(default_factory=dict, repr=False, compare=False)

    @property
    def units(self) -> Mapping[str, str]:
        """The unit of each parameter."""
        return {parameter.in_equations: parameter.unit for parameter in self.preset.parameters}

    def paths(self, view: View) -> list[Response]:
        """For each run the linear response from what is added at the view's place to the output and to its signals."""
        if view.name not in self._paths:
            self._paths[view.name] = self._found(view)
        return self._paths[view.name]

    def _found(self, view: View) -> list[Response]:
        broken = injected(self.chain, view.at)

        def one(trace: Trace) -> Response:
            names = (trace.run.output, *view.signals)
            models = [_linear(broken, self.values, trace.run, self.actuator, name) for name in names]
            return Response.of(models, trace.rate)

        known = _once({trace.alike: trace for trace in self.runs}, one)
        return [known[trace.alike] for trace in self.runs]


def _once(distinct: Mapping[object, Item], of: Callable[[Item], Outcome]) -> dict[object, Outcome]:
    """One answer for each key."""
    return dict(zip(distinct, each(of, distinct.values()), strict=True))


def traces(comparison: Comparison, signals: Sequence[str], instead: Mapping[str, Array] | None = None) -> Traces:
    """The traces of every compared run that the linear core is stable for.

    `instead` gives, by the run's id, outputs that take the place of the measured ones. Raises Unusable where no run
    is left.
    """
    preset, matrix, values = fitted(comparison.fit, comparison.matrix)
    chain = showing(preset.core, tuple(signals))
    outputs = {run.run.id: run.modelled for run in comparison.runs}
    runs = tuple(run for run in matrix.runs if run.id in outputs and np.all(np.isfinite(outputs[run.id])))
    known = [run for run in runs if settles(chain, values, run, matrix.actuator)]
    if not known and integrates(chain, runs, matrix.actuator):
        what = "the machine sums up what acts on it, so that no curve over whole runs shows one effect"
        raise Unusable("unstable-model", what, f"model {preset.name}", "see the error of each effect over windows")
    if not known:
        raise Unusable("unstable-model", "the model is unstable at every run", "fit", "fit it to these data first")
    count = stride(known)
    most = max(256, _MOST // len(known))
    measured = {run.id: run.measured if instead is None else instead[run.id] for run in known}
    inner = {} if preset.is_linear else _simulated(comparison, preset, tuple(signals), known)

    models = _once(
        {_alike(run, run.sample_rate / count): run for run in known},
        lambda run: _cores(chain, preset, values, run, matrix.actuator, tuple(signals), run.sample_rate / count),
    )

    def one(run: Run) -> Trace:
        residual = averaged(measured[run.id] - outputs[run.id], count)[:most]
        rate = run.sample_rate / count
        command = averaged(run.command, count)[:most, None]
        linear, moved, sensitivities = _moved(models[_alike(run, rate)], run, tuple(signals), command)
        shown = {name: averaged(inner[name][run.id], count)[:most] for name in inner} or linear
        first = _settled(run, residual, rate)
        cut = {name: samples[first:] for name, samples in shown.items()}
        steps = {name: samples[first:] for name, samples in moved.items()}
        return Trace(run, rate, residual[first:], sensitivities[first:], cut, steps)

    return Traces(preset, matrix.actuator, values, chain, tuple(each(one, known)), _searched(chain, preset, values))


def _settled(run: Run, residual: Array, rate: float) -> int:
    """Samples that are left away in a record that starts moving: what acted before it still rings."""
    return min(len(residual) // 4, round(0.5 * rate)) if run.begins == "moving" else 0


def _linear(chain: Chain, values: Mapping[str, float], run: Run, actuator: Actuator, output: str) -> LinearModel:
    known = conditions(run, actuator) | dict(values)
    return chain.linearise({name: np.array([known[name]]) for name in chain.symbols}, output)


def _alike(run: Run, rate: float) -> object:
    return run.specimen, run.gain, run.output, rate


def _cores(
    chain: Chain,
    preset: Preset,
    values: Mapping[str, float],
    run: Run,
    actuator: Actuator,
    signals: tuple[str, ...],
    rate: float,
) -> list[tuple[LinearModel, Response]]:
    """The linear core at the values, and with each of its parameters nudged: output and signals."""

    def at(changed: Mapping[str, float]) -> tuple[LinearModel, Response]:
        models = [_linear(chain, {**values, **changed}, run, actuator, name) for name in (run.output, *signals)]
        return models[0], Response.of(models, rate)

    names = _searched(chain, preset, values)
    return [at({}), *(at({name: values[name] * (1 + _NUDGE)}) for name in names)]


def _searched(chain: Chain, preset: Preset, values: Mapping[str, float]) -> tuple[str, ...]:
    return tuple(
        p.in_equations for p in preset.parameters if p.in_equations in chain.symbols and values[p.in_equations] != 0
    )


def _moved(
    models: Sequence[tuple[LinearModel, Response]], run: Run, signals: tuple[str, ...], command: Array
) -> tuple[dict[str, Array], dict[str, Array], Array]:
    """The linear core's signals, how they and the output move with each parameter, per relative change."""
    shown = [response.to(command, first_state(run, model))[:, 0] for model, response in models]
    changes = [(other - shown[0]) / _NUDGE for other in shown[1:]]
    moved = np.stack(changes, axis=1) if changes else np.zeros((len(command), 0, len(signals) + 1))
    inner = {name: shown[0][:, i + 1] for i, name in enumerate(signals)}
    return inner, {name: moved[:, :, i + 1] for i, name in enumerate(signals)}, moved[:, :, 0]


def _simulated(
    comparison: Comparison, preset: Preset, signals: tuple[str, ...], runs: Sequence[Run]
) -> dict[str, dict[str, Array]]:
    """The internal signals of a model with effects, from its compiled kernel: name, then run."""
    _, matrix, values = fitted(comparison.fit, comparison.matrix)
    simulated, wanted = every_run(preset, matrix), {run.id for run in runs}
    return inside(replace(simulated, runs=tuple(run for run in matrix.runs if run.id in wanted)), values, signals)


def inside(
    simulated: SimulatedRuns, values: Mapping[str, float], signals: Sequence[str]
) -> dict[str, dict[str, Array]]:
    """The internal signals (n,) of simulated runs at some values: name, then the run's id.

    Each is shown by itself: the rate of a lag is there only where the lag is not advanced exactly, and may ask for
    finer steps then.
    """
    vector, _ = simulated.settle(values)
    shown = {name: showing(simulated.chain, (name,)) for name in signals}
    steps = {name: int(simulated.steps(vector, of=chain).max()) for name, chain in shown.items()}

    def one(entry: tuple[str, Run]) -> Array:
        name, run = entry
        known = conditions(run, simulated.matrix.actuator) | dict(values)
        at = {symbol: np.array([[value]]) for symbol, value in known.items()}
        start = simulated.first_states(run, at)
        named = replace(run, output=name, channels={**run.channels, name: run.measured})
        blocks = Simulation(shown[name], (named,), at, steps[name], start).outputs()
        return np.concatenate([rows[:, 0, 0] for rows, _, _ in blocks])

    wanted = [(name, run) for name in signals for run in simulated.runs]
    found = dict(zip(((name, run.id) for name, run in wanted), each(one, wanted), strict=True))
    return {name: {run.id: found[name, run.id] for run in simulated.runs} for name in signals}
