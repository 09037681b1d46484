"""What a person says of raw files: of all of them, and of one file where that differs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from ident.errors import Unusable
from ident.readers.dialect import FOUND, Dialect
from ident.run import CHANNELS
from ident.units.quantity import shown
from ident.words.nearest import did_you_mean

NONE = "-"
"""The answer that a channel, or a column of times, is not there, though a column is called after it."""


@dataclass(frozen=True)
class Answer:
    """Which column a channel or the time is, by name or number, and its unit; what is empty is not answered."""

    column: str | int = ""
    unit: str = ""

    def over(self, other: Answer) -> Answer:
        """This answer, completed by a more general one: a unit belongs to the column that it was said of."""
        return self if self.column != "" else Answer(other.column, self.unit or other.unit)


@dataclass(frozen=True)
class FileAnswers:
    """What is said of one file: the column and the unit of each channel and of the time, or the sample rate; of a text
    the dialect that it is read in.

    Raises Unusable: ``unknown-channel``.
    """

    channels: Mapping[str, Answer] = field(default_factory=dict)
    time: Answer = Answer()
    rate: str = ""
    dialect: Dialect = FOUND

    def __post_init__(self) -> None:
        for channel in self.channels:
            _check(channel)

    def over(self, other: FileAnswers) -> FileAnswers:
        """These answers, completed by more general ones.

        A column of times stated here outweighs a rate stated there, and a rate a column of times. Of a column of times
        and a rate that are stated at the same place both hold: the record is brought to the rate.
        """
        channels = {
            name: self.channels.get(name, Answer()).over(other.channels.get(name, Answer()))
            for name in {**other.channels, **self.channels}
        }
        timed = self.time.column not in ("", NONE)
        rate = self.rate or ("" if timed else other.rate)
        time = self.time if self.rate and not timed else self.time.over(other.time)
        return FileAnswers(channels, time, rate, self.dialect.over(other.dialect))


@dataclass(frozen=True)
class Answers:
    """What a person says of raw files. `common` are further entries of every run, as they stand in matrix.yaml.

    `channels`, `time`, `rate` and `dialect` hold for every file, but for what `files` says of one of them, by its name.
    `validation` is the share of every run, at its end, that is validation data; 0 for none.
    Raises Unusable: ``unknown-channel``, ``bad-split``.
    """

    serial: str = ""
    channels: Mapping[str, Answer] = field(default_factory=dict)
    time: Answer = Answer()
    rate: str = ""
    dialect: Dialect = FOUND
    output: str = ""
    verify: tuple[str, ...] = ()
    validation: float = 0.0
    actuator: Mapping[str, str] = field(default_factory=dict)
    common: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, FileAnswers] = field(default_factory=dict)

    def __post_init__(self) -> None:
        _ = self.of_all
        if not 0.0 <= self.validation < 1.0:
            what = f"a share of {self.validation:g} of every run cannot be validation data"
            raise Unusable("bad-split", what, "validation", "give a share from 0 to below 1, as 0.3")
        if self.output:
            _check(self.output)

    @property
    def of_all(self) -> FileAnswers:
        """What holds for every file."""
        return FileAnswers(self.channels, self.time, self.rate, self.dialect)

    def of(self, file: str) -> FileAnswers:
        """What holds for one file, by its name."""
        return self.files.get(file, FileAnswers()).over(self.of_all)

    def with_file(self, file: str, said: FileAnswers) -> Answers:
        """The answers with more said of one file."""
        return replace(self, files={**self.files, file: said.over(self.files.get(file, FileAnswers()))})


def _check(channel: str) -> None:
    if channel not in CHANNELS:
        raise Unusable("unknown-channel", f"no channel {shown(channel)!r}", "channel", did_you_mean(channel, CHANNELS))
