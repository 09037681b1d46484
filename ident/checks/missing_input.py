"""An input that is not in the record: from the same state, under the same inputs, the output rests or moves.

A machine whose inputs rest stays where it came to rest. Leakage, gravity, creep and bias move it at the same speed from
the same state. Where it rests first and then sets out by itself, as fast as it is driven at other times, something else
drove it. What always sets out the same time after a change of its inputs is a delay. An oscillation that grows from
rest does not reach such a distance in its first swing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from ident.checks.at_rest import HELD, acting, held, spans
from ident.checks.finding import Finding
from ident.run import BENCH, Run, Samples
from ident.words.message import Message, message

TRAVEL = 0.1  # of the output's range: how far it goes when it sets out, in the time that its quick motions take
QUICK = 0.9  # share of its motions that are slower than a quick one
RESTS = 0.02  # of its range, within which it rests: more than the noise and the digit of most records
REST = 2  # durations of a quick motion for which it has rested before it sets out
LEAST = 2  # times that it sets out: a single one may be a mishap
LONGEST = 0.05  # of the record, the duration of a quick motion: what is slower shows no rest
SHORTEST = 8  # samples of a quick motion
SPIKE = 5  # samples, of which the median is taken: a wrong sample or two are no motion


@dataclass(frozen=True)
class MissingInput:
    """A stretch of a run, from `start` to `end` in s (or samples), in which the output set out while all inputs rested.

    `evidence` is what the run shows of it.
    """

    run: str
    start: float
    end: float
    evidence: Message

    def to_json(self) -> dict[str, str | float]:
        """In the contract's words."""
        return {"run": self.run, "from": self.start, "to": self.end, "evidence": str(self.evidence)}


def missing_input(run: Run) -> Iterator[Finding]:
    """A doubt where an input of the run is not recorded."""
    for stretch in missing_inputs(run)[:1]:
        yield Finding.of(run.id, "doubt", "missing-input", message("check.missing_input", evidence=stretch.evidence))


def missing_inputs(run: Run) -> tuple[MissingInput, ...]:
    """The stretches in which the output set out from rest while every input rested."""
    inputs = acting(run)
    if run.kind in BENCH or not inputs or np.ptp(run.measured) == 0 or not held(inputs, (REST + 1) * SHORTEST).any():
        return ()
    y = np.asarray(median_filter(run.measured, SPIKE), np.float64)
    motion = _quick(y)
    rest = REST * motion
    if run.length <= rest + motion:
        return ()
    at_rest = held(inputs, rest + motion)
    begins = [int(k[0]) for k in _neighbours(np.flatnonzero(_sets_out(y, motion)), rest) if at_rest[k].all()]
    changes = np.flatnonzero(np.any([np.abs(np.diff(u, prepend=u[0])) > HELD * np.ptp(u) for u in inputs], axis=0))
    since = [begin - max(changes[changes <= begin], default=-rest) for begin in begins]
    if len(begins) < LEAST or max(since) - min(since) <= motion:
        return ()
    evidence = _evidence(run, y, motion, begins, at_rest)
    times = [(begin + rest) / run.sample_rate for begin in begins]
    return tuple(MissingInput(run.id, time, time + motion / run.sample_rate, evidence) for time in times)


def _quick(y: Samples) -> int:
    """The samples in which a quick motion of the output goes the travel."""
    samples = SHORTEST
    while samples < LONGEST * len(y) and np.quantile(np.abs(y[samples:] - y[:-samples]), QUICK) < TRAVEL * np.ptp(y):
        samples += 1 + samples // 4
    return samples


def _sets_out(y: Samples, motion: int) -> NDArray[np.bool_]:
    """Whether the output rests from each sample on, and then goes the travel, (n − rest − motion,)."""
    rest, extent = REST * motion, np.ptp(y)
    distance = np.abs(y[rest + motion :] - y[rest:-motion])
    return np.asarray((spans(y, rest)[: len(distance)] <= RESTS * extent) & (distance >= TRAVEL * extent))


def _neighbours(places: NDArray[np.intp], apart: int) -> list[NDArray[np.intp]]:
    """The samples in groups that lie farther apart."""
    groups = np.split(places, np.flatnonzero(np.diff(places) > apart) + 1)
    return [group for group in groups if len(group)]


def _evidence(run: Run, y: Samples, motion: int, begins: Sequence[int], at_rest: NDArray[np.bool_]) -> Message:
    """How often and when it set out, and in which share of the rest of its inputs it moves at half of that speed."""
    rest, unit = REST * motion, run.units.get(run.output, "1")
    distance = np.abs(y[motion:] - y[:-motion])
    moved = distance[rest:][: len(at_rest)][at_rest[: len(distance) - rest]]
    least = 0.5 * min(distance[begin + rest] for begin in begins)
    by_time = unit.removesuffix("/s") + "/s²" if unit.endswith("/s") else f"{unit}/{run.time_unit}"
    speed = least * run.sample_rate / motion, by_time
    return message(
        "missing_input", run=run.id, output=run.output, count=len(begins), start=(begins[0] + rest) / run.sample_rate,
        unit=run.time_unit, share=float(np.mean(moved >= least)), speed=speed,
    )  # fmt: skip
