"""How a controller does on the actuators that the fit, or a stated spread, leaves possible: draws of its parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.interval import Interval
from ident.hybrid.loop_figures import gain_margins, phase_margins
from ident.hybrid.sampled_loop import SampledLoop
from ident.linear import LinearModel

Array = NDArray[np.float64]
WITHIN = (1.0, 10.0)
"""dB and degrees, to 25 Hz, of what a draw may make of the controller's own response."""
HIGHEST = 25.0
"""Hz."""
SHOWN = 30.0
"""Hz: the end of the curves that are kept to be drawn."""
_POINTS = 60
_BAND_OF_MARGINS, _POINTS_OF_MARGINS = (1e-5, 0.4999), 800
"""Of the sample rate, and how many frequencies of it margins are taken from."""


@dataclass(frozen=True)
class Robustness:
    """Of `draws` plants how many are `stable` and how many stay `within` the limits; the band that 95 % are in.

    A draw is within them where its response is at most 1 dB and 10° from that of the wanted one, which is 1 where a
    path forward gives it and the nominal response for feedback alone. `frequency` (f,) in Hz; `magnitude` (dB) and
    `phase` (degrees) are (2, f), the lower and the upper edge. `spread` says in words what the draws are from,
    `margins` between what the gain margin (dB), the phase margin (degrees) and the sensitivity peak of 90 % of the
    stable ones lie, beside those of the controller's own loop. What was `held` is as fitted in every draw.
    """

    draws: int
    stable: int
    within: int
    frequency: Array
    magnitude: Array
    phase: Array
    held: tuple[str, ...]
    spread: str = ""
    margins: Mapping[str, Interval] = field(default_factory=dict)


def held_in(fit: FitResult, drawn: Mapping[str, Array]) -> tuple[str, ...]:
    """Fitted parameters that stay as fitted in every draw: the data, or the spread, say nothing of them."""
    return tuple(name for name, one in fit.parameters.items() if name not in drawn and not one.fixed)


def robustness(
    own: SampledLoop,
    plants: Sequence[LinearModel],
    wanted: NDArray[np.complex128] | None,
    held: tuple[str, ...] = (),
    spread: str = "",
) -> Robustness:
    """The controller of its `own` loop in a loop with each of the plants.

    `wanted` is the response (f,) at :func:`frequencies`, or 1.
    """
    frequency = frequencies()
    target = np.ones(len(frequency), complex) if wanted is None else wanted
    stable, responses, loops = 0, [], [own]
    for plant in plants:
        loop = SampledLoop(plant, own.controller, own.delay)
        if loop.stable:
            stable += 1
            loops.append(loop)
            responses.append(loop.response(frequency))
    found = np.array(responses).reshape(-1, len(frequency))
    ratio = found / target
    decibel, degrees = 20 * np.log10(np.abs(ratio)), np.degrees(np.angle(ratio))
    judged = frequency <= HIGHEST
    good = (np.abs(decibel[:, judged]) <= WITHIN[0]) & (np.abs(degrees[:, judged]) <= WITHIN[1])
    shown = (20 * np.log10(np.abs(found)), np.degrees(np.unwrap(np.angle(found), axis=1)))
    magnitude, phase = (_band(values, len(frequency)) for values in shown)
    return Robustness(
        len(plants), stable, int(good.all(axis=1).sum()), frequency, magnitude, phase, held, spread, _margins(loops)
    )


def _margins(loops: Sequence[SampledLoop]) -> dict[str, Interval]:
    """The margins of the first loop, and between what those of the others lie."""
    frequency = np.geomspace(*_BAND_OF_MARGINS, _POINTS_OF_MARGINS) * loops[0].controller.sample_rate
    L = np.array([loop.open_loop(frequency) for loop in loops])
    found = {
        "gain": ("dB", gain_margins(L)),
        "phase": ("°", phase_margins(L)),
        "sensitivity_peak": ("1", np.abs(1.0 / (1.0 + L)).max(axis=-1)),
    }
    return {name: Interval.of(unit, float(of[0]), of[1:]) for name, (unit, of) in found.items()}


def frequencies() -> Array:
    """Where responses are compared and drawn, Hz: 0.5 to 30."""
    return np.linspace(SHOWN / _POINTS, SHOWN, _POINTS)


def _band(values: Array, count: int) -> Array:
    return np.percentile(values, (2.5, 97.5), axis=0) if len(values) else np.full((2, count), np.nan)
