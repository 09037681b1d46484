"""Streams of the tracking filter that are watched while a test runs."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from schemas.stream import StreamAlarm

Name = Annotated[str, Field(min_length=1, max_length=60, pattern=r"^[A-Za-z0-9._-]+$")]
"""Of a stream: letters, digits, dot, hyphen and underscore."""


class RemarkView(BaseModel):
    """A remark at `at` s after the first sample."""

    at: float
    text: str


class RecordingView(BaseModel):
    """Samples that are kept from `begins` s on: whether more are, how many there are, and whether the room is full."""

    on: bool
    begins: float
    samples: int
    full: bool


class LiveView(BaseModel):
    """A named stream: its clock in s after the first sample, what is alarming now, and its recording.

    `hold` says what the command does between samples; `ended` is true where its connection is closed.
    """

    name: str
    sample_rate: float
    hold: str
    seconds: float
    ended: bool
    on: list[str]
    alarms: list[StreamAlarm]
    marks: list[RemarkView]
    recording: RecordingView | None


class LiveList(BaseModel):
    """The named streams, those under way first."""

    items: list[LiveView]


class LiveBins(BaseModel):
    """What a stream shows from bin `first` on, 64 bins a second: one list a column.

    t in s; the smallest and largest command and displacement, m; τ and k with their standard deviations; the mean of
    the normalised innovation squared. A displacement that was not measured is null.
    """

    first: int
    t: list[float]
    r_low: list[float]
    r_high: list[float]
    y_low: list[float | None]
    y_high: list[float | None]
    tau: list[float]
    std_tau: list[float]
    gain: list[float]
    std_gain: list[float]
    nis: list[float | None]


class LiveEvent(BaseModel):
    """An event of a stream that is watched: its state, and the bins that are new."""

    state: LiveView
    bins: LiveBins


class MarkRequest(BaseModel):
    """A remark at the sample that came last."""

    model_config = ConfigDict(extra="forbid")
    text: str = Field(min_length=1, max_length=100)


class RecordingRequest(BaseModel):
    """Begin to keep samples, or end; to begin again lets go of what was kept."""

    model_config = ConfigDict(extra="forbid")
    on: bool


class RunRequest(BaseModel):
    """The run that a recording becomes: of which actuator, and its id."""

    model_config = ConfigDict(extra="forbid")
    serial: str = Field(min_length=1, max_length=200)
    run: Name
    batch: str = Field(default="", max_length=200)
