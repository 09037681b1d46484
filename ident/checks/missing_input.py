"""An input that is not in the record: from the same state, under the same inputs, the output rests or moves.

A machine whose inputs rest stays where it came to rest. Leakage, gravity, creep and bias move it at the same speed from
the same state. Where it sets out by itself, as fast as it is driven at other times, something else drove it. What
always sets out the same time after a change of its inputs is a delay. What turns round again and again once it has set
out is an oscillation. What stood off the command of its loop and sets out to it is driven by its controller, whose
integral action grows until friction at rest gives way: hunting (Armstrong-Hélouvry, Dupont and Canudas de Wit 1994).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy  # ndimage, which takes long to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.checks.at_rest import HELD, acting, held, spans
from ident.checks.finding import Finding
from ident.checks.setting_out import FAST, QUICK, REST, SLOW, Motion
from ident.resolution import resolution, step_between
from ident.run import BENCH, Run, Samples
from ident.words.message import Message, message

TRAVEL = 0.1  # of how far the output goes in a twentieth of the record: its way in the time of a quick motion
LONGEST = 0.05  # of the record, the duration of a quick motion: what is slower shows no rest
SHORTEST = 8  # samples of a quick motion
FINER = 4  # durations of a quick motion that are looked at, each half of the one before: a short rest needs a short one
DIGITS = 10  # steps of a reading that a quick motion goes at least: one that creeps shows step by step
LEAST = 3  # times that it sets out: one or two may be a mishap
MOST = 0.1, 0.9  # quantiles between which most starts lie: what comes after one time, but for these, is a delay
AHEAD, SWINGS = 12, 4  # durations of a quick motion in which an oscillation has turned so many times
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
    if run.kind in BENCH or not inputs or np.ptp(run.measured) == 0 or not held(inputs, (REST + 2) * SHORTEST).any():
        return ()
    y = np.asarray(scipy.ndimage.median_filter(run.measured, SPIKE), np.float64)
    extent = _extent(y)
    longest, travel, changes = _quick(y, extent), TRAVEL * extent, _changes(inputs)
    for half in range(FINER):
        samples = longest // 2**half
        if (half and samples < SHORTEST) or run.length <= (REST + 2) * samples:
            break
        at_rest = _at_rest(inputs, samples)
        least = max(travel / 2**half, DIGITS * resolution(run.measured), _answer(y, changes, samples, longest))
        motion = Motion.of(y, samples, least, at_rest)
        begins = motion.starts(at_rest)
        begins = [k for k in begins if _turns(motion.way[k : k + AHEAD * samples], FAST * motion.quick) < SWINGS]
        begins = [k for k in begins if _beyond_steps(run.measured, k, samples)]
        begins = [k for k in begins if np.ptp(motion.output[k : k + longest]) >= FAST * travel]  # or it is a ripple
        begins = [k for k in begins if not _towards_command(run, motion, k)]
        if _by_itself(changes, begins, longest, samples):
            evidence = _evidence(run, motion, begins, at_rest)
            times = [begin / run.sample_rate for begin in begins]
            return tuple(MissingInput(run.id, time, time + samples / run.sample_rate, evidence) for time in times)
    return ()


def _at_rest(inputs: Sequence[Samples], samples: int) -> NDArray[np.bool_]:
    """Whether every input rests over four durations of a quick motion from each sample on, (n − 4 samples,).

    It rests a little longer, as far as the averages reach by which the output is judged: what follows its command at
    once would seem to set out before it.
    """
    ahead = samples // 4 + SPIKE // 2 + 1
    count, rest = len(inputs[0]) - (REST + 2) * samples, (REST + 2) * samples + ahead
    found = np.zeros(count, bool)
    if len(inputs[0]) >= rest:
        found[: count - ahead + 1] = held(inputs, rest)
    return found


def _changes(inputs: Sequence[Samples]) -> NDArray[np.intp]:
    """The samples at which an input changes."""
    return np.flatnonzero(np.any([np.abs(np.diff(u, prepend=u[0])) > HELD * np.ptp(u) for u in inputs], axis=0))


def _answer(y: Samples, changes: NDArray[np.intp], samples: int, longest: int) -> float:
    """How far the output goes in so many samples, at the fastest within a `longest` quick motion after a change.

    The median over the changes. Where a command mostly rests, most motions are a drift about where it holds the output.
    """
    way = np.abs(y[samples:] - y[:-samples])
    fastest = scipy.ndimage.maximum_filter1d(way, longest, origin=-(longest // 2))[changes[changes < len(way)]]
    return float(np.median(fastest)) if len(fastest) else 0.0


def _by_itself(changes: NDArray[np.intp], begins: Sequence[int], longest: int, samples: int) -> bool:
    """Whether the output sets out often enough, at any time after a change of the inputs, and not at even times.

    A start within the `longest` quick motion after a change may be a delayed answer, and is not counted.
    """
    last = [max(changes[changes <= begin], default=-REST * samples) for begin in begins]
    since = np.subtract(begins, last)
    if np.sum(since > longest) < LEAST or np.ptp(np.quantile(since, MOST)) <= longest:
        return False
    return bool(np.ptp(last) > 0 or np.ptp(np.diff(begins)) > samples)  # else it swings, slowly at each turn


def _extent(y: Samples) -> float:
    """How far the output goes within a twentieth of the record at most: one that wanders goes farther in all."""
    return float(np.max(spans(y, max(SHORTEST, round(LONGEST * len(y))))))


def _quick(y: Samples, extent: float) -> int:
    """The samples in which a quick motion of the output goes the travel."""
    samples = SHORTEST
    while samples < LONGEST * len(y) and np.quantile(np.abs(y[samples:] - y[:-samples]), QUICK) < TRAVEL * extent:
        samples += 1 + samples // 4
    return samples


def _beyond_steps(measured: Samples, begin: int, samples: int) -> bool:
    """Whether an output that sets out goes more steps of its reading, as it reads there, than one that creeps."""
    around = measured[max(0, begin - REST * samples) : begin + samples]
    low, high = float(np.min(around)), float(np.max(around))
    return high - low >= DIGITS * step_between(measured, low, high)


def _towards_command(run: Run, motion: Motion, begin: int) -> bool:
    """Whether an output of a closed loop stood off its command, by more than what counts as rest, and sets out to it.

    Its controller drives it then: it sums up the deviation until the friction at rest gives way, which may be long
    after the command has come to rest, and the output may go too far. What another input drives leaves the command.
    """
    unit = run.units.get("command", "1")
    if run.gain is None and (unit == "1" or unit != run.units.get(run.output)):
        return False
    begin = min(begin, len(motion.way) - 1)
    off = float(run.command[begin] - motion.output[begin])
    return abs(off) > SLOW * motion.quick and off * float(motion.way[begin]) > 0.0


def _turns(way: Samples, least: float) -> int:
    """How often a motion turns round that goes at least so far either way."""
    large = np.sign(way[np.abs(way) >= least])
    return int(np.sum(large[1:] != large[:-1]))


def _evidence(run: Run, motion: Motion, begins: Sequence[int], at_rest: NDArray[np.bool_]) -> Message:
    """How often and when it set out, and in which share of the rest of its inputs it moves at half of that speed."""
    rest, unit, way = REST * motion.samples, run.units.get(run.output, "1"), np.abs(motion.way)
    moved = way[rest:][: len(at_rest)][at_rest[: len(way) - rest]]
    least = 0.5 * min(float(way[begin : begin + motion.samples].max()) for begin in begins)
    by_time = unit.removesuffix("/s") + "/s²" if unit.endswith("/s") else f"{unit}/{run.time_unit}"
    speed = least * run.sample_rate / motion.samples, by_time
    output = run.output if unit == "1" else f"{run.output} ({unit})"
    return message(
        "missing_input",
        run=run.id,
        output=output,
        count=len(begins),
        start=begins[0] / run.sample_rate,
        unit=run.time_unit,
        share=float(np.mean(moved >= least)),
        speed=speed,
    )
