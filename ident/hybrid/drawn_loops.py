"""A servo loop at a gain Kp over the machines that a spread leaves open: how many are stable, and what they have."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.changed_machine import ChangedMachine
from ident.hybrid.interval import Interval
from ident.hybrid.loop_figures import QUANTITIES, loop_figure
from ident.hybrid.parameter_samples import DRAWS, Covariance, Spread, drawn_parameters
from ident.words.number import trimmed
from ident.words.percent import percent

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DrawnLoops:
    """The loop at a `gain`, None where it has none: every quantity, and over `draws` machines of a `spread` in words.

    `stable` is the share of them whose loop is stable, None where the spread leaves nothing open.
    """

    gain: float | None
    spread: str
    draws: int
    stable: float | None
    quantities: Mapping[str, Interval]

    def sentences(self) -> Iterator[str]:
        """How many are stable, and between what 90 % of those lie."""
        at = "" if self.gain is None else f" at Kp = {trimmed(self.gain)}"
        if self.stable is None:
            yield f"Nothing is known of other machines{at}: {self.spread} leaves nothing open."
            return
        said = "; ".join(f"{name.replace('_', ' ')} {one}" for name, one in self.quantities.items())
        yield f"Over {self.spread} {percent(self.stable)} of {self.draws} machines are stable{at}: {said}."


def drawn_loops(
    fit: FitResult,
    machine: ChangedMachine,
    gain: float | None,
    spread: Spread | None = None,
    seed: int = 0,
    draws: int = DRAWS,
) -> DrawnLoops:
    """The loop of a machine at a gain over a `spread` of its parameters, without one over the covariance of its fit.

    A parameter that a change has set spreads by as large a share as the fitted one, but not by the covariance.
    """
    known = 1.0 if gain is None else gain
    drawn = {
        name: values / fit.parameters[name].value
        for name, values in drawn_parameters(fit, draws, seed, spread).items()
        if _varies(fit, machine, name, spread)
    }
    found, stable = {}, None
    for name, unit in QUANTITIES.items():
        many = loop_figure(machine, name, np.full(draws, known), drawn) if drawn else np.zeros(0)
        stable = float(np.mean(~np.isnan(many))) if len(many) else None
        found[name] = Interval.of(unit, float(loop_figure(machine, name, np.array([known]))[0]), many)
    return DrawnLoops(gain, str(spread or Covariance()), draws if drawn else 0, stable, found)


def _varies(fit: FitResult, machine: ChangedMachine, name: str, spread: Spread | None) -> bool:
    carried = machine.parameters.get(name)
    set_to = carried is not None and carried.why == "as set"
    return carried is not None and bool(fit.parameters[name].value) and not (spread is None and set_to)
