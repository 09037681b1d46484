"""Drafts: raw files, what they state, and what a person says of them."""

from pydantic import BaseModel, ConfigDict, Field

from schemas.matrix import FindingView

_LINE = 500  # characters


class AnswerRequest(BaseModel):
    """The column of a channel or of the time, by name or 0-based number, and its unit; ``-`` where there is none."""

    model_config = ConfigDict(extra="forbid")
    column: str | int = Field(default="", description="Name or 0-based number")
    unit: str = Field(default="", max_length=_LINE)


class FileAnswersRequest(BaseModel):
    """What a person says of one raw file; what is left out is as said of all of them, or as the file states it."""

    model_config = ConfigDict(extra="forbid")
    channels: dict[str, AnswerRequest] = Field(default_factory=dict)
    time: AnswerRequest = Field(default_factory=AnswerRequest)
    rate: str = Field(default="", max_length=_LINE, description="Sample rate, where no column of it has the time")


class AnswersRequest(BaseModel):
    """What a person says of raw files, for all of them; what is left out is as the files state it."""

    model_config = ConfigDict(extra="forbid")
    serial: str = Field(default="", max_length=_LINE)
    channels: dict[str, AnswerRequest] = Field(default_factory=dict)
    time: AnswerRequest = Field(default_factory=AnswerRequest)
    rate: str = Field(
        default="", max_length=_LINE, description="Sample rate, such as 4096 Hz, where no column has the time"
    )
    output: str = Field(default="", max_length=_LINE, description="Channel that a model is to reproduce")
    verify: list[str] = Field(default_factory=list, description="Files whose runs only verify")
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


class RawFileView(BaseModel):
    """A raw file: a run. `channels`, `time` and `rate` are what is known of it with the answers."""

    name: str
    samples: int
    columns: list[ColumnView]
    channels: dict[str, AnswerView] = Field(default_factory=dict)
    time: AnswerView = AnswerView(column="", unit="")
    rate: str = ""


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
