"""From where an effect's search begins: a ripple's frequency and phase, where a stop stands, a part of a spring."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

import numpy as np
import scipy  # signal, which takes a second to load, is loaded where it is first used
from numpy.typing import NDArray
from scipy.fft import next_fast_len

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.fitted_model import FittedModel
from ident.effects.effect import Effect
from ident.effects.ringing import resonance
from ident.fit.space import Space
from ident.parameter import AtReversals, Parameter, Starts
from ident.run import Run

Array = NDArray[np.float64]


def initial_guesses(
    base: FittedModel, effect: Effect, space: Space, known: Mapping[str, float]
) -> list[dict[str, float]]:
    """Every combination of where an effect's searched shapes may begin, by the equations' names.

    `known` are the values of everything in the space, the effect off.
    """
    searched = [p for p in effect.added if p.searched and p.in_equations in space.names]
    values = [_guesses_of(base, parameter, space, known) for parameter in searched]
    names = [parameter.in_equations for parameter in searched]
    return [dict(zip(names, found, strict=True)) for found in product(*values)]


def in_place_of_spring(base: FittedModel, effect: Effect) -> list[dict[str, float]]:
    """The fitted model with a part of its spring given to an effect that is a spring at small motions.

    What yields, and a weight that hangs, were fitted as a spring: where they are added instead, the machine's resonance
    is off at once, and no step leads from there to where both share what was one. A weight's torque is its stiffness.
    """
    criteria, spring = CRITERIA.initial_guesses, next((k for k in effect.takes_over if k in base.values), None)
    if spring is None:
        return []
    way, stiffness, strength = way_of(effect), base.values[spring], effect.added[0].in_equations
    motion = float(np.mean([run.motion for run in base.fitness.runs]))
    amplitude = float(np.sqrt(2.0)) * motion if way else 1.0  # that of a sine: it has yielded at the turning points
    return [
        {
            **base.values,
            spring: (1.0 - share) * stiffness,
            strength: share * stiffness * amplitude,
            **({way.in_equations: amplitude} if way else {}),
        }
        for share in criteria.spring_shares
    ]


def way_of(effect: Effect) -> Parameter | None:
    """The way after which an effect yields; None where it does not."""
    return next((p for p in effect.added if p.at_reversals is AtReversals.WAY), None)


def strength_in_records(base: FittedModel, effect: Effect) -> float | None:
    """The strength that the records show by themselves, SI; None where they show none.

    A stop that was hit stands at the end of the way that was covered, to both sides of the middle of the stroke; a
    limit of the speed at the largest one.
    """
    return _at_top_speed(base) if effect.strength.start is Starts.TOP_SPEED else _at_end(base, effect, {})


def strength_in_model(base: FittedModel, effect: Effect) -> float | None:
    """The same where the fitted model has that end: its zero lies elsewhere in a reading that has an offset."""
    return _at_end(base, effect, base.zeros) if effect.strength.start is Starts.STROKE_END else None


def _at_end(base: FittedModel, effect: Effect, zeros: Mapping[str, float]) -> float | None:
    """The inverse of the largest way, less the zero of each run's reading by the run's id."""
    if effect.strength.start is not Starts.STROKE_END:
        return None
    middle = next((p.value for p in effect.shape if p.start is Starts.STROKE_MIDDLE), 0.0)
    moved = [
        run.channels["displacement"] - (zeros.get(run.id, 0.0) if run.output == "displacement" else 0.0)
        for run in base.fitness.runs
        if "displacement" in run.channels
    ]
    way = max((float(np.max(np.abs(x - middle))) for x in moved), default=0.0)
    return 1.0 / way if way > 0 else None


def _at_top_speed(base: FittedModel) -> float | None:
    """The inverse of the largest speed: measured, or that of a position over a quarter of the shortest period."""
    top = 0.0
    for run in base.fitness.runs:
        if run.output == "velocity":
            top = max(top, float(np.max(np.abs(run.measured))))
        elif run.output == "displacement":
            steps = max(1, round(run.sample_rate * np.pi / (2.0 * base.fitness.band)))
            moved = np.abs(run.measured[steps:] - run.measured[:-steps])
            top = max(top, float(np.max(moved, initial=0.0)) * run.sample_rate / steps)
    return 1.0 / top if top > 0 else None


def _guesses_of(base: FittedModel, parameter: Parameter, space: Space, known: Mapping[str, float]) -> tuple[float, ...]:
    """Where its effect says that its search begins."""
    if parameter.start is Starts.PHASE:
        angles = CRITERIA.initial_guesses.angles
        return tuple(np.arange(angles) * np.pi / (angles / 2))
    if parameter.start is Starts.SPECTRAL_LINES:
        return spectral_lines(base, *space.bounds(known)[parameter.in_equations])
    if parameter.start is Starts.RESONANCE and (found := [*_below_resonance(base), *_away_from_resonance(base)]):
        return tuple(map(float, np.clip(found, *space.bounds(known)[parameter.in_equations])))
    axis = space.names.index(parameter.in_equations)
    criteria = CRITERIA.initial_guesses
    places = np.arange(1, criteria.finely + 1) / (criteria.finely + 1)
    along = places if parameter.start is Starts.FINELY else np.array(criteria.along_range)
    points = space.point(known) + np.zeros((len(along), 1))
    points[:, axis] = along
    return tuple(float(value) for value in space.values(points)[parameter.in_equations])


def _below_resonance(base: FittedModel) -> list[float]:
    """The frequencies (1/s) of a part of the moving mass with the drive standing: ω √(1 − μ), ω that of the records.

    None where these do not ring.
    """
    found, shares = resonance(base.fitness.runs), CRITERIA.initial_guesses.hanging_shares
    return [float(found * np.sqrt(1.0 - share)) for share in shares] if found is not None else []


def _away_from_resonance(base: FittedModel) -> list[float]:
    """Frequencies (1/s) of a part of the moving mass that swings away from the resonance of the records; none if not.

    The residual is largest at the other of the two modes, and the frequency with the drive standing lies between them:
    Ω itself, and of an upper mode Ω that of a part μ, Ω √(1 − μ).
    """
    ringing, criteria = resonance(base.fitness.runs), CRITERIA.initial_guesses
    if ringing is None:
        return []
    outputs = base.fitness.outputs(base.point)
    periods = criteria.periods * 2.0 * np.pi / ringing  # s
    grid = np.arange(1.0, criteria.periods * base.fitness.band / ringing) * ringing / criteria.periods
    total = np.zeros(len(grid))
    for run in base.fitness.runs:
        length = min(run.length, round(periods * run.sample_rate))
        frequencies, power = scipy.signal.welch(run.measured - outputs[run.id], run.sample_rate, nperseg=length)
        total += np.interp(grid, 2.0 * np.pi * frequencies, power / np.var(run.measured))
    away = np.abs(np.log(grid / ringing)) > np.log(criteria.apart)
    if not away.any():
        return []
    mode = float(grid[away][np.argmax(total[away])])
    return [mode, *([mode * float(np.sqrt(1.0 - criteria.upper_share))] if mode > ringing else [])]


def spectral_lines(base: FittedModel, lower: float, upper: float) -> tuple[float, ...]:
    """The frequencies (1/s) between the bounds at which the residual's rate beats with the motion's, clearest first.

    A gain that pulsates makes two neighbours of each line of the motion. Times the motion itself these fall together
    into one line, at the frequency of the pulsation, and all else is spread.
    """
    fitness, outputs = base.fitness, base.fitness.outputs(base.point)
    shortest = min(run.length / run.sample_rate for run in fitness.runs)
    longest = max(run.length / run.sample_rate for run in fitness.runs)
    lower = max(lower, 1.0 / shortest)
    grid = np.arange(lower, min(upper, fitness.band / 2.0), 1.0 / (CRITERIA.initial_guesses.spectrum_points * longest))
    total = np.zeros(len(grid), complex)
    for run in fitness.runs:
        rates = (_rate(run, signal, fitness.band) for signal in (run.measured - outputs[run.id], outputs[run.id]))
        (left, interval), (moved, _) = rates
        size = float(np.std(moved)) * float(np.std(left)) or 1.0
        n = CRITERIA.initial_guesses.spectrum_points * len(left)
        spectrum = np.fft.rfft(left * moved / size, n) * interval
        frequencies = np.fft.rfftfreq(n, interval)
        total += np.interp(grid, frequencies, spectrum.real) + 1j * np.interp(grid, frequencies, spectrum.imag)
    return _peaks(grid, np.abs(total), 1.0 / longest)


def _rate(run: Run, signal: Array, band: float) -> tuple[Array, float]:
    """The rate of a displacement, any other signal itself, within twice the band (rad/s) and without its mean.

    As few samples as a product of two such signals needs, which reaches to four times the band, and their interval (s).
    """
    n = len(signal)
    spectrum = np.fft.rfft(signal - signal.mean())
    omega = 2 * np.pi * np.fft.rfftfreq(n, 1.0 / run.sample_rate)
    within = int(np.searchsorted(omega, 2.0 * band, side="right"))
    spectrum, omega = spectrum[:within], omega[:within]
    few = min(n, next_fast_len(2 * 2 * within, real=True))  # twice the highest frequency of the product (Nyquist)
    rate = np.fft.irfft(spectrum * 1j * omega if run.output == "displacement" else spectrum, few)
    return rate * (few / n), n / run.sample_rate / few


def _peaks(grid: Array, heights: Array, apart: float) -> tuple[float, ...]:
    found: list[float] = []
    for i in np.argsort(heights)[::-1]:
        if all(abs(grid[i] - other) > apart for other in found):
            found.append(float(grid[i]))
        if len(found) == CRITERIA.initial_guesses.lines:
            break
    return tuple(found)
