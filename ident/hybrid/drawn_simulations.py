"""A hybrid simulation over the machines that a spread leaves open: how many are stable, scores, margin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from threading import Lock
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController, no_controller
from ident.hybrid.coupled_case import CoupledCase, System
from ident.hybrid.coupled_loop import CoupledLoop
from ident.hybrid.coupled_simulation import machines_of
from ident.hybrid.hybrid_loop import HybridLoop
from ident.hybrid.hybrid_simulation import RUNAWAY
from ident.hybrid.interval import Interval
from ident.hybrid.loop import LANES
from ident.hybrid.machine import Machine, machine
from ident.hybrid.parameter_samples import DRAWS, Covariance, Spread, drawn_parameters
from ident.hybrid.rig_assembly import rig_of, run
from ident.hybrid.scores import rms
from ident.hybrid.specimen_effects import of_specimen, reference_of
from ident.hybrid.stability import coupled_loop
from ident.hybrid.substructure import driven_by, reference
from ident.parallel import each, one_thread
from ident.plain import read, written
from ident.progress import Progress, Report, silent
from ident.stability.gain_margin import LARGEST, gain_margin
from ident.stability.loop import Loop
from ident.words.percent import percent

Array = NDArray[np.float64]
SCORES = ("tracking_rms", "reference_rms", "numerical_rms")
"""What is said of the drawn machines that did not run away: of several actuators of each, and the largest."""
MARGIN = "gain_margin"
"""dB, of all drawn machines whose loop is linear."""
Machines = tuple[Machine, ...]


@dataclass(frozen=True)
class DrawnSimulations:
    """Of `draws` machines of a `spread` in words the share that is `stable`, and what 90 % of them have.

    `quantities` are the scores as fractions and the gain margin in dB, below 0 where the loop is unstable; their values
    are those of the fitted machine. A machine that is not linear has no gain margin. Of several actuators a draw is
    one of the machine of each: the scores are the largest of a draw, and `parts` has those of each actuator.
    """

    spread: str
    draws: int
    stable: float
    quantities: Mapping[str, Interval]
    parts: Mapping[str, Mapping[str, Interval]] = field(default_factory=dict)

    def sentences(self) -> Iterator[str]:
        """How many are stable, and between what 90 % lie."""
        of = "draws of the machines" if self.parts else "machines"
        said = _listed(self.quantities) or "no scores"
        yield f"Over {self.spread} {percent(self.stable)} of {self.draws} {of} are stable: {said}."
        for name, quantities in self.parts.items():
            if said := _listed(quantities):
                yield f"Actuator {name}: {said}."

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        data: dict[str, Any] = written(self)
        return data

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> DrawnSimulations:
        """What :meth:`to_json` gave."""
        return read(cls, data)


def _listed(quantities: Mapping[str, Interval]) -> str:
    return "; ".join(
        f"{name.replace('_', ' ')} {_said(one)}" for name, one in quantities.items() if one.lower is not None
    )


def _said(one: Interval) -> str:
    if one.unit != "1":
        return str(one)
    ends = [percent(end) for end in (one.lower, one.upper) if end is not None]
    value = "none" if one.value is None else percent(one.value)
    return f"{value} ({' to '.join(ends)})"


def drawn_simulations(
    fit: FitResult,
    case: Case,
    controller: SampledController | None = None,
    effects: Mapping[str, float] | None = None,
    spread: Spread | None = None,
    draws: int = DRAWS,
    seed: int = 0,
    report: Report = silent,
) -> DrawnSimulations:
    """A case on machines drawn from a `spread` of a fit, without one from its covariance; sixteen side by side.

    The controller is the same for all of them. Raises Unusable as
    :func:`ident.hybrid.hybrid_simulation.simulate_hybrid`.
    """
    machines = [(machine(one, case, effects),) for one in _drawn(fit, draws, seed, spread)]
    ground = case.ground.samples(case.sample_rate)
    if of_specimen(machines[0][0]):
        wanted = [(reference_of(one, case, ground),) for (one,) in machines]
    else:
        wanted = [(reference(case, ground),)] * len(machines)
    acting = (controller or no_controller(case.sample_rate),)
    table = _simulated(machines, case, acting, driven_by(case, ground), wanted, report)
    return _summary(str(spread or Covariance()), table, ())


def drawn_coupled(
    fits: Sequence[FitResult],
    case: CoupledCase,
    controllers: Sequence[SampledController],
    effects: Mapping[str, float] | None = None,
    spreads: Sequence[Spread] | None = None,
    draws: int = DRAWS,
    seed: int = 0,
    report: Report = silent,
) -> DrawnSimulations:
    """As :func:`drawn_simulations`, of a case of several actuators: the machine of each is drawn by itself.

    `spreads` are those of each part, without them the covariance of its fit.
    """
    of_each = tuple(spreads or [Covariance()] * len(fits))
    drawn = [_drawn(fit, draws, (seed, p), of) for p, (fit, of) in enumerate(zip(fits, of_each, strict=True))]
    most = max(map(len, drawn))
    machines = [machines_of([of[min(i, len(of) - 1)] for of in drawn], case, effects) for i in range(most)]
    ground = case.ground.samples(case.sample_rate)
    wanted = [tuple(reference(one, ground) for one in case.cases)] * most
    table = _simulated(machines, case, controllers, ground, wanted, report)
    return _summary(", ".join(dict.fromkeys(map(str, of_each))), table, [part.name for part in case.parts])


def _drawn(fit: FitResult, draws: int, seed: int | tuple[int, int], spread: Spread | None) -> list[FitResult]:
    """The fit, and it with other values of its parameters, as often as drawn; alone where nothing is left open."""
    drawn = drawn_parameters(fit, draws, seed, spread)
    changed = [{name: float(values[i]) for name, values in drawn.items()} for i in range(draws if drawn else 0)]
    return [fit, *(_with_values(fit, values) for values in changed)]


def _with_values(fit: FitResult, values: Mapping[str, float]) -> FitResult:
    """The fit with other values of its parameters."""
    changed = {name: replace(one, value=values.get(name, one.value)) for name, one in fit.parameters.items()}
    return replace(fit, parameters=changed)


def _summary(spread: str, table: Array, names: Sequence[str]) -> DrawnSimulations:
    """What the rows of a table say, of which the first is of the fitted machines: see :func:`_row`."""
    scores = table[:, 2:].reshape(len(table), -1, len(SCORES))
    quantities = {name: _interval("1", scores[:, :, i].max(axis=1)) for i, name in enumerate(SCORES)}
    parts = {
        name: {score: _interval("1", scores[:, p, i]) for i, score in enumerate(SCORES)} for p, name in enumerate(names)
    }
    rows = table[1:] if len(table) > 1 else table
    return DrawnSimulations(
        spread, len(table) - 1, float(rows[:, 0].mean()), {**quantities, MARGIN: _interval("dB", table[:, 1])}, parts
    )


def _interval(unit: str, values: Array) -> Interval:
    return Interval.of(unit, float(values[0]), values[1:])


def _simulated(
    machines: Sequence[Machines],
    system: System,
    acting: Sequence[SampledController],
    driven: Array,
    wanted: Sequence[tuple[Array, ...]],
    report: Report,
) -> Array:
    """A row for each draw of the machines of a system, as many side by side as fill the lanes of a kernel."""
    lock, count, beside = Lock(), [0], LANES // len(acting)

    def group(first: int) -> Array:
        some = slice(first, first + beside)
        found = _group(machines[some], system, acting, driven, wanted[some])
        with lock:
            count[0] += len(found)
            report(Progress("spread", count[0], len(machines)))
        return found

    with one_thread():
        return np.concatenate(each(group, range(0, len(machines), beside)))


def _group(
    machines: Sequence[Machines],
    system: System,
    acting: Sequence[SampledController],
    driven: Array,
    wanted: Sequence[tuple[Array, ...]],
) -> Array:
    """The rows of draws that run side by side."""
    parts = len(acting)
    limits = np.repeat([max(float(np.abs(one).max()) for one in of) for of in wanted], parts)
    side_by_side = [one for of in machines for one in of]
    _kept, rig = rig_of(side_by_side, (system,) * len(machines), acting, driven, RUNAWAY * limits)
    run(rig, acting)
    return np.array(
        [
            _row(
                of,
                system,
                acting,
                rig.ended[i] >= len(driven),
                rig.d[:, i * parts : (i + 1) * parts],
                rig.y[:, i * parts : (i + 1) * parts],
                wanted[i],
            )
            for i, of in enumerate(machines)
        ]
    )


def _row(
    machines: Machines,
    system: System,
    acting: Sequence[SampledController],
    kept: bool,
    d: Array,
    y: Array,
    wanted: Sequence[Array],
) -> Array:
    """Stable, the gain margin, and the scores of each machine of a draw; NaN where there is none."""
    linear, scores = not any(one.nonlinear for one in machines), np.full((len(machines), len(SCORES)), np.nan)
    margin, stable = np.nan, kept
    if linear:
        found = gain_margin(_loop(machines, system, acting))
        margin = LARGEST if found is None else found
        poles = scipy.linalg.eigvals(coupled_loop(machines, system, acting)[0])
        stable = kept and float(np.abs(poles).max()) < 1
    if kept:
        for p, of in enumerate(wanted):
            scores[p] = rms(y[:, p], d[:, p]), rms(y[:, p], of), rms(d[:, p], of)
    return np.array([stable, margin, *scores.ravel()])


def _loop(machines: Machines, system: System, acting: Sequence[SampledController]) -> Loop:
    """The loop of a system as its stability is judged."""
    if isinstance(system, CoupledCase):
        return CoupledLoop(machines, system, acting)
    return HybridLoop(machines[0], system, acting[0])
