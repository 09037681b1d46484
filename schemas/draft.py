"""Drafts: raw files, what they state, and what a person says of them."""

from pydantic import BaseModel, ConfigDict, Field

from schemas.matrix import FindingView

_LINE = 500  # characters


class AnswerRequest(BaseModel):
    """The column of a channel or of the time, by name or 0-based number, and its unit; ``-`` where there is none."""

    model_config = ConfigDict(extra="forbid")
    column: str | int = Field(default="", description="Name or 0-based number")
    unit: str = Field(default="", max_length=_LINE)


class DialectRequest(BaseModel):
    """How a text is laid out, as far as it is stated; what is left out is found in the text.

    `header_rows` lines stand above the first row of samples, `skip_rows` above the line of column names.
    """

    model_config = ConfigDict(extra="forbid")
    delimiter: str = Field(default="", max_length=_LINE, description="tab, semicolon, comma, pipe or space")
    decimal: str = Field(default="", max_length=_LINE, description="point or comma")
    header_rows: int | None = Field(default=None, ge=0)
    skip_rows: int = Field(default=0, ge=0)
    encoding: str = Field(default="", max_length=_LINE, description="utf-8, windows-1252 and others")


class FileAnswersRequest(BaseModel):
    """What a person says of one raw file; what is left out is as said of all of them, or as the file states it."""

    model_config = ConfigDict(extra="forbid")
    channels: dict[str, AnswerRequest] = Field(default_factory=dict)
    time: AnswerRequest = Field(default_factory=AnswerRequest)
    rate: str = Field(default="", max_length=_LINE, description="Sample rate, where no column of it has the time")
    dialect: DialectRequest = Field(default_factory=DialectRequest, description="Of a text: how it is laid out")


class AnswersRequest(BaseModel):
    """What a person says of raw files, for all of them; what is left out is as the files state it."""

    model_config = ConfigDict(extra="forbid")
    serial: str = Field(default="", max_length=_LINE)
    channels: dict[str, AnswerRequest] = Field(default_factory=dict)
    time: AnswerRequest = Field(default_factory=AnswerRequest)
    rate: str = Field(
        default="", max_length=_LINE, description="Sample rate, such as 4096 Hz, where no column has the time"
    )
    dialect: DialectRequest = Field(default_factory=DialectRequest, description="Of texts: how they are laid out")
    output: str = Field(default="", max_length=_LINE, description="Channel that a model is to reproduce")
    verify: list[str] = Field(default_factory=list, description="Files whose runs only verify")
    validation: float = Field(
        default=0.0, ge=0, lt=1, description="Share of every run, at its end, that is validation data behind a gap"
    )
    area: str = Field(default="", max_length=_LINE, description="Piston area, such as 497 mm^2")
    gain: str = Field(default="", max_length=_LINE, description="Gain Kp of the loop in every run")
    hold: str = Field(
        default="",
        max_length=_LINE,
        description="The command between samples: linear, zoh or band-limited; empty: detected automatically",
    )
    files: dict[str, FileAnswersRequest] = Field(
        default_factory=dict,
        description="By the name of a file: its own columns, units and rate, where they differ from those of all",
    )


class AnswerView(BaseModel):
    """A column and its unit; empty what is not known."""

    column: str | int
    unit: str


class ColumnView(BaseModel):
    """A column of numbers: the unit that the file states, and what it is taken for: a channel, time, or nothing."""

    number: int
    name: str
    unit: str
    role: str
    first: list[float] = Field(default_factory=list)


class DialectView(BaseModel):
    """How a text is read, as stated or found; empty and null of a binary, and of a text that cannot be read so."""

    delimiter: str
    decimal: str
    header_rows: int | None
    skip_rows: int
    encoding: str


class RawFileView(BaseModel):
    """A raw file: a run. `channels`, `time` and `rate` are what is known of it with the answers.

    `lines` are the first ones of a text as they stand in it, `first` those of the samples of each column as they are
    read; `problem` says why a text has no columns in this dialect.
    """

    name: str
    samples: int
    columns: list[ColumnView]
    channels: dict[str, AnswerView] = Field(default_factory=dict)
    time: AnswerView = AnswerView(column="", unit="")
    rate: str = ""
    dialect: DialectView
    lines: list[str] = Field(default_factory=list)
    problem: str = ""


class MissingView(BaseModel):
    """One thing that `files` do not state; of none of them, where none is named."""

    key: str
    question: str
    files: list[str] = Field(default_factory=list)


class DraftView(BaseModel):
    """A draft under some answers; `channels`, `time` and `rate` are those of the first file.

    `findings` and `description`, the text of matrix.yaml, are there once nothing is missing.
    """

    id: str
    files: list[RawFileView]
    channels: dict[str, AnswerView]
    time: AnswerView
    rate: str
    missing: list[MissingView]
    doubts: list[str]
    findings: list[FindingView]
    description: str
