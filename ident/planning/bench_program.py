"""Kononykhin's program for a control unit: saw-tooth in three ranges, sines, levels, the stroke of changing speed.

The records are those that `simulate` makes, :func:`ident.synthesis.bench_matrix.plans`, about the zero shift and
beyond the dead space that a fit found.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ident.bench.model import Model, dead_space
from ident.bench.outputs import model_of
from ident.custom.definition import preset_with
from ident.design.predicted_peaks import Peaks
from ident.design.spread import Spread
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Actuator
from ident.rig.limits import RigLimits
from ident.synthesis.bench_matrix import STROKE, Plan, plans, record

Array = NDArray[np.float64]
KONONYKHIN = "kononykhin"
GAIN = 0.1
"""m/s at rated current: of the middle actuator of the paper, where no fit says more."""
_TOGETHER: tuple[Mapping[str, float], ...] = ({"T": 1.0}, {"I0": 1.0}, {"B": 1.0, "dPfr": 1.0, "kp": -1.0})
"""Constants that are off at once, with the sense in which they widen the dead space."""


@dataclass(frozen=True, eq=False)
class UncertainBench:
    """The actuator of a fit, at the corners of what its parameters may be, on a bench of a stroke (m)."""

    models: tuple[Model, ...]
    stroke: float
    piston_area: float | None

    def peaks(self, plan: Plan) -> Peaks:
        """The peaks of a record over the corners: position from the middle, speed, flow, force, pressure difference."""
        found = [self._of(plan, model) for model in self.models]
        return Peaks({name: max(one[name] for one in found) for name in found[0]}, linear=False)

    def _of(self, plan: Plan, model: Model) -> dict[str, float]:
        _, position, pressure = record(plan, model)
        sizes = {
            "stroke": float(np.abs(position - 0.5 * self.stroke).max()),
            "speed": float(np.abs(np.diff(position)).max()) / (plan.seconds / len(position)),
            "supply_pressure": float(np.abs(pressure).max()),
        }
        if self.piston_area is not None:
            sizes["flow"] = self.piston_area * sizes["speed"]
            sizes["force"] = self.piston_area * sizes["supply_pressure"]
        return sizes


def uncertain_bench(fit: FitResult, spread: Spread, actuator: Actuator, limits: RigLimits) -> UncertainBench:
    """The actuator of a fit of bench records. Raises Unusable where the fit is of another model."""
    preset = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    if preset.kind != "bench":
        raise Unusable(
            "no-answer",
            f"the model {fit.model} is fitted to test runs",
            "fit",
            "give the fit of a bench's records, or none",
        )
    values = {preset.parameter(name).in_equations: value for name, value in fit.values.items()}
    middle = model_of(values, limits.supply_pressure or np.inf, preset)
    widths = spread.half_widths(fit, preset)
    return UncertainBench(tuple(_corners(middle, widths)), limits.stroke or STROKE, actuator.piston_area)


def _corners(middle: Model, widths: Mapping[str, float]) -> list[Model]:
    """The fitted model, then every corner of :data:`_TOGETHER` and the speeds, all of which go together."""
    known = middle.values()
    groups: list[Mapping[str, float]] = [*_TOGETHER, dict.fromkeys(middle.table.names, 1.0)]
    found = [middle]
    for ends in product((-1.0, 1.0), repeat=len(groups)):
        off = {
            name: end * sign * float(np.sign(known[name])) * widths.get(name, 0.0)
            for group, end in zip(groups, ends, strict=True)
            for name, sign in group.items()
        }
        found.append(middle.with_values({name: known[name] + deviation for name, deviation in off.items()}))
    return found


def bench_plans(limits: RigLimits, machine: UncertainBench | None) -> tuple[Plan, ...]:
    """The records for a rig, within its stroke; with a fit about its zero shift and beyond its dead space.

    The gain is that of the fit's faster direction at rated current; without a fit it is the paper's 0.1 m/s.
    """
    stroke = limits.stroke or STROKE
    if machine is None:
        return tuple(plans(GAIN, stroke))
    model = machine.models[0]
    gain = max(abs(model.table.forward[-1]), abs(model.table.back[-1]))
    return tuple(plans(gain, stroke, model.I0, dead_space(model.values())))
