"""Columns of a file to a run in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ident.errors import Unusable
from ident.readers.clock import check_rate
from ident.readers.earlier_command import with_past
from ident.readers.missing_values import Numbers, OnOneClock, on_one_clock
from ident.readers.run_description import RunDescription, TimeColumn
from ident.readers.split import Split, split
from ident.readers.table import Array, Table, numeric
from ident.readers.time_order import oldest_first, with_new_times
from ident.readers.trend import without_trend
from ident.run import Run, Samples
from ident.units.quantity import Scale, shown
from ident.words.number import count as samples
from ident.words.run_name import run_name

SHORTEST = 8  # samples; below, not even the straight line of the clock and a mean leave anything to fit
LARGEST = 1e100  # SI; squares beyond overflow


def read_run(described: RunDescription, table: Table) -> tuple[tuple[Run, ...], tuple[str, ...]]:
    """The run with its samples, float64, contiguous, its own memory; estimation and validation data where it is split.

    With what is to be said of it. Without the trend that is asked to be left out, of each part by itself.
    Raises Unusable: ``missing-column``, ``not-numeric``, ``unequal-lengths``, ``rows-outside``, ``too-short``,
    ``not-finite``, ``zero-variance``, ``time-not-monotonic``, ``uneven-clock``, ``nothing-left``, ``bad-split``.
    """
    run, described, told = _whole(described, table)
    parts: tuple[Run, ...] = (run,)
    if described.split is not None:
        assert described.rows is not None
        parts, of_split = split(run, described.split, described.rows)
        told = (*told, of_split)
    return tuple(without_trend(part, described.trend, described.outputs) for part in parts), told


def _whole(described: RunDescription, table: Table) -> tuple[Run, RunDescription, tuple[str, ...]]:
    """The run before it is split, its description with the rows of the file that it covers, and what to say of it."""
    raw, places, reversed_ = _loaded(described, table)
    rows = described.rows or (0, len(next(iter(raw.values()))))
    channels = {
        channel: in_si(part(raw[channel], described, places[channel]), of.scale, places[channel])
        for channel, of in described.channels.items()
    }
    for channel in {"command", *described.outputs} & set(channels):
        known = channels[channel][~np.isnan(channels[channel])]
        if channel != "command" or not known[0]:  # one that is held is a step from nothing at its first sample
            check_moves(known, places[channel])
    if described.time is None and not any(np.isnan(values).any() for values in channels.values()):
        run = replace(described.labels, channels=channels)
        return with_past(run, raw, described, LARGEST), replace(described, rows=rows), ()
    time, numbers, repeated = _times(described, raw, np.arange(*rows), places)
    if repeated:
        channels = {channel: values[numbers - rows[0]] for channel, values in channels.items()}
    run, found = _on_one_clock(described, channels, time, numbers, places)
    covered = replace(described, rows=(found.first, found.end), split=_covered(described.split, rows, found))
    if not reversed_:
        run = with_past(run, raw, covered if described.rows or found.first else described, LARGEST)
    told = (f"{run_name(run.id)}: {said}" for said in (reversed_, repeated, found.told) if said)
    return run, covered, tuple(told)


def _loaded(described: RunDescription, table: Table) -> tuple[dict[str, Array], dict[str, str], str]:
    """The columns of the channels and of the time, from the oldest row; where each is stated; what to say of the
    order."""
    name = run_name(described.labels.id)
    places = {channel: f"{name} channels.{channel}" for channel in described.channels}
    wanted = {channel: of.column for channel, of in described.channels.items()}
    places["time"] = f"{name} time"
    if described.time is not None:
        wanted["time"] = described.time.column
    numbers = {channel: table.numbers(column, places[channel]) for channel, column in wanted.items()}
    loaded = iter(table.load([number for of_channel in numbers.values() for number in of_channel]))
    raw = {channel: difference([next(loaded) for _ in found], places[channel]) for channel, found in numbers.items()}
    check_lengths(raw, described)
    if described.time is None:
        return raw, places | {"time": f"{name} sample_rate"}, ""
    _check_stamps(table, described.time, places["time"])
    raw, told = oldest_first(raw)
    return raw, places, told


def _times(
    described: RunDescription, raw: Mapping[str, Array], numbers: Numbers, places: Mapping[str, str]
) -> tuple[Samples, Numbers, str]:
    """The times in s of those rows that have a new one, these rows of the file, and what to say of the others."""
    if described.time is None:
        return numbers / described.labels.sample_rate, numbers, ""
    time = in_si(part(raw["time"], described, places["time"]), Scale(described.time.factor, 0.0, "s"), places["time"])
    new, told = with_new_times(time)
    return time[new], numbers[new], told


def _on_one_clock(
    described: RunDescription,
    channels: Mapping[str, Samples],
    time: Samples,
    numbers: Numbers,
    places: Mapping[str, str],
) -> tuple[Run, OnOneClock]:
    """The run on the clock of its outputs, and how it got there."""
    resample = described.time.resample if described.time is not None else None
    outputs = [channel for channel in described.outputs if channel in channels] or list(channels)
    held = "command" if described.labels.hold == "zoh" else ""
    found = on_one_clock(channels, time, numbers, outputs, held, resample, places["time"])
    clock = found.clock
    check_long_enough(len(found.channels[outputs[0]]), places["time"])
    if resample is None:
        check_rate(clock, places["time"])
    run = replace(
        described.labels,
        channels=found.channels,
        sample_rate=found.rate,
        clock_jitter=clock.jitter,
        gaps=clock.gaps,
        evened=found.evened,
        unbroken=found.unbroken if clock.gaps else None,
    )
    return run, found


def _covered(of: Split | None, rows: tuple[int, int], found: OnOneClock) -> Split | None:
    """The validation data, without rows at the ends of the part that have no value."""
    if of is None or of.first < rows[0] or of.end > rows[1]:
        return of  # which is refused
    return replace(of, first=max(of.first, found.first), end=min(of.end, found.end))


def _check_stamps(table: Table, time: TimeColumn, where: str) -> None:
    """Raises Unusable ``time-stamps`` for time stamps, which are read in seconds, that are stated in another unit."""
    if table.stamps.intersection(table.numbers(time.column, where)) and time.factor != 1.0:
        what = f"{shown(time.column)!r} holds time stamps, which are read in seconds since the first one"
        raise Unusable("time-stamps", what, where, "give it the unit s")


def difference(columns: list[Array], where: str) -> Array:
    """One column as it is, of two the first less the second. Raises Unusable where these differ in length."""
    if len(columns) == 1:
        return columns[0]
    first, second = (numeric(column, where, where) for column in columns)
    if len(first) != len(second):
        what = f"the columns of a difference have {len(first)} and {len(second)} samples"
        raise Unusable("unequal-lengths", what, where, "cut them to one length")
    return np.subtract(first, second, dtype=np.float64)


def check_lengths(raw: dict[str, Array], described: RunDescription) -> None:
    """All columns of one length, long enough, and as long as `rows` says."""
    run, file = run_name(described.labels.id), described.labels.file
    where = f"{run} file {file}"
    lengths = {name: len(column) for name, column in raw.items()}
    count = min(lengths.values())
    if max(lengths.values()) != count:
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise Unusable("unequal-lengths", f"columns differ in length: {listed}", where, "cut them to one length")
    if described.rows is not None:
        first, end = described.rows
        if end > count:
            what = f"[{first}, {end}] ends after the last sample of {file}, which has {count}"
            remedy = f"write [{first}, {count}]" if first < count else f"give a part of [0, {count}]"
            raise Unusable("rows-outside", what, f"{run} rows", remedy)
        count = end - first
    if count == 0:
        raise Unusable("empty-file", "the file has no samples", where, "give a record")
    check_long_enough(count, where)


def check_long_enough(count: int, where: str) -> None:
    """Raises Unusable: ``too-short``."""
    if count < SHORTEST:
        what = f"the record has {samples(count, 'sample')}"
        raise Unusable("too-short", what, where, f"record at least {SHORTEST}, better some seconds")


def part(column: Array, described: RunDescription, where: str) -> Array:
    """The rows of a column that the run asks for."""
    numeric(column, where, where)
    return column if described.rows is None else column[slice(*described.rows)]


def in_si(raw: Array, scale: Scale, where: str) -> Samples:
    """factor × raw + offset in new memory, NaN where there is no value.

    Raises Unusable: ``not-finite`` with the first bad sample, ``no-values``.
    """
    with np.errstate(all="ignore"):
        values: Samples = np.multiply(raw, scale.factor, dtype=np.float64)
        if scale.offset:
            values += scale.offset
    largest = max(-float(values.min()), float(values.max()))  # not a number where any sample is not
    if not largest < LARGEST and not _are_finite_or_missing(values):
        if np.isnan(values).all():
            raise Unusable("no-values", "the column has no value", where, "name another column")
        index = int(np.argmin(np.isnan(values) | (np.abs(values) < LARGEST)))
        what = f"sample {index} is {shown(raw[index])}, not a finite number of a usable size"
        raise Unusable("not-finite", what, where, "cut the record there or repair the sample")
    return values


def _are_finite_or_missing(values: Samples) -> bool:
    missing = np.isnan(values)
    return not missing.all() and bool((missing | (np.abs(values) < LARGEST)).all())


def check_moves(values: Samples, where: str) -> None:
    """Raises Unusable: ``zero-variance`` for a channel that holds one value, but for rounding."""
    lowest, highest = float(values.min()), float(values.max())
    if highest - lowest <= 1e-12 * max(abs(lowest), abs(highest)):
        raise Unusable("zero-variance", f"all samples are {lowest:g}", where, "check the column and the sensor")
