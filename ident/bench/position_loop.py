"""Margins of a position loop around a servo-actuator of Kononykhin's kind, at stated amplitudes.

    L(jω; A) = C(jω) · Ns(X) · e^(−jω(D + Dc)) / ((1 + jωT)(1 + jωT₂)) · N(A) / (jω)
    C = (Kp + Ki h/(1 − e^(−jωh))) (1 − e^(−jωh))/(jωh)         a regulator P or PI that samples each h and holds

A is the amplitude of the current at the play (block b), N the describing function of what follows
(:mod:`ident.bench.describing_function`), Ns that of the regulator's limit. The loop oscillates by itself where
L = −1 (Gelb and Vander Velde 1968): so the gain margin at an amplitude tells the gain at which the loop swings with it,
and the phase crossover the frequency. Harmonics of the current are neglected: the lag and the integration take most of
them away.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.describing_function import FirstHarmonic, first_harmonic
from ident.bench.model import Model
from ident.bench.outputs import model_of
from ident.custom.definition import preset_with
from ident.effects.command_delay import COMMAND_DELAY
from ident.effects.second_lag import SECOND_LAG
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.plain import written
from ident.rig.regulator import Regulator
from ident.words.engineering import quantity
from ident.words.message import Message, message
from ident.words.percent import PER_CENT
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.position_loop
DECIBELS = 20.0 / math.log(10.0)
"""Of a natural logarithm of an amplitude. No answer depends on it: a unit."""
_HALF_TURN = math.degrees(math.pi)
_POINTS = 2000
"""Frequencies at which the loop is looked at, equally spaced by the logarithm, and places of the curve of a limit; a
crossing between two is taken on a straight line. No answer depends on it: ten times as many change a gain margin by
2e-5 dB."""


@dataclass(frozen=True)
class AmplitudeMargin:
    """The loop at one amplitude of the current at the play.

    `amplitude` in rated currents, `gain` |N| in m/s for a rated current and `phase` of N in degrees. `gain_margin` (dB)
    is None where no higher gain makes the loop oscillate, `phase_margin` (degrees) where |L| nowhere falls to 1; both
    where the actuator `stands`, for the amplitude is within its dead space. `oscillation_gain` is the kp (1/m) and
    `oscillation_frequency` (Hz) that of the oscillation with this amplitude.
    """

    amplitude: float
    gain: float
    phase: float
    stands: bool
    gain_margin: float | None = None
    phase_margin: float | None = None
    crossover: float | None = None
    oscillation_gain: float | None = None
    oscillation_frequency: float | None = None
    frequency: tuple[float, ...] = field(default=(), repr=False)
    magnitude: tuple[float, ...] = field(default=(), repr=False)
    """|L| in dB."""
    angle: tuple[float, ...] = field(default=(), repr=False)
    """Phase of L in degrees."""
    text: str = ""
    """What it says, in a sentence."""


@dataclass(frozen=True)
class PositionLoop(TabularResult):
    """A position loop around the actuator of a fit: its regulator, the dead space, and the margins at each amplitude.

    `gain_margin` (dB) and `phase_margin` (degrees) are the smallest, None where there are none; `state` is "unstable"
    where the loop oscillates at one of the amplitudes, whatever it began with.
    """

    model: str
    regulator: Regulator
    dead_space: float
    amplitudes: tuple[AmplitudeMargin, ...]
    gain_margin: float | None
    phase_margin: float | None
    state: str

    def listings(self) -> Iterator[Listing | str]:
        """A sentence for each amplitude, and their table."""
        for one in self.amplitudes:
            yield one.text
        header = (
            "amplitude",
            "|N|",
            "phase of N",
            "gain margin",
            "phase margin",
            "crossover",
            "oscillates at",
            "with kp",
        )
        yield Listing("", header, [_row(one) for one in self.amplitudes], header)

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data; a limit that is not stated is left out."""
        data: dict[str, Any] = written(self)
        return data


