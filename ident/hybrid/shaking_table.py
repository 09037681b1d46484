"""A shaking table: an actuator that gives its payload the acceleration of a record.

The displacement that is wanted is the record integrated twice, D(ω) = −H(ω) A(ω)/ω², with H = 1/(1 + (f₁/f)⁸) down to
a cosine from f₂ to 1.5 f₂: below the band (f₁, f₂) a table has no stroke for it. The command is computed ahead,
U = W D/G at first, with G the response of the sampled servo loop, and then improved on the model with all its effects,

    U ← U + W (D − Y)/G

as the control of shaking tables does on the table itself (iterative learning control).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import Case, Noise
from ident.hybrid.controller import AheadController, no_controller
from ident.hybrid.feedforward import command
from ident.hybrid.feedforward_tracking import plant_in
from ident.hybrid.linear_plant import linear_plant
from ident.hybrid.machine import Machine, machine
from ident.hybrid.rig_assembly import rig_of, run
from ident.hybrid.scores import rms
from ident.hybrid.state_space import sampled_plant
from ident.hybrid.substructure import wanted_of
from ident.presets.strano import STRANO

Array = NDArray[np.float64]
_ITERATIONS = 6
"""Improvements of the command on the model; the best one counts."""
_ENOUGH = 1e-4
"""Of the deviation of the wanted displacement: an error that needs no further improvement."""
_ABOVE = 2.0
"""Times the lowest frequency of the band from which the spectrum is compared: below it the filter takes some of it."""


@dataclass(frozen=True)
class Acceleration:
    """The acceleration of a table against that of its record, from `lowest` to `highest` Hz.

    `worst` (dB) is the largest difference of the spectra over thirds of an octave, at `worst_at` (Hz); `rms` the
    deviation of the difference over that of the record. `frequency` (Hz) and `level` (dB) are those of each third.
    """

    lowest: float
    highest: float
    worst: float
    worst_at: float
    rms: float
    frequency: tuple[float, ...]
    level: tuple[float, ...]


def acceleration(case: Case, measured: Array, record: Array) -> Acceleration:
    """Of a measured displacement (m) and the acceleration of the record (m/s²), (n,), at rest at both ends."""
    assert case.table is not None
    lowest, highest = _ABOVE * case.table[0], case.table[1]
    frequency = np.fft.rfftfreq(len(record), 1 / case.sample_rate)
    found = -((2 * np.pi * frequency) ** 2) * np.fft.rfft(measured)
    wanted = np.fft.rfft(record)
    edges = lowest * 2.0 ** (np.arange(int(3 * np.log2(highest / lowest)) + 1) / 3)
    level, centre = [], []
    for low, high in pairwise(edges):
        inside = (frequency >= low) & (frequency < high)
        power = [float(np.sum(np.abs(one[inside]) ** 2)) for one in (found, wanted)]
        if power[1] > 0:
            level.append(10 * float(np.log10(max(power[0], 1e-300) / power[1])))
            centre.append(float(np.sqrt(low * high)))
    band = (frequency >= lowest) & (frequency <= highest)
    left = [np.fft.irfft(np.where(band, one, 0.0), len(record)) for one in (found, wanted)]
    at = int(np.argmax(np.abs(level)))
    return Acceleration(lowest, highest, level[at], centre[at], rms(*left), tuple(centre), tuple(level))


def ahead_of(fit: FitResult, case: Case) -> AheadController:
    """The command of a table, computed ahead on the machine of a fit. Raises Unusable where none follows.

    A model with an inverse of its own (:mod:`ident.hybrid.feedforward`) has the command of that.
    """
    wanted = wanted_of(case, case.ground.samples(case.sample_rate))
    if fit.model == STRANO.name:
        given = command(plant_in(fit, case), wanted, case.sample_rate)
        sooner = np.concatenate([given[case.delay :], np.full(case.delay, given[-1])])
        return AheadController(sooner - wanted, case.sample_rate)
    of, inverse = machine(fit, case), _inverse(fit, case, len(wanted))
    given = best = _by(inverse, wanted)
    least = np.inf
    for _ in range(_ITERATIONS):
        measured = played(of, case, given)
        left = rms(measured, wanted) if np.isfinite(measured).all() else np.inf
        if left < least:
            best, least = given, left
        if left < _ENOUGH or not np.isfinite(left):
            break
        given = given + _by(inverse, wanted - measured)
    if not np.isfinite(least):
        raise Unusable("no-answer", "the machine does not follow the motion", "ground", "take a smaller motion")
    return AheadController(best - wanted, case.sample_rate)


def played(of: Machine, case: Case, given: Array) -> Array:
    """What a machine makes of a command (m), (n,): the displacement that is measured, without noise."""
    quiet, acting = replace(case, noise=Noise()), no_controller(case.sample_rate)
    _kept, rig = rig_of((of,), (quiet,), (acting,), given, np.array([np.inf]))
    run(rig, (acting,))
    return rig.y[:, 0]


def _inverse(fit: FitResult, case: Case, samples: int) -> NDArray[np.complex128]:
    """W/G at the frequencies of a record: the inverse of the sampled loop up to where the band has ended."""
    assert case.table is not None
    plant = linear_plant(fit, case.physical, case.gain, case.piston_area, case.supply_pressure)
    frequency = np.fft.rfftfreq(samples, 1 / case.sample_rate)
    used = frequency <= 1.5 * case.table[1]
    loop = sampled_plant(plant.model, case.sample_rate, case.delay)
    found = np.zeros(len(frequency), complex)
    found[used] = 1.0 / loop.response(np.exp(2j * np.pi * frequency[used] / case.sample_rate))[:, 0, 0]
    return found


def _by(inverse: NDArray[np.complex128], signal: Array) -> Array:
    """A signal through a response at the frequencies of its transform, (n,)."""
    return np.asarray(np.fft.irfft(inverse * np.fft.rfft(signal), len(signal)))


def command_text(command: Array, sample_rate: float) -> str:
    """The command (n,) in m as a table for a rig: time and command, a row a sample."""
    rows = (f"{k / sample_rate:.9g},{u:.9g}" for k, u in enumerate(command))
    return "\n".join(["time (s),command (m)", *rows, ""])
