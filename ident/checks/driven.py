"""Whether a command that repeats itself drives an oscillation: its frequency is then a multiple of the command's."""

from __future__ import annotations

import numpy as np

from ident.noise.periodic import line_frequency
from ident.run import Samples

REPEATED = 0.9
"""Least correlation of a periodic command with itself a period later. Test: as below"""
NEAR, STEPS = 0.2, 1000
"""Cycles about a first value within which a line of a command lies, and the parts of that to which it is found.
Test: as below"""
HARMONICS = 5
"""Multiples of a line by which its frequency is found. Test: as below"""
DRIFT = 0.05
"""Turns by which an oscillation and the nearest multiple of a periodic command part over the record: one that parts by
less is driven. Of 117 sines of orders 2 to 39 the largest was 0.005. Test: tests/checks/test_self_oscillation.py"""


def is_multiple(command: Samples, frequency: float) -> bool:
    """Whether a command repeats itself and an oscillation (1/sample) is a multiple of its own frequency."""
    n = len(command)
    u = command - np.polyval(np.polyfit(np.arange(n), command, 1), np.arange(n))
    products = np.fft.irfft(np.abs(np.fft.rfft(u, 2 * n)) ** 2)[: n // 2] / np.arange(n, n - n // 2, -1)
    if not products[0] > 0:
        return False
    alike = products / products[0]
    fallen = int(np.argmax(alike < 0))  # before it does, a slow signal is like itself
    peaks = np.flatnonzero((alike[1:-1] >= REPEATED) & (alike[1:-1] >= alike[:-2]) & (alike[1:-1] >= alike[2:])) + 1
    peaks = peaks[peaks > fallen] if fallen else peaks[:0]
    if not len(peaks):
        return False
    period = _summit(alike, int(peaks[0]))
    period = _summit(alike, int(peaks[-1])) / max(1, round(peaks[-1] / period))  # of many, whose error is less
    highest = 1 + int(np.argmax(np.abs(np.fft.rfft(u * np.hanning(n)))[1:]))
    order = max(1, round(highest * period / n))  # of the strongest line of the command
    cycles = _refined(command, line_frequency(u, order * n / period)) / order
    return bool(abs(frequency * n - round(frequency * n / cycles) * cycles) < DRIFT)


def _refined(command: Samples, line: float) -> float:
    """The frequency of a line of a command, in cycles a record, near to a first value: by least squares."""
    from scipy.optimize import minimize_scalar  # noqa: PLC0415 - few records need it

    found = minimize_scalar(
        lambda tried: _left(command, tried),
        bounds=(line - NEAR, line + NEAR),
        method="bounded",
        options={"xatol": NEAR / STEPS},
    )
    return float(found.x)


def _left(command: Samples, line: float) -> float:
    """The power of a command that a constant, a line and its harmonics leave."""
    turn = 2.0 * np.pi * line * np.arange(len(command)) / len(command)
    angles = np.outer(turn, np.arange(1, HARMONICS + 1))
    table = np.column_stack([np.ones(len(command)), np.cos(angles), np.sin(angles)])
    return float(np.sum((command - table @ np.linalg.lstsq(table, command, rcond=None)[0]) ** 2))


def _summit(of: Samples, at: int) -> float:
    """The place of a peak between samples: of the parabola through three."""
    before, there, after = of[at - 1 : at + 2]
    bend = before - 2 * there + after
    return at + (0.5 * (before - after) / bend if bend else 0.0)