def _sentence(one: AmplitudeMargin) -> Message:
    if one.stands:
        return message("loop.stands", amplitude=one.amplitude)
    margin, known = one.gain_margin, {"amplitude": one.amplitude, "phase": one.phase_margin}
    if margin is None:
        return message("loop.no_gain", **known)
    swings = {"gain": one.oscillation_gain, "frequency": one.oscillation_frequency}
    if margin < 0:
        return message("loop.unstable", amplitude=one.amplitude, excess=-margin, **swings)
    return message("loop.margins", **known, margin=margin, **swings)


def _row(one: AmplitudeMargin) -> tuple[str, ...]:
    def cell(value: float | None, unit: str) -> str:
        return "none" if value is None else f"{value:.4g} {unit}"

    return (
        f"{PER_CENT * one.amplitude:.4g} %",
        quantity(one.gain, "m/s"),
        f"{one.phase:.3g}°",
        cell(one.gain_margin, "dB"),
        cell(one.phase_margin, "°"),
        cell(one.crossover, "Hz"),
        cell(one.oscillation_frequency, "Hz"),
        cell(one.oscillation_gain, "1/m"),
    )


def position_loop(fit: FitResult, regulator: Regulator, amplitudes: Sequence[float] = ()) -> PositionLoop:
    """The margins of a position loop around the actuator of a fit, at amplitudes (rated currents) of block b.

    Raises Unusable where the fit is of another kind of model, or has an effect that hangs on the position or sticks.
    """
    model = _actuator(fit)
    stated = tuple(amplitudes) or usual_amplitudes(model)
    for amplitude in stated:
        if not 0 < amplitude < math.inf:
            raise Unusable(
                "bad-amplitude", f"{amplitude:g} is not an amplitude", "amplitude", "give one above 0, as 2 %"
            )
    found = tuple(margins(model, regulator, amplitude) for amplitude in stated)
    return PositionLoop(
        model=fit.model,
        regulator=regulator,
        dead_space=model.dead_space,
        amplitudes=found,
        gain_margin=_smallest([one.gain_margin for one in found]),
        phase_margin=_smallest([one.phase_margin for one in found]),
        state="unstable" if any((one.phase_margin or 0.0) < 0 for one in found) else "stable",
    )


def usual_amplitudes(model: Model) -> tuple[float, ...]:
    """The amplitudes at the play where none are stated, rated currents."""
    return tuple(multiple * model.dead_space for multiple in _OF.multiples)


def _smallest(values: Sequence[float | None]) -> float | None:
    return min((value for value in values if value is not None), default=None)


def _actuator(fit: FitResult) -> Model:
    """The model of a fit. Raises Unusable."""
    preset = preset_with(fit.model, fit.effects, fit.settings.get("custom", ()))
    if preset.kind != "bench":
        raise Unusable(
            "another-model",
            f"the model {fit.model} has no play before its speed",
            "fit",
            "give a fit with --model kononykhin, or leave the regulator out",
        )
    known = {COMMAND_DELAY.name, SECOND_LAG.name}
    if strange := [name for name in fit.effects if name not in known]:
        raise Unusable(
            "effect-in-loop",
            f"a describing function has no {strange[0]}",
            "fit",
            f"give a fit with no other effects than {' and '.join(sorted(known))}",
        )
    supply = fit.actuator.supply_pressure if fit.actuator else None
    values = {name.replace(".", "__"): value for name, value in fit.values.items()}
    return model_of(values, math.inf if supply is None else supply, preset)


def margins(model: Model, regulator: Regulator, amplitude: float) -> AmplitudeMargin:
    """The margins of the loop at an amplitude (rated currents) of the current at block b."""
    found = _margins(model, regulator, amplitude)
    return replace(found, text=str(_sentence(found)))


