"""A hybrid simulation over the machines that a spread leaves open: how many are stable, scores, margin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController, no_controller
from ident.hybrid.draws import DRAWS, Covariance, Spread, drawn_parameters
from ident.hybrid.hybrid_loop import HybridLoop
from ident.hybrid.interval import Interval
from ident.hybrid.loop import LANES
from ident.hybrid.machine import Machine, machine
from ident.hybrid.rig import RUNAWAY
from ident.hybrid.rig_assembly import rig_of, run
from ident.hybrid.scores import rms
from ident.hybrid.specimen_effects import of_specimen, reference_of
from ident.hybrid.stability import spectral_radius
from ident.hybrid.substructure import driven_by, reference
from ident.parallel import each, one_thread
from ident.plain import read, written
from ident.progress import Progress, Report, silent
from ident.stability.gain_margin import LARGEST, gain_margin
from ident.words.percent import percent

Array = NDArray[np.float64]
QUANTITIES = {"tracking_rms": "1", "reference_rms": "1", "numerical_rms": "1", "gain_margin": "dB"}
"""What is said of the drawn machines, with its unit: scores of those that did not run away, the margin of all."""


@dataclass(frozen=True)
class DrawnSimulations:
    """Of `draws` machines of a `spread` in words the share that is `stable`, and what 90 % of them have.

    `quantities` are the scores as fractions and the gain margin in dB, below 0 where the loop is unstable; their values
    are those of the fitted machine. A machine that is not linear has no gain margin.
    """

    spread: str
    draws: int
    stable: float
    quantities: Mapping[str, Interval]

    def sentences(self) -> Iterator[str]:
        """How many are stable, and between what 90 % lie."""
        said = "; ".join(
            f"{name} {_said(one)}" for name, one in self.quantities.items() if one.lower is not None
        )  # fmt: skip
        yield f"Over {self.spread} {percent(self.stable)} of {self.draws} machines are stable: {said or 'no scores'}."

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        data: dict[str, Any] = written(self)
        return data

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> DrawnSimulations:
        """What :meth:`to_json` gave."""
        return read(cls, data)


def _said(one: Interval) -> str:
    if one.unit != "1":
        return str(one)
    ends = [percent(end) for end in (one.lower, one.upper) if end is not None]
    value = "none" if one.value is None else percent(one.value)
    return f"{value} ({' to '.join(ends)})"


def drawn_simulations(
    fit: FitResult, case: Case, controller: SampledController | None = None,
    effects: Mapping[str, float] | None = None, spread: Spread | None = None, draws: int = DRAWS, seed: int = 0,
    report: Report = silent,
) -> DrawnSimulations:  # fmt: skip
    """A case on machines drawn from a `spread` of a fit, without one from its covariance; sixteen side by side.

    The controller is the same for all of them. Raises Unusable as :func:`ident.hybrid.rig.simulate_hybrid`.
    """
    drawn = drawn_parameters(fit, draws, seed, spread)
    fits = [fit, *(_with_values(fit, {name: float(values[i]) for name, values in drawn.items()})
                   for i in range(draws if drawn else 0))]  # fmt: skip
    machines = [machine(one, case, effects) for one in fits]
    acting = controller or no_controller(case.sample_rate)
    ground = case.ground.samples(case.sample_rate)
    if of_specimen(machines[0]):
        wanted = [reference_of(one, case, ground) for one in machines]
    else:
        wanted = [reference(case, ground)] * len(machines)
    lock, count = Lock(), [0]

    def group(first: int) -> Array:
        found = _group(tuple(machines[first : first + LANES]), case, acting, ground, wanted[first : first + LANES])
        with lock:
            count[0] += len(found)
            report(Progress("spread", count[0], len(machines)))
        return found

    with one_thread():
        table = np.concatenate(each(group, range(0, len(machines), LANES)))
    quantities = {
        name: Interval.of(unit, float(table[0, 1 + i]), table[1:, 1 + i])
        for i, (name, unit) in enumerate(QUANTITIES.items())
    }
    stable = float(table[1:, 0].mean()) if drawn else float(table[0, 0])
    return DrawnSimulations(str(spread or Covariance()), len(machines) - 1, stable, quantities)


def _with_values(fit: FitResult, values: Mapping[str, float]) -> FitResult:
    """The fit with other values of its parameters."""
    changed = {name: replace(one, value=values.get(name, one.value)) for name, one in fit.parameters.items()}
    return replace(fit, parameters=changed)


def _group(
    machines: tuple[Machine, ...], case: Case, acting: SampledController, ground: Array, wanted: Sequence[Array]
) -> Array:
    """Stable, and the quantities of up to sixteen machines, (count, 1 + q); NaN where there is none."""
    cases = (case,) * len(machines)
    _kept, rig = rig_of(
        machines, cases, (acting,), driven_by(case, ground), RUNAWAY * np.array([np.abs(one).max() for one in wanted])
    )
    run(rig, (acting,))
    rows = np.full((len(machines), 1 + len(QUANTITIES)), np.nan)
    for lane, of in enumerate(machines):
        kept = rig.ended[lane] >= len(ground)
        rows[lane, 0] = kept and (bool(of.nonlinear) or spectral_radius(of, case, acting) < 1)
        if kept:
            d, y = rig.d[:, lane], rig.y[:, lane]
            rows[lane, 1:4] = rms(y, d), rms(y, wanted[lane]), rms(d, wanted[lane])
        if not of.nonlinear:
            margin = gain_margin(HybridLoop(of, case, acting))
            rows[lane, 4] = LARGEST if margin is None else margin
    return rows
