"""A run whose clock or amplitude is off that of its sisters by the factor of a unit: milliseconds called seconds.

A wrong unit leaves every sample as it is. So a run whose time has the wrong unit answers its command, sample by sample,
as its sisters do, and, second by second, by that factor too fast or too slowly; one that was sampled at another rate
on purpose does the opposite. A command of another size on purpose is told from a wrong unit by what is stated of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import log, pi

import numpy as np

from ident.cached import cached_property
from ident.checks.finding import Finding
from ident.checks.response import RELATED, Response, respond, response, rests
from ident.run import Run
from ident.words.message import Message, message

NEAR = 0.02  # a clock is right to 1e-4 and a repeated RMS to 1 %; by chance one ratio in 40 is so near to a factor
Units = Sequence[tuple[str, str]]
FACTORS: Mapping[float, Units] = {
    25.4: [("in", "mm")],
    60.0: [("min", "s")],
    180 / pi: [("deg", "rad")],
    9.80665: [("kgf", "N"), ("g", "m/s^2")],
}
"""Factors with the units that they lie between."""
TENS: Mapping[int, Units] = {1: [("cm", "mm")], 2: [("m", "cm")], 3: [("m", "mm"), ("s", "ms")]}
"""Powers of ten that lie between units; the others count, too."""
BAND = (0.02, 0.98)  # of the input's power: where a response is compared
FEWEST = 3  # frequencies at which two responses are compared: two can agree by chance
AGREE = 0.7  # nepers and radians, median: noise of 8 frames, another amplitude or gain come to 0.5
TIMES_BETTER = 2.0  # the corrected clock has to agree better by; both agree of a machine that answers at once
VARIED = 0.25  # nepers and radians: a response that changes less over the band tells nothing of the clock
CLOSE = 0.5  # of that change: what two responses differ by at most where they are taken as one
AS_LONG, AS_SLOW, AS_PEAKED = 2.0, 1.5, 1.5  # times: samples, mean frequency and crest factor of sisters
DRIVERS = ("command", "drive_force", "current", "velocity", "displacement")
"""What may drive a run: the first of them that it has."""
MOST_CAUSES = 2  # that a fit names
ALONE = 0.1  # of its size: a run that has a sister as near was meant so


@dataclass(frozen=True)
class Factor:
    """A factor that a wrong unit makes, and the units that make it."""

    value: float
    units: Units

    @property
    def message(self) -> Message:
        """The factor in words."""
        values = {"value": self.value} | ({"units": self.units} if self.units else {})
        return message("factor.units" if self.units else "factor", **values)


def factor(ratio: float) -> Factor | None:
    """The factor, or reciprocal of one, that a ratio is within NEAR of."""
    size = max(ratio, 1 / ratio)
    n = round(log(size) / log(10))
    known: dict[float, Units] = {**FACTORS, **({10.0**n: TENS.get(n, ())} if n else {})}
    nearest = min(known, key=lambda each: abs(log(size / each)))
    return Factor(nearest, known[nearest]) if abs(log(size / nearest)) <= log(1 + NEAR) else None


@dataclass(frozen=True, eq=False)
class Record:
    """A run with what drives it: `answer` is the response from there, None where it cannot be known."""

    run: Run
    driver: str
    answer: Response | None

    @property
    def name(self) -> str:
        """The id of the run, or of the record that it is one of the outputs of."""
        return self.run.record or self.run.id

    @property
    def input(self) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
        """The samples of what drives it."""
        return self.run.channels[self.driver]

    @cached_property
    def pace(self) -> float:
        """The mean frequency of the input's power, cycles a sample."""
        power = np.abs(np.fft.rfft(self.input - self.input.mean())) ** 2
        return float(np.arange(len(power)) @ power / power.sum()) / len(self.input)

    @cached_property
    def crest(self) -> float:
        """The largest deviation of the input in standard deviations."""
        return float(np.max(np.abs(self.input - self.input.mean())) / self.size(self.driver))

    def size(self, channel: str) -> float:
        """The standard deviation of a channel."""
        return max(float(np.std(self.run.channels[channel])), np.finfo(float).tiny)


@dataclass(frozen=True)
class _Doubt:
    """What is off in the run with the id `run`, as a cause of a bad fit, and what to correct."""

    run: str
    code: str
    what: Message
    remedy: Message


def unit_factor(measured: Sequence[tuple[Run, Response | None]], scaled: Sequence[str | None]) -> Iterator[Finding]:
    """A doubt for each run whose clock, input or output is off its sisters' by the factor of a unit.

    `measured` are all runs with their responses to a command; `scaled` those whose output is doubted already.
    """
    for one in _doubts(measured, scaled):
        yield Finding.of(one.run, "doubt", one.code, message("check.unit_factor", what=one.what, remedy=one.remedy))


