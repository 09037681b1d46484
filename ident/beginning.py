"""How a record begins: whether the machine was at rest, stood elsewhere, or was moving already."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ident.resolution import WHITE, noise_of, resolution
from ident.rounding import ROUNDING, TINY

Samples = NDArray[np.float64]
Beginning = Literal["at rest", "standing", "moving"]
SLOW = 0.05  # of the typical speed: slower is standing still
AT_ZERO = 0.02  # of the record's standard deviation: nearer is at zero, and as near is the same place
ERRORS = 4.0  # standard errors within which a value or a speed is nothing, too
MOST_NOISE = 0.03  # of the record's standard deviation: what is taken for noise, however rough the record
COARSEST = 0.1  # of the record's standard deviation: a coarser step is one of the signal, not of its reading
DRIVEN = 0.05  # of the command's standard deviation: a first value beyond it is a step at the first sample
STEP_ANSWER = 0.05  # of the record's standard deviation: what a record of a single step may begin at
LEAST_HELD = 16  # samples that a command is held
STILL = 0.25
"""[of the way that is expected of an output that integrates] Nearer it stands. Test: tests/preprocessing"""
SETS_OUT, SLOWLY = 1e-3, 0.1
"""[of the record's standard deviation], [of the typical speed] A motion that begins nearer to zero than the first, and
slower than the second, sets out from rest there; by chance about one record in ten thousand begins so.
Test: tests/fit/test_known_zeros.py::test_rest_tells_the_zero_and_its_standard_error"""
LOOKED_AT = 0.001  # s: the first samples, by which a speed is told, at least FEWEST
FEWEST = 4


def beginning(x: Samples, command: Samples | None, sample_rate: float, stepped: bool = False) -> Beginning:
    """How an output x (n,) begins under a command (n,), or none: what of its first state a model has to find.

    "at rest": it stands still at zero. "standing": it stands still elsewhere, under a command that is held there.
    "moving": what acted before the record still shows.

    A line is fitted to the first millisecond (at least 4 samples): a servo-hydraulic machine needs longer than
    that to follow a jump of its command; of few samples a second two say it. A command is `stepped` that is held from
    the first sample to the last. Still: speed below 5 % of the typical speed; at zero: value below 2 % of the
    record's deviation; or either within 4 standard errors of zero, or a reading in steps at the first step from zero.
    About one moving record in a thousand passes.
    """
    n = _first(x, sample_rate)
    size, speed = float(np.std(x)), float(np.std(x[n:] - x[:-n])) / n
    slope, value = np.polyfit(np.arange(n), x[:n], 1)
    noise = min(noise_of(x), MOST_NOISE * size) if len(x) > 8 else 0.0
    if command is not None and abs(command[0]) > DRIVEN * np.std(command):
        few = abs(x[0]) <= AT_ZERO * size and abs(x[1] - x[0]) <= SLOW * speed
        if few or (stepped and abs(x[0]) <= max(STEP_ANSWER * size, ERRORS * noise)):
            return "at rest"  # the step comes with the first sample, and what follows it is its answer
    slope_error = noise * np.sqrt(12.0 / (n * (n**2 - 1)))
    value_error = np.hypot(noise / np.sqrt(n), slope_error * (n - 1) / 2)
    step = found if (found := resolution(x)) <= COARSEST * size else 0.0
    still = abs(slope) <= max(SLOW * speed, ERRORS * slope_error)
    if still and abs(value) <= max(AT_ZERO * size, ERRORS * value_error, 1.5 * step):
        return "at rest"
    return "standing" if still and standing_for(x, command, sample_rate) else "moving"


def standing_for(x: Samples, command: Samples | None, sample_rate: float) -> int:
    """For how many samples the command is held first while the output x stands; 0 where it is not, or moves.

    Standing: the means of the quarters of this time lie, from each other and from the first samples, within 2 %
    of the record's standard deviation or four standard errors of their difference, those of the noise alone: what
    scatters for it moves does not stand. Fewer samples than 16 may be a step that has not arrived yet.
    """
    command = x if command is None else command
    changes = np.flatnonzero(np.abs(command - command[0]) > ROUNDING * np.abs(command).max())
    count = int(changes[0]) if len(changes) else 0
    if count < LEAST_HELD:
        return 0
    parts = (x[: _first(x, sample_rate)], *np.array_split(x[:count], 4))
    size, step = float(np.std(x)), resolution(x)
    noise = min(noise_of(x), MOST_NOISE * size) if len(x) > 8 else 0.0
    error = np.hypot(noise, step / WHITE) * np.sqrt(2.0 / min(map(len, parts)))
    return count if np.ptp([part.mean() for part in parts]) <= max(AT_ZERO * size, ERRORS * error) else 0


def held_still(x: Samples, command: Samples, neutral: float) -> list[float]:
    """The values at which a command (n,) is held away from a neutral while an output x (n,) that integrates it stands.

    Friction or a dead zone holds it there. What is `expected` is the way at the typical speed times the value's share
    of the command's deviation. Standing: the halves of the second half of this time lie nearer than a quarter of it.
    """
    found, ends = [], np.flatnonzero(np.abs(np.diff(command)) > ROUNDING * np.abs(command).max()) + 1
    typical, noise = np.std(np.diff(x)) / np.std(command), noise_of(x) if len(x) > 8 else 0.0
    for first, last in pairwise([0, *map(int, ends), len(x)]):
        if last - first >= LEAST_HELD:
            early, late = np.array_split(x[(first + last) // 2 : last], 2)
            expected = float(typical * abs(command[first] - neutral) * len(early))
            error = float(np.hypot(noise, resolution(x) / WHITE) * np.sqrt(2.0 / len(late)))
            if abs(late.mean() - early.mean()) + ERRORS * error <= STILL * expected:
                found.append(float(command[first]))
    return found


def zero_at_rest(x: Samples, begins: Beginning, sample_rate: float) -> tuple[float, float] | None:
    """What a transducer reads where the machine is at zero, and its standard error, by how its record x (n,) begins.

    At rest it is the mean of the first samples, known as well as noise and resolution let it; of a step's answer, and
    of a motion that sets out from zero, it is the first sample. The last is as far off as it reads: it set out a moment
    before. None where neither is so.
    """
    if len(x) <= FEWEST + 4:
        return None
    step, noise, n = resolution(x), noise_of(x), _first(x, sample_rate)
    least = max(ROUNDING * float(np.abs(x).max()), TINY)
    if begins == "at rest":
        n = n if abs(x[n - 1] - x[0]) <= ERRORS * noise + step else 1
        return float(x[:n].mean()), float(max(np.hypot(noise / np.sqrt(n), step / WHITE), least))
    size, typical = float(np.std(x)), float(np.std(x[n:] - x[:-n]))
    if begins == "moving" and abs(x[0]) <= SETS_OUT * size and abs(x[n] - x[0]) <= SLOWLY * typical:
        return 0.0, float(max(np.hypot(abs(x[0]), noise), least))
    return None


def _first(x: Samples, sample_rate: float) -> int:
    """The samples by which it is told."""
    return min(len(x), max(FEWEST, round(LOOKED_AT * sample_rate)))
