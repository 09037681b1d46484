"""Columns of a file to a run in SI."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.errors import Unusable
from ident.readers.clock import evened, read_clock
from ident.readers.past import with_past
from ident.readers.run_description import RunDescription, TimeColumn
from ident.readers.split import split
from ident.readers.table import Array, Table, numeric
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
    ``not-finite``, ``zero-variance``, ``time-not-monotonic``, ``nothing-left``, ``bad-split``.
    """
    run, count = _whole(described, table)
    parts, told = ((run,), ()) if described.split is None else _split(run, described, count)
    return tuple(without_trend(part, described.trend, described.outputs) for part in parts), told


def _split(run: Run, described: RunDescription, count: int) -> tuple[tuple[Run, ...], tuple[str, ...]]:
    assert described.split is not None
    parts, told = split(run, described.split, described.rows or (0, count))
    return parts, (told,)


def _whole(described: RunDescription, table: Table) -> tuple[Run, int]:
    """The run before it is split, and how many rows its file has."""
    labels = described.labels
    places = {name: f"{run_name(labels.id)} channels.{name}" for name in described.channels}
    wanted = {name: channel.column for name, channel in described.channels.items()}
    if described.time is not None:
        places["time"], wanted["time"] = f"{run_name(labels.id)} time", described.time.column
    numbers = {name: table.numbers(column, places[name]) for name, column in wanted.items()}
    loaded = iter(table.load([number for of_channel in numbers.values() for number in of_channel]))
    raw = {name: difference([next(loaded) for _ in found], places[name]) for name, found in numbers.items()}
    check_lengths(raw, described)
    channels = {
        name: in_si(part(raw[name], described, places[name]), channel.scale, places[name])
        for name, channel in described.channels.items()
    }
    for name in {"command", *described.outputs} & set(channels):
        if name != "command" or not channels[name][0]:  # one that is held is a step from nothing at its first sample
            check_moves(channels[name], places[name])
    if described.time is None:
        return with_past(replace(labels, channels=channels), raw, described, LARGEST), len(next(iter(raw.values())))
    _check_stamps(table, described.time, places["time"])
    scale = Scale(described.time.factor, 0.0, "s")
    time = in_si(part(raw["time"], described, places["time"]), scale, places["time"])
    clock = read_clock(time, places["time"])
    rate = described.time.resample or clock.rate
    even = clock.even and rate == clock.rate
    if not even:
        held = "command" if labels.hold == "zoh" else ""
        where = places["time"] + ".resample" if described.time.resample else places["time"]
        channels = {name: evened(clock.time, values, rate, name == held, where) for name, values in channels.items()}
    run = replace(
        labels, channels=channels, sample_rate=rate, clock_jitter=clock.jitter, gaps=clock.gaps, evened=not even
    )
    return with_past(run, raw, described, LARGEST), len(raw["time"])


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
    if count < SHORTEST:
        what = f"the record has {samples(count, 'sample')}"
        raise Unusable("too-short", what, where, f"record at least {SHORTEST}, better some seconds")


def part(column: Array, described: RunDescription, where: str) -> Array:
    """The rows of a column that the run asks for."""
    numeric(column, where, where)
    return column if described.rows is None else column[slice(*described.rows)]


def in_si(raw: Array, scale: Scale, where: str) -> Samples:
    """factor × raw + offset in new memory. Raises Unusable ``not-finite`` with the first bad sample."""
    with np.errstate(all="ignore"):
        values: Samples = np.multiply(raw, scale.factor, dtype=np.float64)
        if scale.offset:
            values += scale.offset
    largest = max(-float(values.min()), float(values.max()))  # not a number where any sample is not
    if not largest < LARGEST:
        index = int(np.argmin(np.abs(values) < LARGEST))
        what = f"sample {index} is {shown(raw[index])}, not a finite number of a usable size"
        raise Unusable("not-finite", what, where, "cut the record there or repair the sample")
    return values


def check_moves(values: Samples, where: str) -> None:
    """Raises Unusable: ``zero-variance`` for a channel that holds one value, but for rounding."""
    lowest, highest = float(values.min()), float(values.max())
    if highest - lowest <= 1e-12 * max(abs(lowest), abs(highest)):
        raise Unusable("zero-variance", f"all samples are {lowest:g}", where, "check the column and the sensor")
