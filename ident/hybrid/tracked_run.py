"""A recorded run tracked as if it came in now: τyr and kyr over time, with their standard deviations and a verdict."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.hybrid.innovation_test import InnovationTest
from ident.hybrid.tracking import GAIN, TAU, Noise, Tracker
from ident.matrix import Matrix
from ident.run import Run
from ident.words.engineering import quantity
from ident.words.message import message
from ident.words.nearest import did_you_mean
from ident.words.number import plain, trimmed
from ident.words.result_tables import Listing, TabularResult
from ident.words.run_name import run_name

Array = NDArray[np.float64]
ROWS = 4096
"""Rows that a file or a figure holds at most: of a longer run every n-th sample."""
_SETTLED = 0.1  # of a run, in which the filter finds its way
_START = 20.0  # samples, where the clock is unknown
_LEAST = 1e-4  # of the output's deviation: no sensor has less noise
_GAIN_OF_DIFFERENCES = np.sqrt(70.0)  # of the fourth difference on white noise


@dataclass(frozen=True, eq=False)
class Track(TabularResult):
    """One run: times t (s, or samples), τ, k and their standard deviations, all (n,); noise assumed, and verdict."""

    run: Run
    noise: Noise
    t: Array
    tau: Array
    gain: Array
    std_tau: Array
    std_gain: Array
    verdict: InnovationTest

    def listings(self) -> Iterator[Listing | str]:
        """The last estimates, the noise, and the verdict."""
        clock = "s" if self.run.time_unit == "s" else "samples"
        rows = [
            ("τyr", quantity(float(self.tau[-1]), clock), quantity(float(self.std_tau[-1]), clock)),
            ("kyr", plain(float(self.gain[-1])), plain(float(self.std_gain[-1]), 2)),
        ]
        yield Listing("", (f"{run_name(self.run.id)}, at its end", "value", "std"), rows, ("value", "std"))
        said, unit = self.verdict, self.run.units.get(self.run.output, "m")
        mean = "unknown" if said.nis_mean is None else plain(said.nis_mean)
        noise = quantity(self.noise.measurement, unit)
        yield f"noise of the sensor {noise}; mean normalised innovation squared {mean}"
        yield str(message("track.holds" if said.holds else "track.fails", reason=said.reason))

    @property
    def shown(self) -> slice:
        """The samples that a file or a figure holds: evenly spaced, the last among them."""
        step = -(-len(self.t) // ROWS)
        return slice((len(self.t) - 1) % step, None, step)

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data, by the contract's names; SI."""
        columns = {
            name: getattr(self, name)[self.shown].tolist() for name in ("t", "tau", "gain", "std_tau", "std_gain")
        }
        said = self.verdict
        return {
            "run": self.run.id,
            "nis_mean": said.nis_mean,
            "holds": said.holds,
            "reason": said.reason,
            "outliers": said.outliers,
            "changes": said.changes,
            "noise": vars(self.noise),
            **columns,
        }


def track(run: Run, measurement: float | None = None) -> Track:
    """Follow a run from its command to its measured output, by its `hold`.

    `measurement` is the standard deviation of the sensor's noise, m; without it the noise is that of the record's
    fourth differences. The fictitious noise follows from it by the rule of :meth:`Noise.of_sensor`, for the way and the
    speed of this command. Raises Unusable where the run has no command, or one that does not move.
    """
    r, y = _samples(run)
    if measurement is not None and not 0 < measurement < np.inf:
        raise Unusable("bad-noise", f"noise of {measurement:g}", "noise", "give a standard deviation above 0")
    noise = Noise.of_sensor(run.sample_rate, measurement or sensor_noise(y), *_motion(run, r))
    alike = run.units.get("command", "m") == run.units.get(run.output, "m")
    gain0 = GAIN if alike else float(np.std(y) / np.std(r))
    tracker = Tracker(run.sample_rate, run.hold, TAU if run.time_unit == "s" else _START, gain0, noise)
    rows = tracker.block(r, y)
    tau, gain, var_tau, var_gain = rows[:, 0], rows[:, 1], rows[:, 3], rows[:, 4]
    said = tracker.verdict
    if not said.holds:
        said = replace(said, reason=f"{said.reason}; {_ranges(tau, gain, run.time_unit)}")
    return Track(run, noise, np.arange(len(r)) / run.sample_rate, tau, gain, np.sqrt(var_tau), np.sqrt(var_gain), said)


def chosen(matrix: Matrix, run: str | None) -> Run:
    """The run of that id; without one the first. Raises Unusable where there is none of that id."""
    for candidate in matrix.runs:
        if run is None or candidate.id == run:
            return candidate
    names = [candidate.id for candidate in matrix.runs]
    remedy = did_you_mean(str(run), names, f"choose from {', '.join(names[:5])}")
    raise Unusable("unknown-run", f"the matrix has no run {run!r}", "run", remedy)


def sensor_noise(y: Array) -> float:
    """The standard deviation of white noise in a record, of its fourth differences, in which slow motion vanishes."""
    told = float(np.std(np.diff(y, 4)) / _GAIN_OF_DIFFERENCES) if len(y) > 8 else 0.0
    return max(told, _LEAST * float(np.std(y)))


def _samples(run: Run) -> tuple[Array, Array]:
    if "command" not in run.channels:
        raise Unusable(
            "missing-channel", "no command channel, which a loop follows", run_name(run.id), "name its column"
        )
    r, y = run.command, run.measured
    if len(r) < 2 or not (np.std(r) > 0 and np.std(y) > 0):
        raise Unusable("no-motion", "command or output does not move", run_name(run.id), "track a run that moves")
    return r, y


def _motion(run: Run, r: Array) -> tuple[float, float]:
    """RMS of the command's way and of its speed."""
    return float(np.std(r)), float(np.sqrt(np.mean(np.diff(r) ** 2)) * run.sample_rate)


def _ranges(tau: Array, gain: Array, clock: str) -> str:
    """Between which values the parameters ran, in words: their 10th and 90th percentiles."""
    settled = slice(int(_SETTLED * len(tau)), None)
    factor, unit = (1e3, "ms") if clock == "s" else (1.0, "samples")
    (low, high), (least, most) = (np.percentile(part[settled], (10, 90)) for part in (factor * tau, gain))
    return (
        f"τyr runs from {plain(low, 3)} to {plain(high, 3)} {unit}, "
        f"kyr from {trimmed(round(least, 2))} to {trimmed(round(most, 2))}"
    )
