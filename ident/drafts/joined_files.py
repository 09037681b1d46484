"""Files of one signal each, as oscilloscopes and some loggers write them, as one table: a run is one file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath

import numpy as np

from ident.drafts.raw_file import JOINED, Column, RawFile
from ident.drafts.steps import moves_in_steps
from ident.errors import Unusable
from ident.readers.clock import evened, read_clock
from ident.readers.column_names import is_time
from ident.readers.table import some_of
from ident.run import Samples
from ident.units.quantity import unit_scale

_Columns = dict[str, Samples]
_DIGITS = 12  # behind the point of a time: 0.013 and not 0.013000000000000001


def joined(files: Mapping[str, RawFile], signals: Mapping[str, str] | None = None) -> str:
    """The signals of some files, given by name, side by side as a text with commas; a time that all have stands once.

    A column without a name, or with one that two files have, is called after its file, or as `signals` says; its unit
    stands in brackets. Where the times differ, all signals are brought to one even clock, the fastest of them, over the
    time that all files cover. The line above the table says what was joined, and how.

    Raises Unusable: ``unequal-lengths`` where a file without a time has not as many samples, ``unequal-times`` where
    the times of two files have nothing in common, ``bad-resample`` where their rates are too far apart.
    """
    read = list(files.values())
    stems = {name: PurePosixPath(name).name.partition(".")[0] for name in files} | dict(signals or {})
    times = {file.name: clock for file in read if (clock := clock_of(file)) is not None}
    told = f"from {some_of([PurePosixPath(file.name).name for file in read])}"
    if len(times) == len(read) and not _are_alike(times, read):
        columns, how = _on_one_clock(times, read, stems)
        told = f"{told}; {how}"
    else:
        columns = _side_by_side(times, read, stems)
    rows = zip(*(samples.tolist() for samples in columns.values()), strict=True)
    quoted = ",".join(f'"{name}"' for name in columns)
    return "\n".join([JOINED + told, quoted, *(",".join(map(repr, row)) for row in rows), ""])


def clock_of(file: RawFile) -> Column | None:
    """The column of times of a file: named so, or the first of two columns without names, where it only increases."""
    named = [one for one in file.columns if is_time(one.meaning) or one.number in file.table.stamps]
    if named or len(file.columns) != 2 or any(not one.name.isdigit() for one in file.columns):
        return named[0] if named else None
    first = file.columns[0]
    return first if bool((np.diff(file.samples(first.number)) > 0).all()) else None


def holds_one_signal(file: RawFile) -> bool:
    """Whether a file has one column of numbers, but for a time."""
    return len(_signals(file)) == 1 or (len(file.columns) == 1 and clock_of(file) is not None)


def _signals(file: RawFile) -> list[Column]:
    clock = clock_of(file)
    return [one for one in file.columns if one is not clock]


def _are_alike(times: Mapping[str, Column], files: Sequence[RawFile]) -> bool:
    """Whether all files were sampled at the same times, in one unit."""
    first, *others = (file.samples(times[file.name].number) for file in files)
    units = {times[file.name].unit for file in files}
    return len(units) == 1 and all(np.array_equal(first, other) for other in others)


def _side_by_side(times: Mapping[str, Column], files: Sequence[RawFile], stems: Mapping[str, str]) -> _Columns:
    """The columns as they are: the first time, and every signal. Raises Unusable."""
    lengths = {file.name: len(file.samples(file.columns[0].number)) for file in files}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise Unusable("unequal-lengths", f"the files differ in length: {listed}", "join", "cut them to one length")
    timed = [file for file in files if file.name in times]
    if timed and not _are_alike(times, timed):
        what = f"the times of {some_of([file.name for file in timed])} differ, and another file has none"
        raise Unusable("unequal-times", what, "join", "join files of one recording")
    columns: _Columns = {}
    for file in files:
        for column in file.columns:
            name = _time_name(column) if column is times.get(file.name) else _called(column, file, files, stems)
            columns.setdefault(name, file.samples(column.number))
    return columns


def _on_one_clock(
    times: Mapping[str, Column], files: Sequence[RawFile], stems: Mapping[str, str]
) -> tuple[_Columns, str]:
    """All signals on the fastest clock, over the time that all files cover, and what was done. Raises Unusable."""
    unit, clocks = _in_one_unit(times, files)
    begin, end = max(one[0] for one in clocks), min(one[-1] for one in clocks)
    rate = max(read_clock(one, file.name).rate for one, file in zip(clocks, files, strict=True))
    count = int((end - begin) * rate * (1.0 + 1e-9)) + 1 if end > begin else 0
    if count < 2:
        what = f"the recordings of {some_of([file.name for file in files])} do not overlap in time"
        raise Unusable("unequal-times", what, "join", "join files of one recording")
    columns: _Columns = {f"time [{unit}]" if unit else "time": np.round(begin + np.arange(count) / rate, _DIGITS)}
    for file, time in zip(files, clocks, strict=True):
        for column in _signals(file):
            samples = file.samples(column.number)
            known = ~np.isnan(samples)
            on_clock = evened(time[known], samples[known], rate, moves_in_steps(samples[known]), file.name, begin)
            columns[_called(column, file, files, stems)] = on_clock[:count]
    least = min(map(len, columns.values()))
    per = "Hz" if unit == "s" else f"samples per {unit or 'unit of time'}"
    told = f"their times differ, so all signals were resampled to {rate:g} {per}"
    return {name: samples[:least] for name, samples in columns.items()}, told


def _in_one_unit(times: Mapping[str, Column], files: Sequence[RawFile]) -> tuple[str, list[Samples]]:
    """The unit of all times and the times in it: in s where they are stated in several units. Raises Unusable."""
    units = [times[file.name].unit for file in files]
    clocks = [file.samples(times[file.name].number) for file in files]
    if len(set(units)) == 1:
        return units[0], clocks
    if "" in units:
        without = files[units.index("")].name
        what = "the unit of its time is not stated, and that of another file is"
        raise Unusable("unequal-times", what, without, "write it behind the name of the column, as time [s]")
    return "s", [clock * unit_scale(unit, "time", "time").factor for clock, unit in zip(clocks, units, strict=True)]


def _time_name(column: Column) -> str:
    return f"time [{column.unit}]" if column.unit else "time"


def _called(column: Column, file: RawFile, files: Sequence[RawFile], stems: Mapping[str, str]) -> str:
    """What a signal is called in the whole: by its name where that is its own, else by its file's."""
    name = column.name.replace('"', "")
    if not is_time(name):
        others = sum(one.name == column.name for other in files for one in other.columns)
        if name.isdigit() or not name or others > 1:
            name = stems[file.name] if len(_signals(file)) == 1 else f"{stems[file.name]} {name}"
    return f"{name} [{column.unit}]" if column.unit and column.unit not in name else name