def unit_causes(runs: Sequence[Run]) -> list[Message]:
    """What units may have to do with a fit that explains hardly anything, as likely causes."""
    found = [message("cause.unit_of", what=one.what) for one in _doubts([(run, respond(run)) for run in runs], [])]
    return found[:MOST_CAUSES] or [message("cause.unit")]


def _doubts(measured: Sequence[tuple[Run, Response | None]], scaled: Sequence[str | None]) -> Iterator[_Doubt]:
    records = list(_records(measured))
    alone = list({record.name: record for record in reversed(records)}.values())[::-1]  # one output of each
    yield from _clocks([record for record in alone if record.run.time_unit == "s"])
    yield from _inputs(alone)
    yield from _outputs([record for record in records if record.run.id not in scaled])


def _records(measured: Sequence[tuple[Run, Response | None]]) -> Iterator[Record]:
    for run, answer in measured:
        if rests(run):  # to its rounding or its recorder's noise: it has no size
            continue
        moved = [name for name in DRIVERS if name in run.channels and np.ptp(run.channels[name]) > 0]
        driver = next((name for name in moved if name != run.output), "")
        if driver:
            told = answer if driver == "command" else response(run.channels[driver], run.measured, run.sample_rate)
            yield Record(run, driver, told)


def _clocks(records: Sequence[Record]) -> Iterator[_Doubt]:
    """Runs whose sample rate, or duration, is off: against the runs of the most usual rate, the first of two."""
    usual = _largest(records, lambda record: record.run.sample_rate)
    duration = float(np.median([record.run.duration for record in usual])) if usual else 0.0
    for record in records:
        run, sisters = record.run, [each for each in usual if each is not record]
        if not sisters:
            continue
        rate = run.sample_rate / sisters[0].run.sample_rate
        by_rate, by_duration = factor(rate), factor(run.duration / duration)
        if by_rate and _clock_is_off(record, sisters, 1 / rate):
            values = {"rate": run.sample_rate, "ratio": rate, "factor": by_rate.message}
            what = message("unit.rate", duration=run.duration, run=record.name, others=_names(sisters), **values)
            yield _Doubt(run.id, "clock-factor", what, message("unit.correct_rate"))
        elif by_duration and factor(rate) is None and _answers_as(record, sisters, run.duration / duration) is True:
            values = {"duration": run.duration, "ratio": run.duration / duration, "factor": by_duration.message}
            what = message("unit.duration", run=record.name, others=_names(sisters), **values)
            yield _Doubt(run.id, "clock-factor", what, message("unit.correct_time"))


def _clock_is_off(record: Record, sisters: Sequence[Record], scale: float) -> bool:
    """Whether frequencies `scale` times the stated ones make a run like its sisters, by its response if that tells."""
    told = _answers_as(record, sisters, scale)
    if told is not None:
        return told
    return any(
        one.driver == record.driver
        and _within(record.run.length, one.run.length, AS_LONG)
        and _within(record.pace, one.pace, AS_SLOW)
        and _within(record.crest, one.crest, AS_PEAKED)
        for one in sisters
    )


def _answers_as(record: Record, sisters: Sequence[Record], scale: float) -> bool | None:
    """Whether a run answers as its sisters once its frequencies are taken times `scale`; None where that is not told.

    Those of the same specimen and gain are asked, where there are any.
    """
    same = [one for one in sisters if _conditions(one.run) == _conditions(record.run)]
    told = [_told(record, one, scale) for one in same or sisters]
    known = [one for one in told if one is not None]
    return 2 * sum(known) >= len(known) if known else None


def _told(record: Record, sister: Record, scale: float) -> bool | None:
    """The same of one sister."""
    same = record.driver == sister.driver and record.run.output == sister.run.output
    if not same or record.answer is None or sister.answer is None:
        return None
    stated, corrected = _differ(record.answer, sister.answer, 1.0), _differ(record.answer, sister.answer, scale)
    if stated is not None and corrected is not None:
        if max(stated[0], corrected[0]) < AGREE / 2:  # both agree
            return None
        return corrected[0] < AGREE and corrected[0] * TIMES_BETTER < stated[0]
    if stated is not None:
        return False if stated[0] < AGREE and stated[1] > VARIED else None
    if corrected is None or corrected[1] < VARIED:
        return None
    return corrected[0] < min(AGREE, CLOSE * corrected[1])


def _differ(one: Response, other: Response, scale: float) -> tuple[float, float] | None:
    """How far two responses differ where both inputs have power, frequencies of the first times `scale`: the median
    of |ln H₁/H₂|; and by how much the second varies there. None where that is at too few frequencies.
    """
    used, beside = (each.between(*BAND) & (each.coherence > RELATED) for each in (one, other))
    if not used.any() or not beside.any():
        return None
    at, known = one.frequency[used] * scale, other.frequency[beside]
    inside = (at >= known[0] * (1 - 1e-9)) & (at <= known[-1] * (1 + 1e-9))
    if inside.sum() < FEWEST:
        return None
    expected = np.interp(at[inside], known, other.gain[beside].real) + 1j * np.interp(
        at[inside], known, other.gain[beside].imag
    )
    expected[expected == 0] = np.finfo(float).tiny
    differ = float(np.median(np.abs(np.log(one.gain[used][inside] / expected))))
    over = np.log(np.abs(expected)), np.unwrap(np.angle(expected))
    return differ, float(np.hypot(np.ptp(over[0]), np.ptp(over[1])))


