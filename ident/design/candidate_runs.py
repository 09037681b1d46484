"""The runs that a lab could add to a matrix."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np

from ident.design.excitation import PERIODIC, SIGNALS
from ident.design.experiment import Experiment
from ident.matrix import Matrix
from ident.noise.repeats import at_rest
from ident.run import Run

_LARGER = 1.5  # times the largest amplitude of the matrix is the most that is proposed
_STROKE = 0.45  # of the stroke, to either side, is the most that a command may reach
_SPECIMENS, _GAINS, _AMPLITUDES = 4, 3, 3
_SHARES = (1 / 30, 1 / 8, 1 / 3)  # of the band, where sines and saw-teeth are tried
_LONGEST = {"s": 60.0, "sample": 65536.0}
_SAMPLES = 1000
_PEAKS = 3.0  # times its RMS are those of band-limited noise


def candidate_runs(matrix: Matrix, band: float, seed: int = 0) -> Iterator[Experiment]:
    """The runs that the lab could add: specimens of the matrix, gains and amplitudes of it and between, four signals.

    No gain beyond those of the matrix, no amplitude above 1.5 times its largest nor beyond the stroke.
    """
    runs = matrix.runs
    first = runs[0]
    longest = max(_LONGEST[first.time_unit], _SAMPLES / first.sample_rate)  # of a slow machine longer
    seconds = min(float(np.median([run.duration for run in runs])), longest)
    specimens = _spread([*dict.fromkeys(run.specimen for run in runs)], _SPECIMENS)
    stated = sorted({run.gain for run in runs if run.gain is not None})
    gains: list[float | None] = [*_between(stated, _GAINS)] or [None]
    sizes = sorted(size for run in runs if (size := _rms(run)) > 0)
    if not sizes:  # nothing was ever commanded
        return
    within = _between([float(f"{size:.3g}") for size in (sizes[0], sizes[-1])], _AMPLITUDES)
    amplitudes = [within[0] / 2, *within, _LARGER * sizes[-1]]
    edge = min(band / (2 * np.pi) / 1.25, 0.4 * first.sample_rate)  # the band has a margin that the command has not
    for specimen, gain, amplitude, signal in product(specimens, gains, amplitudes, SIGNALS):
        for share in _SHARES if signal in PERIODIC else (1.0,):
            found = Experiment(
                specimen=specimen,
                gain=gain,
                amplitude=amplitude,
                signal=signal,
                frequency=share * edge,
                seconds=seconds,
                sample_rate=first.sample_rate,
                seed=seed,
                unit=first.units.get("command", "m"),
                time_unit=first.time_unit,
            )
            if share * edge * seconds >= 2 and _within_stroke(found, matrix.actuator.stroke):
                yield found


def _rms(run: Run) -> float:
    """RMS of the command about its mean; of a step that lasts, that of a noise whose peaks go as far."""
    if at_rest(run.command):
        return float(np.abs(run.command).max()) / _PEAKS
    return float(np.std(run.command))


def _between(values: Sequence[float], count: int) -> list[float]:
    """The values, evenly spread where there are many, with geometric means between where there are few."""
    found = sorted(set(values))
    while 1 < len(found) < count and found[-1] > 1.02 * found[0]:
        widest = max(range(len(found) - 1), key=lambda i: found[i + 1] / found[i])
        found.insert(widest + 1, float(f"{np.sqrt(found[widest] * found[widest + 1]):.3g}"))
    return _spread(found, count)


def _spread(values: Sequence[Any], count: int) -> list[Any]:
    if len(values) <= count:
        return list(values)
    return [values[round(i * (len(values) - 1) / (count - 1))] for i in range(count)]


def _within_stroke(experiment: Experiment, stroke: float | None) -> bool:
    return stroke is None or float(np.abs(experiment.command()).max()) <= _STROKE * stroke
