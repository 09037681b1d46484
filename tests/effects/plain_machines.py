"""Machines with an effect that only some records can show, as SciPy integrates them from the physics.

Nothing but their numbers comes from the library.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy

from tests.reference.coupled_masses import Coupled

RATE, SECONDS = 100.0, 8.0
GAIN, TAU = 0.8, 0.4
MASS, DAMPING, STIFFNESS = 2.0, 3.0, 40.0
LAMINAR = 0.01  # m, level below which an outflow is
RANGE = 2.0  # m, of a gauge
CAUGHT = 0.3  # of what runs over
T = np.arange(round(RATE * SECONDS)) / RATE
LEVEL = 1.0 + 0.8 * np.sin(1.3 * T) + 0.15 * np.sin(5.0 * T)
FORCE = 40.0 * np.sin(2.0 * T) + 15.0 * np.sin(5.3 * T)
SPEED = 2.0 * np.cos(2.0 * T) + 1.5 * np.cos(5.3 * T)
SQUEEZE = 10.0 + 4.0 * np.sin(0.9 * T)


def at(samples: np.ndarray, t: float) -> float:
    place = min(t * RATE, len(T) - 1.0)
    before = min(int(place), len(T) - 2)
    return float(samples[before] + (place - before) * (samples[before + 1] - samples[before]))


def solved(
    rates: Callable[[float, np.ndarray], list[float]], states: int, start: list[float] | None = None
) -> np.ndarray:
    """The states at the samples, (states, n), from rest or from where they start.

    By LSODA without a line of Python between its steps.
    """
    begun = np.zeros(states) if start is None else start
    found = scipy.integrate.odeint(rates, begun, T, tfirst=True, rtol=1e-8, atol=1e-10, hmax=0.5 / RATE)
    return np.asarray(found.T)


def lag(back: Callable[[float], float] = lambda x: x, turned: float = 0.0, squared: float = 0.0) -> np.ndarray:
    """A level that is fed by the command and a part of its square, and falls back by what `back` says of it."""

    def rates(t: float, s: np.ndarray) -> list[float]:
        fed = at(LEVEL, t)
        rate = (GAIN * (fed + squared * fed**2) - back(s[0])) / TAU
        return [rate * (1.0 + turned * np.sign(rate))]

    return solved(rates, 1)[0]


def two_capacities(exchange: float, time: float) -> np.ndarray:
    """The same with a second level that fills from the first, which it takes from, and empties into it."""

    def rates(t: float, s: np.ndarray) -> list[float]:
        taken = exchange * (s[0] - s[1])
        return [(GAIN * at(LEVEL, t) - s[0] - taken) / TAU, (s[0] - s[1]) / time]

    return solved(rates, 2)[0]


def driven_with_hysteresis(share: float, inverse_way: float) -> np.ndarray:
    """The same fed by what lags behind the command by its way, after Coleman and Hodgdon, once the command has come."""
    fed, slopes = GAIN * LEVEL, GAIN * np.diff(LEVEL, append=LEVEL[-1]) * RATE

    def rates(t: float, s: np.ndarray) -> list[float]:
        slope = slopes[min(int(t * RATE), len(T) - 1)]
        missing = share * s[1] / inverse_way
        return [(at(fed, t) - missing - s[0]) / TAU, inverse_way * (slope - abs(slope) * s[1])]

    return solved(rates, 2, [0.0, 1.0 - np.exp(-inverse_way * fed[0])])[0]


def mass(resists: Callable[[float, float, float], float]) -> np.ndarray:
    """A mass on a spring and a damper that a force drives, against what else resists: a function of t, x and v."""

    def rates(t: float, s: np.ndarray) -> list[float]:
        x, v = s
        return [v, (at(FORCE, t) - DAMPING * v - STIFFNESS * x - resists(t, x, v)) / MASS]

    return solved(rates, 2)[0]


def beyond_speed(force: float, speed: float) -> float:
    """The part of a force that a drive lacks, which ends between 0.72 and 0.9 m/s in its own direction."""
    along = speed if force > 0 else -speed
    return force * float(np.interp(along, [0.72, 0.9], [0.0, 1.0]))


def tanks(edge: float) -> np.ndarray:
    """The lower of two tanks that run out by Torricelli's law; the upper runs over an edge, or with 0 over none."""

    def out(level: float) -> float:
        return float(level / np.sqrt(max(abs(level), LAMINAR)))

    def rates(t: float, s: np.ndarray) -> list[float]:
        over = 30.0 * out(s[0]) * max(s[0] / edge - 1.0, 0.0) if edge else 0.0
        return [(GAIN * at(LEVEL, t) - out(s[0]) - over) / TAU, (out(s[0]) + CAUGHT * over - out(s[1])) / TAU]

    return solved(rates, 2)[1]


