"""The frequency procedure (Kononykhin, section 5.2): amplitude and phase characteristics, a period at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.records import Record
from ident.bench.sine_fit import as_printed, dominant, fit_sine
from ident.errors import Unusable
from ident.rounding import TINY
from ident.words.run_name import run_name

Array = NDArray[np.float64]
_OF = BENCH_CRITERIA.frequency
_LEVELS = 20
"""Of amplitudes an e-fold, by which points are listed. No answer depends on it: it is an order of lines."""


@dataclass(frozen=True)
class Response:
    """One frequency and amplitude: means over the periods, with their scatter.

    `amplitude` of the current (rated currents), `gain` in m a rated current, `phase` in rad behind the current,
    `centre` (m) in whose vicinity it was measured, `drift` in m/s, `distortion` the part of the position that is no
    sine (RMS over RMS), `as_printed` the relative difference of the amplitude that the printed iteration finds.
    """

    id: str
    frequency: float
    amplitude: float
    gain: float
    phase: float
    centre: float
    drift: float
    distortion: float
    gain_deviation: float
    phase_deviation: float
    periods: int
    as_printed: float


def frequency_response(records: Sequence[Record]) -> tuple[Response, ...]:
    """One point for each record, by amplitude and frequency."""
    points = [point(record) for record in records]
    return tuple(sorted(points, key=lambda p: (round(np.log(p.amplitude) * _LEVELS), p.frequency)))


def point(measured: Record) -> Response:
    """The sine of the position against that of the current. Raises Unusable where there is no whole period."""
    frequency = measured.frequency or dominant(measured.current, measured.rate)
    record = measured.reduced(_OF.samples_of_a_period * frequency)
    alpha = 2 * np.pi * frequency * record.time
    drive = fit_sine(alpha, record.current, drift=True)
    count = int(np.floor(alpha[-1] / (2 * np.pi) + _OF.lacking))
    if count < 1 or drive.a2 <= 0:
        raise Unusable(
            "no-period",
            f"the record holds no whole period of {frequency:g} Hz",
            run_name(record.id),
            "record at least two periods, or correct frequency",
        )
    first = 1 if count > 1 else 0  # the first period holds the start
    edges = [round(i * record.rate / frequency) for i in range(first, count + 1)]
    fits = [fit_sine(alpha[a:b], record.position[a:b], drift=True) for a, b in pairwise(edges)]
    amplitude = np.array([fit.a2 for fit in fits])
    lag = np.unwrap([drive.a3 - fit.a3 for fit in fits]) % (2 * np.pi)
    last = slice(edges[-2], edges[-1])
    plain, printed = fit_sine(alpha[last], record.position[last]), as_printed(alpha[last], record.position[last])
    many = max(len(fits), 1) ** 0.5
    return Response(
        record.id,
        frequency,
        drive.a2,
        float(amplitude.mean() / drive.a2),
        float(np.mean(lag)),
        float(np.mean([fit.a1 for fit in fits])),
        float(np.mean([fit.drift for fit in fits])) * 2 * np.pi * frequency,
        float(np.mean([fit.rms for fit in fits]) / max(amplitude.mean() / np.sqrt(2), TINY)),
        float(amplitude.std() / drive.a2 / many),
        float(np.std(lag) / many),
        len(fits),
        printed.a2 / plain.a2 - 1.0,
    )