def _margins(model: Model, regulator: Regulator, amplitude: float) -> AmplitudeMargin:
    of_speed = first_harmonic(model, amplitude)
    size, turn = abs(of_speed.value), float(np.angle(of_speed.value)) if not of_speed.stands else 0.0
    of_blocks = AmplitudeMargin(amplitude, size, math.degrees(turn), of_speed.stands)
    if of_speed.stands:
        return of_blocks
    w = 2 * np.pi * np.geomspace(_OF.lowest, _highest(model, regulator), _POINTS)
    level, angle = open_loop(model, regulator, of_speed, w)
    reached = np.isfinite(level)
    w, level, angle = w[reached], level[reached], angle[reached]
    swings = _last_crossing(w, angle + np.pi, level)
    crosses = _last_crossing(w, level, angle)
    frequency = None if swings is None else swings[0] / (2 * np.pi)
    margin = None if swings is None else -DECIBELS * swings[1]
    return replace(
        of_blocks,
        gain_margin=margin,
        phase_margin=None if crosses is None else _HALF_TURN + math.degrees(crosses[1]),
        crossover=None if crosses is None else crosses[0] / (2 * np.pi),
        oscillation_gain=None if swings is None else regulator.kp * math.exp(-swings[1]),
        oscillation_frequency=frequency,
        frequency=tuple((w / (2 * np.pi)).tolist()),
        magnitude=tuple((DECIBELS * level).tolist()),
        angle=tuple(np.degrees(angle).tolist()),
    )


def open_loop(model: Model, regulator: Regulator, of_speed: FirstHarmonic, w: Array) -> tuple[Array, Array]:
    """ln|L| and the phase of L (rad, not wrapped) at w (rad/s); no number where the limit lets no such amplitude pass.

    The limit's describing function is that of the amplitude before it which gives what the play is to see.
    """
    size, angle = regulator.response(w)
    second = model.strengths.get(SECOND_LAG.added[0].in_equations, 0.0)
    lags = np.sqrt((1.0 + (w * model.T) ** 2) * (1.0 + (w * second) ** 2))
    turned = angle - np.arctan(w * model.T) - np.arctan(w * second) - w * (model.delay + regulator.delay)
    limited = _passes(of_speed.amplitude * lags, regulator.limit)
    with np.errstate(divide="ignore", invalid="ignore"):  # at the sampling frequency the hold passes nothing
        level = np.log(size * limited * abs(of_speed.value) / (lags * w))
    return level, turned + float(np.angle(of_speed.value)) - 0.5 * np.pi


def _highest(model: Model, regulator: Regulator) -> float:
    """Hz up to which a loop is looked at: half the sample rate of its regulator."""
    return 0.5 / regulator.sample_time if regulator.sample_time else _OF.highest / (2 * np.pi * model.T)


def _passes(behind: Array, limit: float | None) -> Array:
    """The describing function of a limit by the amplitude `behind` it, no number where that cannot be.

    Ns(X) = (2/π)(asin(L/X) + (L/X) √(1 − (L/X)²)),    behind = X Ns(X)
    """
    if limit is None:
        return np.ones_like(behind)
    angle = 0.5 * np.pi * np.arange(1, _POINTS + 1) / _POINTS  # asin(L/X)
    passed = 2 / np.pi * (angle + np.sin(angle) * np.cos(angle))
    behind_it = (limit / np.sin(angle) * passed)[::-1]
    found = np.interp(behind, behind_it, passed[::-1], left=1.0)
    return np.where(behind < behind_it[-1], found, np.nan)


def _last_crossing(w: Array, falls: Array, other: Array) -> tuple[float, float] | None:
    """The highest w where a quantity falls through zero, and another there; by straight lines over ln w."""
    places = np.flatnonzero((falls[:-1] > 0) & (falls[1:] <= 0))
    if not len(places):
        return None
    i = int(places[-1])
    share = falls[i] / (falls[i] - falls[i + 1])
    log = np.log(w[i]) + share * np.log(w[i + 1] / w[i])
    return float(np.exp(log)), float(other[i] + share * (other[i + 1] - other[i]))
