"""The fifth-order actuator of the hybrid-simulation paper, flat, from its equations (1) to (4) alone.

    vc = ve0 + kep u (u >= 0), ve0 + ken u (u < 0)         the driver
    ve'' + 2 xi wn ve' + wn² ve = wn² vc                    the valve
    QL = DZ(ve) sqrt(Ps - sgn(ve) PL)                       DZ: kqp (ve - vep) above vep, kqn (ve - ven) below ven
    C PL' = QL - Ap y'
    m y'' = Ap PL - sigma y' - (Fc + mu N) sgn y' - S(y, y')

u is the command in V, or K (r - y) under a position loop. Steps are so small that a Runge-Kutta step of them is exact
to what the tests ask (halving them is a test); dry friction sticks exactly: the table stands while the force on it is
below the friction; where its speed changes its sign within a step it stays there, or turns with the friction.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

BAR = 1e5
RATE = 1000.0  # Hz
FINE = 40  # steps a sample


class Machine(NamedTuple):
    """The parameters in SI and V, assumed from the ratings of the rig: 190 kN, 2.2 m/s, ±0.2 m."""

    ve0: float = 0.06
    kep: float = 0.52
    ken: float = 0.47
    wn: float = 210.0
    xi: float = 0.85
    ven: float = -0.35
    vep: float = 0.45
    kqn: float = 9.0e-7
    kqp: float = 1.0e-6
    C: float = 1.1e-12
    m: float = 480.0
    sigma: float = 2.2e4
    Fc: float = 900.0
    mu: float = 0.006


NAMES = Machine._fields
AREA = 9.05e-3  # m²
SUPPLY = 210.0 * BAR
FREQUENCY, AMPLITUDE = 1.0, 0.05  # Hz and m: the sine of a test
ROUGH, EDGE = 8e-3, 20.0  # m RMS and Hz: the noise on it
APART = 0.3  # of each parameter: how far a drawn machine is from the assumed one


class Shown(NamedTuple):
    """What is recorded, sample by sample: m, Pa, V, m/s, V."""

    displacement: np.ndarray
    load_pressure: np.ndarray
    spool: np.ndarray
    velocity: np.ndarray
    drive: np.ndarray


@njit(cache=True)
def _rates(p, area, supply, load, u, ve, dve, P, v, stuck, rates):
    ve0, kep, ken, wn, xi, ven, vep, kqn, kqp, C, m, sigma, _Fc, _mu = p
    vc = ve0 + (kep * u if u >= 0.0 else ken * u)
    Q = 0.0
    if ve > vep:
        Q = kqp * (ve - vep) * np.sqrt(max(0.0, supply - P))
    elif ve < ven:
        Q = kqn * (ve - ven) * np.sqrt(max(0.0, supply + P))
    rates[0] = dve
    rates[1] = wn * wn * (vc - ve) - 2.0 * xi * wn * dve
    rates[2] = (Q - area * v) / C
    force = area * P - sigma * v - load
    rates[3] = 0.0 if stuck != 0.0 else force / m
    rates[4] = v


@njit(cache=True)
def _run(p, area, supply, vertical, gain, command, fine, rate, spring, damping):
    """`gain` 0: the command is a voltage. `spring`, `damping`: a specimen, N/m and N·s/m."""
    count, h = len(command), 1.0 / (rate * fine)
    out = np.zeros((count, 5))
    state = np.zeros(5)
    state[0] = p[0]
    k1, k2, k3, k4, at = np.zeros(5), np.zeros(5), np.zeros(5), np.zeros(5), np.zeros(5)
    for k in range(count):
        last = min(k + 1, count - 1)
        out[k, 0], out[k, 1], out[k, 2], out[k, 3] = state[4], state[2], state[0], state[3]
        out[k, 4] = gain * (command[k] - state[4]) if gain > 0.0 else command[k]
        for i in range(fine):
            part = i / fine
            Ps = supply[k] + part * (supply[last] - supply[k])
            limit = p[12] + p[13] * (vertical[k] + part * (vertical[last] - vertical[k]))
            force = area * state[2] - p[11] * state[3] - spring * state[4] - damping * state[3]
            side = 1.0 if state[3] > 0.0 else -1.0
            stuck = 0.0
            if state[3] == 0.0:
                stuck = 1.0 if abs(force) <= limit else 0.0
                side = 1.0 if force > 0.0 else -1.0
            for stage in range(4):
                share = part + (0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)) / fine
                r = command[k] + share * (command[last] - command[k])
                for j in range(5):
                    if stage == 0:
                        at[j] = state[j]
                    elif stage == 1:
                        at[j] = state[j] + 0.5 * h * k1[j]
                    elif stage == 2:
                        at[j] = state[j] + 0.5 * h * k2[j]
                    else:
                        at[j] = state[j] + h * k3[j]
                u = gain * (r - at[4]) if gain > 0.0 else r
                load = side * limit + spring * at[4] + damping * at[3]
                into = k1 if stage == 0 else (k2 if stage == 1 else (k3 if stage == 2 else k4))
                _rates(p, area, Ps, load, u, at[0], at[1], at[2], at[3], stuck, into)
            before = state[3]
            for j in range(5):
                slopes = k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]
                state[j] += h / 6.0 * slopes
            if stuck != 0.0:
                state[3] = 0.0
            elif before != 0.0 and state[3] * before < 0.0:  # it stops within the step, and stays or turns
                rest = h * state[3] / (state[3] - before)
                force = area * state[2] - spring * state[4]
                turned = 1.0 if force > 0.0 else -1.0
                state[3] = rest * (force - turned * limit) / p[10] if abs(force) > limit else 0.0
    return out


def respond(machine, command, gain=0.0, supply=SUPPLY, vertical=0.0, fine=FINE, rate=RATE, spring=0.0, damping=0.0):
    """The machine from rest. `command` (n,) in V where the gain (V/m) is 0, else in m; supply (Pa) and vertical load
    (N) are numbers or records."""
    n = len(command)
    wide = [np.array(np.broadcast_to(np.asarray(x, float), (n,))) for x in (supply, vertical)]  # of one type
    columns = _run(np.array(machine), AREA, *wide, float(gain), np.array(command, float), fine, rate, spring, damping)
    return Shown(*columns.T)


def motion(seconds=8.0, rate=RATE, amplitude=AMPLITUDE, noise=ROUGH, seed=0, still=0.05):
    """A sine of 1 Hz and band-limited noise to 20 Hz (RMS `noise`), m, after `still` s at zero, begun within 0.2 s."""
    rng = np.random.default_rng(seed)
    n = round(seconds * rate)
    t = np.arange(n) / rate - still
    spectrum = np.zeros(n // 2 + 1, complex)
    inside = (np.fft.rfftfreq(n, 1.0 / rate) > 0) & (np.fft.rfftfreq(n, 1.0 / rate) <= EDGE)
    spectrum[inside] = np.exp(2j * np.pi * rng.uniform(size=inside.sum()))
    rough = np.fft.irfft(spectrum, n)
    begun = np.clip(t / 0.2, 0.0, 1.0) ** 2
    return np.where(t > 0, begun * (amplitude * np.sin(2 * np.pi * FREQUENCY * t) + noise * rough / rough.std()), 0.0)


def drawn(rng):
    """A machine drawn around the assumed one: each parameter by up to 30 % of itself."""
    return Machine(*(value * rng.uniform(1.0 - APART, 1.0 + APART) for value in Machine()))
