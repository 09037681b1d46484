"""The laws by which a bench makes its currents (Kononykhin, section 5), each a controller that works once a sample.

It reads the position as its converter gives it. `memory` is a law's own, zero at the start of a record. Currents are
in rated currents, positions in m.
"""

from __future__ import annotations

from math import pi, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.bench.response import respond
from ident.simulation.jit import jit

Array = NDArray[np.float64]
STATIC, FREQUENCY, LEVELS, CONTINUOUS = range(4)
_HELD: Any = np.bool_(False)  # to numba a constant of Python would be a type of its own


@jit()
def saw_tooth(settings: Array, t: float, seen: float, first: float) -> float:
    """Static test: I = offset + gain (set − position), the set position a triangle of ±width at a constant rate.

    The offset is where the dead space is expected, so that the regulator need not cross it by its error alone.
    """
    offset, gain, rate, width = settings[:4]
    way = (t * rate / width) % 4.0
    tooth = way if way < 1.0 else (2.0 - way if way < 3.0 else way - 4.0)
    return float(offset + gain * (first + width * tooth - seen))


@jit()
def sine(settings: Array, t: float, step: float, seen: float, memory: Array) -> float:
    """Frequency test: I = offset + c + amplitude sin(2πft); c integrates how far the mean position moved in a period.

    It changes between periods only, so that it adds no harmonics to the current. `memory`: c, sum and number of
    positions in this period, the mean before, periods done.
    """
    offset, amplitude, frequency, gain = settings[:4]
    memory[1] += seen
    memory[2] += 1.0
    if memory[2] >= 1.0 / (frequency * step) - 0.5:
        mean = memory[1] / memory[2]
        if memory[4] > 0.0:
            memory[0] -= gain * (mean - memory[3])
        memory[1], memory[2], memory[3], memory[4] = 0.0, 0.0, mean, memory[4] + 1.0
    return float(offset + memory[0] + amplitude * sin(2.0 * pi * frequency * t))


@jit()
def fixed_level(settings: Array, t: float) -> float:
    """Speed test: a level, a rest, the level with the other sign, a rest."""
    offset, level, length, rest = settings[:4]
    place = t % (2.0 * (length + rest))
    sign = 1.0 if place < length + rest else -1.0
    return float(offset + (sign * level if place % (length + rest) < length else 0.0))


@jit()
def in_proportion(settings: Array, seen: float, first: float, memory: Array) -> float:
    """Speed test over a stroke: the current rises with the position up to the middle, falls behind it; then back.

    `memory`: strokes done, where this one began.
    """
    offset, lowest, highest, travel = settings[:4]
    begin = memory[1] if memory[0] > 0.0 else first
    share = abs(seen - begin) / travel
    if share >= 0.97:
        memory[0], memory[1], share = memory[0] + 1.0, seen, 0.0
    sign = 1.0 if memory[0] % 2.0 < 0.5 else -1.0
    return float(offset + sign * (lowest + (highest - lowest) * 2.0 * min(share, max(1.0 - share, 0.0))))


@jit(nogil=True, error_model="numpy")
def driven(
    law: int,
    settings: Array,
    step: float,
    steps: int,
    slope: float,
    last_bit: float,
    constants: Array,
    nodes: Array,
    pieces: Array,
    position: float,
    current: Array,
    out: Array,
) -> None:
    """Fill `current` (n,) by a law, and `out` (3, n) with what the actuator makes of it; `slope` limits dI/dt."""
    memory, state, part = np.zeros(5), np.zeros(4), np.empty((3, 2))
    state[0] = position
    for k in range(len(current)):
        t, seen = k * step, np.round(state[0] / last_bit) * last_bit
        if law == STATIC:
            wanted = saw_tooth(settings, t, seen, position)
        elif law == FREQUENCY:
            wanted = sine(settings, t, step, seen, memory)
        elif law == LEVELS:
            wanted = fixed_level(settings, t)
        else:
            wanted = in_proportion(settings, seen, position, memory)
        before = current[k - 1] if k > 0 else settings[0]
        current[k] = before + min(max(wanted - before, -slope * step), slope * step)
        if k == 0:
            state[1] = state[2] = current[0]
            state[3] = min(max(constants[2], current[0] - constants[1]), current[0] + constants[1])
        respond(current[max(k - 1, 0) : k + 1], step, steps, _HELD, constants, nodes, pieces, state, part)
        last = 1 if k > 0 else 0
        out[0, k], out[1, k], out[2, k] = part[0, last], part[1, last], part[2, last]
