"""A draft of a matrix: raw files with what is known of them, and what is still to be answered."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from shlex import quote
from typing import Any

import numpy as np

from ident.drafts.answers import NONE, Answer, Answers, FileAnswers
from ident.drafts.names import suggested, unit_of, unnamed_clock
from ident.drafts.raw_file import Column, RawFile
from ident.drafts.steps import moves_in_steps
from ident.errors import Unusable
from ident.readers import PACKED
from ident.readers.column_names import is_time, may_measure
from ident.readers.hold import are_band_limited
from ident.readers.run_description import LESS
from ident.readers.table import MINUS, some_of
from ident.run import BENCH, CHANNELS, MOTIONS
from ident.units.quantity import shown
from ident.words.message import message
from ident.words.sentence import first_of

OUTPUTS = ("displacement", "velocity", "acceleration", "force", "load_pressure", "temperature", "current")
"""Channels that a model may have to reproduce; the first that there is, unless one is named. A temperature or
a current is one where another column is the command."""
_DRIVES = ("command", "current")
_TO_REPLACE = ("SERIAL", "COLUMN", "UNIT", "RATE", "=NAME")
"""What stands in an option for what only the user knows."""
_HELD = "the command rests and jumps, so a zero-order hold is assumed (hold: zoh)"
_DRAWN = "the command is assumed to be linear between samples (hold: linear); set zoh if it is held"
_MOVED = "the motion that drives is assumed to be linear between samples (hold: linear); set zoh if it is held"
_CURVED = (
    "the command's spectrum ends below half the sample rate, so it is assumed to be band-limited between samples "
    "(hold: band-limited); set zoh if it is held, linear if it is drawn"
)
_LEFT_OUT = 3  # columns with an empty cell that a question names


@dataclass(frozen=True)
class Missing:
    """One thing that `files` do not state: `key` as an option and a field name it, and the question."""

    key: str
    question: str
    files: tuple[str, ...] = ()


@dataclass(frozen=True)
class Known:
    """What is known of one file: the column and the unit of each channel, how it was sampled, what drives it."""

    channels: Mapping[str, Answer]
    time: Answer
    rate: str
    hold: str
    doubts: tuple[str, ...]


@dataclass(frozen=True)
class Draft:
    """Raw files under one set of answers. Raises Unusable ``missing-file`` for an answer about none of them."""

    files: Sequence[RawFile]
    answers: Answers

    def __post_init__(self) -> None:
        names = [file_name(file) for file in self.files]
        for file in self.answers.files:
            if file not in names:
                raise Unusable(
                    "missing-file", f"{shown(file)!r} is none of the files", "files", f"name one of {some_of(names)}"
                )

    def known(self, file: RawFile) -> Known:
        """What the file states and the answers say of it. Raises Unusable where an answer names no column of it."""
        if file.problem:
            return Known({}, Answer(), "", "linear", ())
        doubts: list[str] = []
        said = self.answers.of(file_name(file))
        found = {channel: Answer(column.name, unit_of(column)) for channel, column in suggested(file.columns).items()}
        for channel, answer in said.channels.items():
            if answer.column == NONE:
                found.pop(channel, None)
                continue
            columns = self._columns(file, channel, answer) if answer.column != "" else []
            before = found.get(channel, Answer())
            if columns:
                found = {name: a for name, a in found.items() if _stays(file, name, a, columns, said)}
            stated = _unit(columns) if columns else before.unit
            if columns and answer.unit and stated not in ("", answer.unit):
                doubts.append(_contradicted(MINUS.join(one.name for one in columns), channel, answer.unit, stated))
            found[channel] = Answer(answer.column if columns else before.column, answer.unit or stated)
        found = {channel: answer for channel, answer in found.items() if answer.column != ""}
        sparse = _sparse(file, found, said)
        found = {channel: answer for channel, answer in found.items() if channel not in sparse}
        doubts += [
            str(message("draft.sparse", column=shown(a.column), use=channel, share=share))
            for channel, (a, share) in sparse.items()
        ]
        doubts += [
            str(message("draft.named", column=shown(a.column), use=channel))
            for channel, a in found.items()
            if channel not in said.channels
        ]
        time, rate, assumed = _clock(file, said, found)
        used = [answer.column for answer in (*found.values(), time) if answer.column != ""]
        if twice := {str(column) for column in used if used.count(column) > 1}:
            raise Unusable(
                "column-twice",
                f"{', '.join(sorted(twice))} is asked to be two channels",
                file.name,
                "give each channel its own column",
            )
        hold = str(self.answers.common.get("hold", "")) or self._hold(file, found)
        return Known(found, time, rate, hold, (*doubts, *assumed, *_unused(file, used)))

    def _columns(self, file: RawFile, channel: str, answer: Answer) -> list[Column]:
        """The columns of an answer. Raises Unusable; where another file has it, with what to type of this one."""
        try:
            return _columns(file, answer.column, f"channel {channel}")
        except Unusable as error:
            names = [column.name for other in self.files for column in other.columns]
            if error.code != "missing-column" or answer.column not in names:
                raise
            likely = suggested(file.columns).get(channel)
            name = likely.name if likely else "COLUMN"
            option = quote(f"{channel}@{file_name(file)}={name}")
            raise Unusable(error.code, error.what, error.where, f"for this file, add --channel {option}") from None

    def _hold(self, file: RawFile, channels: Mapping[str, Answer]) -> str:
        """What the command does between samples, by the look of it."""
        drive = next((channels[name].column for name in _DRIVES if name in channels), None)
        held = drive is not None and moves_in_steps(file.values(drive))
        return "zoh" if held else "linear"

    @property
    def missing(self) -> tuple[Missing, ...]:
        """Everything that has still to be said: once for all files whose columns are called alike."""
        found: dict[tuple[object, ...], Missing] = {}
        for file in self.files:
            columns = tuple(column.name for column in file.columns) or (file.name,)
            for one in self._missing_of(file):
                before = found.setdefault((one.key, columns), replace(one, files=()))
                found[one.key, columns] = replace(before, files=(*before.files, file_name(file)))
        serial = () if self.answers.serial else (Missing("serial", "serial number of the actuator"),)
        return (*serial, *(self._of_some(one) for one in found.values()))

    def _of_some(self, missing: Missing) -> Missing:
        """What is missing, its question with the files that it concerns where these are not all."""
        if self.of_all(missing) or missing.key.startswith(("channel", "dialect")):
            return missing
        return replace(missing, question=f"{missing.question}, of {some_of(missing.files)}")

    def of_all(self, missing: Missing) -> bool:
        """Whether something is missing in every file, so that one answer holds for all of them."""
        return len(missing.files) in (0, len(self.files))

    @property
    def is_parted(self) -> bool:
        """Whether some files have the command alone and others the output alone, as of two loggers of one run."""
        known = [self.known(file).channels for file in self.files]
        ends = {("command" in channels, any(name in channels for name in OUTPUTS)) for channels in known}
        return {(True, False), (False, True)} <= ends

    def _missing_of(self, file: RawFile) -> list[Missing]:
        if file.problem:
            question = f"{shown(file_name(file))} cannot be read: {file.problem}. Which delimiter, decimal sign, header"
            return [Missing("dialect", f"{question} rows and encoding has it?")]
        known, found = self.known(file), []
        output = next((name for name in OUTPUTS if name in known.channels), "")
        if output in LESS and "command" not in known.channels:
            output = ""  # a temperature drives, too, and so does a current
        wanted = self.answers.output or output
        bench = self.answers.common.get("kind") in BENCH
        drives = {"command", *(("current",) if bench else ()), *(MOTIONS if wanted == "force" else ())}
        if not drives & known.channels.keys() and self._said(file, "command") != NONE:
            found.append(self._missing_drive(file, known))
        if not wanted or wanted not in known.channels:
            answers = (
                "displacement, velocity, acceleration, force, load pressure (load_pressure), temperature or current"
            )
            what = wanted or answers
            likely = wanted or self._likely_output(file)
            found.append(Missing(f"channel {likely}", f"which column of {_listed(file)} is the {what}"))
        for channel, answer in known.channels.items():
            if not answer.unit:
                found.append(Missing(f"unit {channel}", f"unit of {channel}, column {shown(answer.column)!r}"))
        if known.time.column == "" and not known.rate:
            found.append(Missing("rate", "sample rate, or the column of the time"))
        elif known.time.column != "" and not known.time.unit:
            found.append(Missing("unit time", f"unit of the time, column {shown(known.time.column)!r}"))
        return found

    def _likely_output(self, file: RawFile) -> str:
        """The first output that may have the unit of the one column left; the first of all where none is left alone."""
        _, others = self._left(file)
        unit = unit_of(others[0]) if len(others) == 1 else ""
        return next((output for output in OUTPUTS if unit and may_measure(output, unit)), OUTPUTS[0])

    def _missing_drive(self, file: RawFile, known: Known) -> Missing:
        """The question for what drives: the motion, where the force was said to be the output."""
        if self.answers.output == "force":
            what = f"which column of {_listed(file)} is the displacement or velocity that drives"
            return Missing(f"channel {MOTIONS[0]}", what)
        driven = ", or say --output force where the motion drives" if "force" in known.channels else ""
        moved = ", or the acceleration of the base" if "acceleration" in known.channels else ""
        what = f"which column of {_listed(file)} is the command, or the force that drives{moved}{driven}"
        return Missing("channel command", what)

    def _said(self, file: RawFile, channel: str) -> str | int:
        return self.answers.of(file_name(file)).channels.get(channel, Answer()).column

    @property
    def doubts(self) -> tuple[str, ...]:
        """What was taken from names and heads, and what no file states, once each, with the files where not all."""
        known = [self.known(file) for file in self.files]
        remarks = [remark for file in self.files for remark in file.remarks]
        found: dict[str, list[str]] = {}
        for file, one in zip(self.files, known, strict=True):
            for doubt in dict.fromkeys(one.doubts):
                found.setdefault(doubt, []).append(file.name)
        told = [
            doubt if len(names) == len(self.files) else f"{first_of(names)}: {doubt}" for doubt, names in found.items()
        ]
        return tuple(dict.fromkeys([*remarks, *told, *self._on_hold(known)]))

    def _on_hold(self, known: Sequence[Known]) -> Iterator[str]:
        """What was taken of the command between its samples."""
        if "hold" in self.answers.common:
            return
        held = [file.name for file, one in zip(self.files, known, strict=True) if one.hold == "zoh"]
        if not held:
            drawn = _DRAWN if any("command" in one.channels for one in known) else _MOVED
            yield _CURVED if self._are_curves(known) else drawn
            return
        if len(held) == len(known):
            yield _HELD
            return
        yield (
            f"the command of {first_of(held)} rests and jumps, so a zero-order hold is assumed there (hold: zoh). "
            "In the other files the command is assumed to be linear between samples (hold: linear); set zoh if held"
        )

    def _are_curves(self, known: Sequence[Known]) -> bool:
        """Whether reading will take the commands, of which none is held, to be band-limited."""
        drives = [
            (file, one.channels["command"])
            for file, one in zip(self.files, known, strict=True)
            if "command" in one.channels
        ]
        return are_band_limited([file.values(answer.column) for file, answer in drives])

    def description(self) -> dict[str, Any]:
        """What matrix.yaml says. Raises Unusable ``not-stated`` with everything that is missing."""
        if missing := self.missing:
            what = str(message("draft.missing", questions=[one.question for one in missing]))
            raise Unusable("not-stated", what, "init", str(message("draft.say", options=self.options)))
        runs = [self._run(file, name) for file, name in zip(self.files, run_ids(self.files), strict=True)]
        return {"actuator": {"serial": self.answers.serial, **self.answers.actuator}, "runs": runs}

    @property
    def options(self) -> tuple[str, ...]:
        """How everything that is missing is said on the command line; in capitals what only the user knows.

        A column is named where one alone is left, and one channel alone that it can be.
        """
        return tuple(option for one in self.missing for option in self._options(one))

    @property
    def is_whole(self) -> bool:
        """Whether the options leave nothing to replace: no word in capitals that only the user knows."""
        return not any(word in option for option in self.options for word in _TO_REPLACE)

    def _options(self, missing: Missing) -> Iterator[str]:
        """An option, or one a file where something is missing in some files only."""
        if not missing.files:
            yield "--serial SERIAL"
            return
        named = {file_name(file): file for file in self.files}
        for name in missing.files[:1] if self.of_all(missing) else missing.files:
            yield self._option(missing.key, named[name], "" if self.of_all(missing) else f"@{name}=")

    def _option(self, key: str, file: RawFile, at: str) -> str:
        """How an answer is given; `at` says of which file alone."""
        kind, _, name = key.partition(" ")
        if kind == "dialect":
            return f"--dialect {at}delimiter=NAME"
        clock, others = self._left(file)
        if kind == "rate":
            return f"--time {quote(f'{at}{clock.name}')}:UNIT" if clock else f"--rate '{at}RATE Hz'"
        alone = len(others) == 1 and sum(one.key.startswith("channel") for one in self._missing_of(file)) == 1
        column, unit = "", ":UNIT"
        if kind == "channel":
            column = quote(others[0].name) if alone else "COLUMN"
            unit = "" if alone and unit_of(others[0]) else unit
        return f"--time {at}{column}{unit}" if name == "time" else f"--channel {name}{at or '='}{column}{unit}"

    def _left(self, file: RawFile) -> tuple[Column | None, list[Column]]:
        """The columns that are nothing yet: the one that may be the time, as its samples only increase; the others.

        Of several it is the one that begins nearest to zero: a date counts from long ago.
        """
        known = self.known(file)
        answers = [*known.channels.values(), *([known.time] if known.time.column != "" else [])]
        taken = {number for answer in answers for number in file.table.numbers(answer.column, file.name)}
        left = [column for column in file.columns if column.number not in taken]
        timed = known.time.column != "" or known.rate
        times = {one: file.values(one.number) for one in left} if not timed else {}
        increasing = {one: samples for one, samples in times.items() if (np.diff(samples) > 0).all()}
        clock = min(increasing, key=lambda one: abs(increasing[one][0]) / np.ptp(increasing[one]), default=None)
        return clock, [one for one in left if one is not clock]

    def _run(self, file: RawFile, name: str) -> dict[str, Any]:
        known = self.known(file)
        output = self.answers.output or next(one for one in OUTPUTS if one in known.channels)
        run: dict[str, Any] = {"id": name, "file": f"runs/{file_name(file)}"}
        if known.time.column != "":
            run["time"] = {"column": file.stated(known.time.column), "unit": known.time.unit}
            run["time"] |= {"resample": known.rate} if known.rate else {}
        else:
            run["sample_rate"] = known.rate
        run |= {"skip_rows": file.skip_rows} if file.skip_rows else {}
        run |= {"dialect": file.dialect.entries} if file.dialect.entries else {}
        run |= {"output": output} if output != OUTPUTS[0] else {}
        run |= {"hold": "zoh"} if known.hold == "zoh" else {}
        run |= {
            "use": "verify" if file_name(file) in self.answers.verify else "fit",
            **self.answers.common,
        }
        if self.answers.validation and run["use"] == "fit":
            rows = len(file.samples(known.channels[output].column))
            run["split"] = {"validation": [round((1.0 - self.answers.validation) * rows), rows]}
        channels = sorted(known.channels.items(), key=lambda item: CHANNELS.index(item[0]))
        return run | {"channels": {name: {"column": file.stated(a.column), "unit": a.unit} for name, a in channels}}


def file_name(file: RawFile) -> str:
    """The name of a file without its folder: what answers call it."""
    return PurePosixPath(file.name).name


def _stays(file: RawFile, channel: str, of: Answer, columns: Sequence[Column], said: FileAnswers) -> bool:
    """Whether a column still is the channel that its name looks like, once it was said what `columns` are."""
    number = file.table.numbers(of.column, file.name)[0]
    return channel in said.channels or all(number != one.number for one in columns)


def _sparse(file: RawFile, channels: Mapping[str, Answer], said: FileAnswers) -> dict[str, tuple[Answer, float]]:
    """The channels that only a name makes one, of columns with a value in less than half as many rows as the fullest
    channel has, with that share of the rows: a sample needs a value of each channel."""
    filled = {column.number: column.filled for column in file.columns}
    numbers = {channel: file.table.numbers(answer.column, file.name) for channel, answer in channels.items()}
    shares = {channel: min(filled.get(number, 0.0) for number in of) for channel, of in numbers.items()}
    least = 0.5 * max(shares.values(), default=0.0)
    return {name: (channels[name], of) for name, of in shares.items() if of < least and name not in said.channels}


def _clock(file: RawFile, said: FileAnswers, channels: Mapping[str, Answer]) -> tuple[Answer, str, tuple[str, ...]]:
    """Column of times or rate, and what was assumed; where both were stated the record is brought to the rate."""
    answer = said.time
    if answer.column not in ("", NONE):
        (column,) = _columns(file, file.table.number(answer.column, f"{file.name}: time"), "time")
        return Answer(answer.column, answer.unit or column.unit), said.rate, tuple(_other_unit(column, answer.unit))
    if said.rate:
        return Answer(), said.rate, ()
    named = [] if answer.column == NONE else [column for column in file.columns if is_time(column.meaning)]
    if len(named) > 1:
        named = _as_long_as(file, named, channels)
    if len(named) == 1:
        unit = unit_of(named[0])
        use = "time" if unit == named[0].unit else f"time in {unit}"
        by_name = str(message("draft.named", column=shown(named[0].name), use=use))
        found = Answer(named[0].name, answer.unit or unit)
        return found, "", (by_name, *_other_unit(named[0], answer.unit))
    if (rate := file.rate) is None:
        clock = None if answer.column == NONE else unnamed_clock(file)
        if clock is None:
            return Answer(), "", ()
        unnamed = message("draft.first_is_time", number=clock.number)
        return Answer(clock.number, answer.unit or clock.unit), "", (str(unnamed),)
    told = message(rate.told, rate=rate.value, variable=shown(rate.variable))
    return Answer(), f"{rate.value:g} Hz", (str(told),)


def _as_long_as(file: RawFile, columns: Sequence[Column], channels: Mapping[str, Answer]) -> list[Column]:
    """The columns with as many samples as the channels: a file of MATLAB may hold the clocks of other signals, too."""
    lengths = {file.samples(answer.column).size for answer in channels.values()}
    return [column for column in columns if file.samples(column.number).size in lengths]


def _other_unit(time: Column, said: str) -> Iterator[str]:
    """That the unit said of a column of times is not the one that its file states."""
    if said and time.unit not in ("", said):
        yield _contradicted(time.name, "time", said, time.unit)


def _contradicted(column: str, what: str, said: str, stated: str) -> str:
    return f"{shown(column)!r} is {what} in {said}, as was said; the file states {stated}"


def _columns(file: RawFile, column: str | int, where: str) -> list[Column]:
    """The column of numbers that an answer names, the two of a difference. Raises Unusable."""
    numbers = file.table.numbers(column, f"{file.name}: {where}")
    found = [one for number in numbers for one in file.columns if one.number == number]
    if len(found) < len(numbers):
        why = "; ".join(filter(None, (file.flaw(number) for number in numbers)))
        what = f"column {shown(column)!r} does not hold numbers throughout"
        remedy = "repair it, or cut the file before or behind it" if why else "name another column"
        raise Unusable("not-numeric", f"{what}: {why}" if why else what, file.name, remedy)
    return found


def _unused(file: RawFile, used: Sequence[str | int]) -> Iterator[str]:
    """The columns of numbers that no answer names: one may be a channel that the user did not name."""
    numbers = {number for column in used for number in file.table.numbers(column, file.name)}
    unused = [repr(shown(column.name)) for column in file.columns if column.number not in numbers]
    if unused:
        yield str(message("draft.unused", columns=first_of(unused)))


def _unit(columns: Sequence[Column]) -> str:
    """The unit that all of some columns have."""
    units = {unit_of(column) for column in columns}
    return units.pop() if len(units) == 1 else ""


def _listed(file: RawFile) -> str:
    more = len(file.left_out) - _LEFT_OUT
    columns = message("draft.columns", columns=some_of([column.name for column in file.columns]))
    left_out = [columns, *file.left_out[:_LEFT_OUT], *([message("draft.more", count=more)] if more > 0 else [])]
    return str(message("draft.file", file=file.name, parts=left_out))


def run_ids(files: Sequence[RawFile]) -> list[str]:
    """An id for each file, after its name; a number behind those that are there already."""
    ids: list[str] = []
    for file in files:
        name = file_name(file)
        stem = file.part or name.removesuffix(PACKED).rpartition(".")[0].lstrip(".") or "run"
        plain = "".join(sign if sign.isalnum() or sign in "-_ " else "-" for sign in stem)[:80]
        number = sum(one == plain or one.startswith(f"{plain}-") for one in ids)
        ids.append(plain if plain not in ids else f"{plain}-{number + 1}")
    return ids