def behind(samples: np.ndarray, lag: float) -> np.ndarray:
    """What follows the samples by a lag, from its first value on."""
    return solved(lambda t, s: [(at(samples, t) - samples[0] - s[0]) / lag], 1)[0] + samples[0]


def counted(share: float) -> np.ndarray:
    """The speed of a motor that a command drives, some of it without its sign."""
    speed = solved(lambda t, s: [(at(FORCE, t) - DAMPING * s[0]) / MASS], 1)[0]
    return speed + share * (np.abs(speed) - speed)


def counted_late(constant: float) -> np.ndarray:
    """The speed of the same motor behind a filter."""
    if not constant:
        return counted(0.0)
    return solved(lambda t, s: [(at(FORCE, t) - DAMPING * s[0]) / MASS, (s[0] - s[1]) / constant], 2)[1]


def behind_a_spring(seen: int, factor: float, omega: float = 5.0, ratio: float = 0.1) -> np.ndarray:
    """The speed of a drive (0), or of its load (1): 0.4 of the mass is behind a spring, ω its frequency alone."""
    if not factor:
        return counted(0.0)
    load = 0.4 * factor * MASS
    parts = Coupled(MASS - load, load, load * omega**2, between=2.0 * ratio * omega * load, of_drive=DAMPING)
    return parts.moved(lambda t: at(FORCE, t), T)[seen]


def moved() -> np.ndarray:
    """The force of a spring and a damper that are moved at a given speed."""
    way = scipy.integrate.cumulative_trapezoid(SPEED, dx=1.0 / RATE, initial=0.0)
    return np.asarray(STIFFNESS * way + DAMPING * SPEED)


def played(friction: float, half_width: float = 0.2, contact: float = 0.1, fine: int = 64) -> np.ndarray:
    """The force of a spring and a damper with a slider behind a play and a spring of contact, moved at a speed."""
    speed = np.interp(np.arange((len(T) - 1) * fine + 1) / fine, np.arange(len(T)), SPEED)
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1])) / (RATE * fine)])
    carried, slider, reach = np.zeros(len(way)), 0.0, half_width + contact
    for i, x in enumerate(way):
        slider = min(max(slider, x - reach), x + reach)
        carried[i] = np.sign(x - slider) * max(abs(x - slider) - half_width, 0.0) / contact
    return np.asarray((STIFFNESS * way + DAMPING * speed + friction * carried)[::fine])


def degraded(force: float, way: float = 0.3, loss: float = 0.2, pinched: float = 0.6) -> np.ndarray:
    """The force of a spring and a damper with Bouc and Wen's hysteresis that degrades and pinches, after Baber."""

    def rates(t: float, s: np.ndarray) -> list[float]:
        _x, z, energy = s
        v, weaker = at(SPEED, t), 1.0 + loss * energy
        slip = 1.0 - pinched * (1.0 - np.exp(-energy)) * np.exp(-((z / 0.4) ** 2))
        return [v, slip * (v - weaker * 0.5 * (abs(v) * z + v * abs(z))) / weaker / way, z * v / way]

    x, z, _ = solved(rates, 3)
    return STIFFNESS * x + DAMPING * SPEED + force * z


def kinked(stiffness: float, beyond: float) -> np.ndarray:
    """The force of a spring and a damper with another stiffness beyond a way to both sides, moved at a speed."""
    way = scipy.integrate.cumulative_trapezoid(SPEED, dx=1.0 / RATE, initial=0.0)
    return moved() + stiffness * np.sign(way) * np.maximum(np.abs(way) - beyond, 0.0)


def stiffer_beyond(stiffness: float, way: float) -> np.ndarray:
    """The force of a spring and a damper with another stiffness beyond a displacement, to that side alone."""
    x = scipy.integrate.cumulative_trapezoid(SPEED, dx=1.0 / RATE, initial=0.0)
    return moved() + stiffness * np.where(x > way, x - way, 0.0)


def relaxed(stiffness: float, time: float = 0.2) -> np.ndarray:
    """The force of a spring and a damper with a spring and a damper in series (Maxwell) that relaxes, moved at a
    speed."""
    return moved() + stiffness * solved(lambda t, s: [at(SPEED, t) - s[0] / time], 1)[0]


def dry(v: float) -> float:
    """The direction of sliding; so steep that what creeps is far below what is compared."""
    return float(np.tanh(v / 1e-4))
