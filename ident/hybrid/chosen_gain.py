"""The gain Kp of a servo loop chosen for one quantity: a margin, the bandwidth, the peak or the overshoot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import scipy  # optimize, which takes a third of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.changed_machine import ChangedMachine
from ident.hybrid.drawn_loops import drawn_loops
from ident.hybrid.interval import Interval
from ident.hybrid.loop_figures import QUANTITIES, loop_figure
from ident.hybrid.parameter_samples import Spread
from ident.words.nearest import did_you_mean
from ident.words.number import plain, trimmed

Array = NDArray[np.float64]
_LOWEST, _HIGHEST = 1e-3, 1e4
"""Gains Kp between which one is sought."""
_GAINS = 71  # between them, 26 % apart


@dataclass(frozen=True)
class GainTarget:
    """What is wanted: a quantity of :data:`ident.hybrid.loop_figures.QUANTITIES` and its value in its unit.

    Raises Unusable for another quantity, and for a value that is not above 0.
    """

    quantity: str
    value: float

    def __post_init__(self) -> None:
        if self.quantity not in QUANTITIES:
            raise Unusable(
                "unknown-quantity",
                f"no gain is chosen for {self.quantity!r}",
                "choose",
                did_you_mean(self.quantity, QUANTITIES),
            )
        if not 0 < self.value < np.inf:
            raise Unusable("bad-number", f"{self.quantity} is {self.value:g}", "choose", "give a value above 0")


@dataclass(frozen=True)
class ChosenGain:
    """The `gain` for a target, or the nearest where it is not `reached`; what follows, by quantity.

    `stable` is the share of the machines drawn from the fitted covariance whose loop is stable, None without errors.
    """

    target: GainTarget
    gain: float
    reached: bool
    quantities: Mapping[str, Interval]
    stable: float | None
    text: str

    def sentences(self) -> Iterator[str]:
        """The gain, and what follows."""
        yield self.text
        said = (f"{name.replace('_', ' ')} {one}" for name, one in self.quantities.items())
        yield f"At Kp = {plain(self.gain, 4)}: {'; '.join(said)}."


def choose_gain(
    fit: FitResult, machine: ChangedMachine, target: GainTarget, seed: int = 0, spread: Spread | None = None
) -> ChosenGain:
    """The smallest gain at which a machine has what is wanted; else the one that comes nearest, of the stable ones.

    What follows is said over a `spread` of its parameters, without one over the covariance of the fit.

    Raises Unusable for a machine without a gain, and for one that no gain makes stable.
    """
    if not machine.has_gain:
        raise Unusable("no-gain", "the model has no loop with a gain", "choose", "leave it out")
    gains = np.geomspace(_LOWEST, _HIGHEST, _GAINS)
    values = _of(machine, target.quantity, gains)
    if not np.isfinite(values).any():
        raise Unusable(
            "out-of-reach",
            f"at no gain is there a {target.quantity.replace('_', ' ')}",
            "choose",
            "choose another quantity, or correct the machine",
        )
    gain, reached = _sought(machine, target, gains, values)
    loops = drawn_loops(fit, machine, gain, spread, seed)
    text = _text(target, gain, reached, loops.quantities)
    return ChosenGain(target, gain, reached, loops.quantities, loops.stable, text)


def _of(machine: ChangedMachine, quantity: str, gains: Array) -> Array:
    """A quantity at gains (g,); NaN where the loop is unstable or has none."""
    values = loop_figure(machine, quantity, gains)
    return np.where(np.isfinite(values), values, np.nan)


def _sought(machine: ChangedMachine, target: GainTarget, gains: Array, values: Array) -> tuple[float, bool]:
    """The gain, and whether it has what is wanted."""

    def off(log: float) -> float:
        return float(_of(machine, target.quantity, np.exp([log]))[0]) - target.value

    left = values - target.value
    crossed = np.flatnonzero(left[:-1] * left[1:] <= 0)
    if len(crossed):
        ends = np.log(gains[[crossed[0], crossed[0] + 1]])
        return float(np.exp(scipy.optimize.brentq(off, *ends, xtol=1e-6))), True
    nearest = int(np.nanargmin(np.abs(left)))
    bounds = np.log(gains[[max(nearest - 1, 0), min(nearest + 1, len(gains) - 1)]])
    best = scipy.optimize.minimize_scalar(
        lambda log: np.nan_to_num(abs(off(log)), nan=np.inf), bounds=bounds, method="bounded", options={"xatol": 1e-6}
    )
    gain = float(np.exp(best.x)) if np.isfinite(best.fun) else float(gains[nearest])
    return gain, abs(off(float(np.log(gain)))) < 1e-3 * target.value


def _text(target: GainTarget, gain: float, reached: bool, quantities: Mapping[str, Interval]) -> str:
    unit, name = QUANTITIES[target.quantity], target.quantity.replace("_", " ")
    if reached:
        return f"Kp = {plain(gain, 4)} gives a {name} of {trimmed(target.value)} {unit}."
    nearest = quantities[target.quantity].value
    closest = "none" if nearest is None else plain(nearest, 3)
    return (
        f"No gain gives a {name} of {trimmed(target.value)} {unit}. The nearest is {closest} {unit}, at "
        f"Kp = {plain(gain, 4)}."
    )
