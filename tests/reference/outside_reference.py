"""The linear actuator with one effect written as no list has it: a judge of what is said of what is not listed.

Of some the catalogue has the like since, for the search for terms beside it; `UNLISTED` are those that it does not
hold. Kutta's classical rule with many sub-steps a sample; flat, SI, from rest; the command is straight between samples.

    tau (1 + c |P| / P0) q' = Kp (u - y) - q - f q |P| / P0         loaded_lag; flow_force on the spool
    Q = Z0/A q (1 + d t) (1 + p sin(2 pi 23 t)) (1 + w)    gain_drift, pump_ripple, valve_temperature: w of the run
        (1 + g |P| / P0) (1 + b exp(-((x - X/4) / (X/4))²))     pressure_gain; gain_bump
        (1 + h sin(2 P / P0))                                   swinging_gain
    Ka P' = Q - Cl P - l Cl max(P, 0) - A (1 + a sgn v) v   one_way_leakage; unequal_areas
        - n Cl sgn(P) max(|P| - P0/2, 0)                    relief_leakage
    (m0 + mL) v' = A (1 + a sgn v) P - (c0 + cL) v - k x - F (x/X)² tanh(v/Vs)    position_friction
        - G t tanh(v/Vs) - d (x/X)² v                       growing_friction; position_damping
    y = x (1 + s (x/X)²)                                            sensor_curve, outside the loop
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from tests.reference import qian_reference as linear

Samples = NDArray[np.float64]
SUBSTEPS = 24
X, VS, P0, RIPPLE = 2e-3, 2e-4, 1e6, 2 * np.pi * 23.0


class Outside(NamedTuple):
    """Strengths, all off by default."""

    flow_force: float = 0.0
    gain_drift: float = 0.0  # 1/s
    pump_ripple: float = 0.0
    valve_temperature: float = 0.0
    position_friction: float = 0.0  # N
    sensor_curve: float = 0.0
    pressure_gain: float = 0.0
    one_way_leakage: float = 0.0
    unequal_areas: float = 0.0
    loaded_lag: float = 0.0
    gain_bump: float = 0.0
    relief_leakage: float = 0.0
    growing_friction: float = 0.0  # N/s
    position_damping: float = 0.0  # N s/m
    swinging_gain: float = 0.0


UNLISTED = (
    "gain_drift",
    "valve_temperature",
    "sensor_curve",
    "loaded_lag",
    "gain_bump",
    "relief_leakage",
    "growing_friction",
    "position_damping",
)


@njit(inline="always")
def derivative(plant, cell, o, warm, t, u, s, out):
    q, p, v, x = s[0], s[1], s[2], s[3]
    out[0] = (cell.gain * (u - x) - q - o.flow_force * q * abs(p) / P0) / (
        plant.tau * (1.0 + o.loaded_lag * abs(p) / P0)
    )
    gain = (1.0 + o.gain_drift * t) * (1.0 + o.pump_ripple * np.sin(RIPPLE * t)) * (1.0 + warm)
    gain *= 1.0 + o.pressure_gain * abs(p) / P0
    gain *= 1.0 + o.swinging_gain * np.sin(2.0 * p / P0)
    gain *= 1.0 + o.gain_bump * np.exp(-((4.0 * x / X - 1.0) ** 2))
    leak = plant.Cl * (p + o.one_way_leakage * max(p, 0.0))
    leak += plant.Cl * o.relief_leakage * np.sign(p) * max(abs(p) - 0.5 * P0, 0.0)
    area = plant.A * (1.0 + o.unequal_areas * np.sign(v))
    out[1] = (plant.Z0 / plant.A * q * gain - leak - area * v) / plant.Ka
    friction = (o.position_friction * (x / X) ** 2 + o.growing_friction * t) * np.tanh(v / VS)
    friction += o.position_damping * (x / X) ** 2 * v
    force = area * p - (plant.c0 + cell.damping) * v - cell.stiffness * x - friction
    out[2] = force / (plant.m0 + cell.mass)
    out[3] = v


@njit(nogil=True, cache=True)
def integrate(plant, cell, o, warm, command, rate):
    """Displacement (m), shape (n,), of one run."""
    s, trial, k = np.zeros(4), np.empty(4), np.empty((4, 4))
    out = np.zeros(len(command))
    h = 1 / (rate * SUBSTEPS)
    for n in range(len(command) - 1):
        out[n] = s[3] * (1.0 + o.sensor_curve * (s[3] / X) ** 2)
        rise = command[n + 1] - command[n]
        for step in range(SUBSTEPS):
            t = n / rate + step * h
            for stage in range(4):
                share = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                for i in range(4):
                    trial[i] = s[i] + (share * h * k[stage - 1, i] if stage else 0.0)
                u = command[n] + rise * (step + share) / SUBSTEPS
                derivative(plant, cell, o, warm, t + share * h, u, trial, k[stage])
            for i in range(4):
                s[i] += h / 6 * (k[0, i] + 2 * k[1, i] + 2 * k[2, i] + k[3, i])
    out[-1] = s[3] * (1.0 + o.sensor_curve * (s[3] / X) ** 2)
    return out


def measure_all(
    outside: Outside, runs: list[linear.Trial], plant: linear.Plant, *, seconds: float, noise: float, seed: int
) -> list[linear.Record]:
    """Every run, each with its own command, noise and temperature of the valve."""
    records = []
    for number, trial in enumerate(runs):
        rng = np.random.default_rng([seed, number])
        command = linear.band_limited_noise(round(seconds * linear.SAMPLE_RATE), trial.amplitude, rng)
        warm = outside.valve_temperature * rng.standard_normal()
        clean = integrate(plant, trial.cell, outside, warm, command, linear.SAMPLE_RATE)
        noisy = clean + noise * clean.std() * rng.standard_normal(len(clean))
        records.append(linear.Record(trial, command, noisy))
    return records