def _inputs(records: Sequence[Record]) -> Iterator[_Doubt]:
    """Runs whose input is off in size, which neither a stated amplitude nor a stated gain explains."""
    for number, record in enumerate(records):
        if record.run.amplitude is not None:  # what is stated of it is checked by itself
            continue
        sisters = [one for one in records if one is not record and _alike(record, one)]
        if len(sisters) == 1 and records.index(sisters[0]) > number:  # of two, the second
            continue
        off = _off(record, sisters, record.driver)
        if off and not _by_gain(record.run, [one.run for one in off.sisters], off.ratio):
            yield _size(record, record.driver, off, message("unit.correct_command"))


def _outputs(records: Sequence[Record]) -> Iterator[_Doubt]:
    """Runs whose output is off in size, though input, specimen and gain are those of their sisters."""
    for number, record in enumerate(records):
        sisters = [
            one
            for one in records
            if one is not record
            and _alike(record, one)
            and _conditions(one.run) == _conditions(record.run)
            and one.run.units.get(one.run.output) == record.run.units.get(one.run.output)
            and _within(one.size(one.driver), record.size(record.driver), 1 + NEAR)
        ]
        if len(sisters) == 1 and records.index(sisters[0]) > number:
            continue
        if off := _off(record, sisters, record.run.output):
            yield _size(record, record.run.output, off, message("unit.correct_scale"))


@dataclass(frozen=True)
class Off:
    """The ratio of a run's size to the size of some sisters, and the factor near it."""

    sisters: Sequence[Record]
    ratio: float
    near: Factor


def _off(record: Record, sisters: Sequence[Record], channel: str) -> Off | None:
    """The sisters of one size that a run is off from by a factor; None where that may be meant.

    It is where a sister is as large, where the sisters' own sizes differ by factors, and where no two sisters have
    one size, though there are more of them: then nobody knows which size is usual.
    """
    size = record.size(channel)
    if any(_within(size, one.size(channel), 1 + ALONE) for one in sisters):
        return None
    levels = [level for level in _levels(sisters, channel) if len(level) > 1 or len(sisters) == 1]
    sizes = [float(np.median([one.size(channel) for one in level])) for level in levels]
    if any(factor(one / other) for one in sizes for other in sizes if one > other):
        return None
    for level, usual in zip(levels, sizes, strict=True):
        if near := factor(size / usual):
            return Off(level, size / usual, near)
    return None


def _levels(records: Sequence[Record], channel: str) -> list[list[Record]]:
    """The records in groups of one size, the largest group first."""
    left, found = list(records), []
    while left:
        found.append(_largest(left, lambda one: one.size(channel)))
        left = [one for one in left if one not in found[-1]]
    return found


def _size(record: Record, channel: str, off: Off, remedy: Message) -> _Doubt:
    values = {"ratio": off.ratio, "factor": off.near.message}
    what = message("unit.size", channel=channel, run=record.name, others=_names(off.sisters), **values)
    return _Doubt(record.run.id, "amplitude-factor", what, remedy)


def _by_gain(run: Run, sisters: Sequence[Run], ratio: float) -> bool:
    """Whether another stated gain explains more than half of a ratio, in logarithms."""
    gains = [sister.gain for sister in sisters if sister.gain]
    if not run.gain or not gains:
        return False
    other, size = abs(log(run.gain / float(np.median(gains)))), abs(log(ratio))
    return abs(size - other) < size / 2


def _alike(one: Record, other: Record) -> bool:
    """Whether two runs are of one kind: what is stated, and how often and how far the input moves."""
    first, second = one.run, other.run
    stated = (first.kind, first.output, first.units.get(one.driver)) == (
        second.kind,
        second.output,
        second.units.get(other.driver),
    )
    return (
        stated
        and one.driver == other.driver
        and _within(one.pace * first.sample_rate, other.pace * second.sample_rate, AS_SLOW)
        and _within(one.crest, other.crest, AS_PEAKED)
    )


def _largest(records: Sequence[Record], value: Callable[[Record], float]) -> list[Record]:
    """The largest group of records whose values agree with that of its first one; the first of several."""
    groups = [[one for one in records if _within(value(one), value(first), 1 + NEAR)] for first in records]
    return max(groups, key=len, default=[])


def _within(one: float, other: float, times: float) -> bool:
    return max(one, other) <= times * min(one, other)


def _conditions(run: Run) -> tuple[object, ...]:
    return run.specimen, run.gain


def _names(records: Sequence[Record]) -> list[str]:
    return list(dict.fromkeys(record.name for record in records))
