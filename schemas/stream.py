"""What goes over the WebSocket of the tracking filter."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

MOST_ROWS = 65_536
_LARGEST = 1e9
Finite = Annotated[float, Field(ge=-_LARGEST, le=_LARGEST, allow_inf_nan=False)]


class StreamNoise(BaseModel):
    """The sensor's noise, m, and the fictitious noise of τ, s/√s, and of k, 1/√s; what is left out follows by rule."""

    model_config = ConfigDict(extra="forbid")

    measurement: float | None = Field(default=None, gt=0, le=_LARGEST, allow_inf_nan=False)
    tau: float | None = Field(default=None, ge=0, le=_LARGEST, allow_inf_nan=False)
    gain: float | None = Field(default=None, ge=0, le=_LARGEST, allow_inf_nan=False)


class StreamStart(BaseModel):
    """The first message: sample rate, Hz, what r does between samples, and where the filter starts: τ, s, and k.

    With `alarms` the loop is watched: that it stays of first order, and within `rig`, the limits of stroke and speed
    with their units. A stream with a `name` is watched, marked and recorded at /live.
    """

    model_config = ConfigDict(extra="forbid")

    sample_rate: float = Field(gt=0, le=1e7, allow_inf_nan=False)
    hold: Literal["linear", "zoh"] = "linear"
    tau0: float = Field(default=0.02, gt=0, le=_LARGEST, allow_inf_nan=False)
    gain0: Finite = 1.0
    noise: StreamNoise = StreamNoise()
    alarms: bool = False
    name: str | None = Field(default=None, min_length=1, max_length=60, pattern=r"^[A-Za-z0-9._-]+$")
    rig: dict[str, Annotated[str, Field(max_length=200)]] | None = Field(default=None, max_length=6)


class StreamSamples(BaseModel):
    """A message of samples: the reference r and the measured y, m; a y that is null was not measured."""

    model_config = ConfigDict(extra="forbid")

    r: list[Finite] = Field(max_length=MOST_ROWS)
    y: list[Finite | None] = Field(max_length=MOST_ROWS)


class StreamAlarm(BaseModel):
    """An alarm that begins or ends `at` s after the first sample: "not first order", or the name of a limit."""

    kind: str
    begins: bool
    at: float
    text: str


class StreamAlarms(BaseModel):
    """What follows the answer to a binary message where an alarm began or ended in it."""

    alarms: list[StreamAlarm]


class StreamEstimates(BaseModel):
    """The answer to samples, a value a sample: τ, s, k, y, m, their variances, the normalised innovation squared.

    `alarms` are there where they were asked for.
    """

    tau: list[float]
    gain: list[float]
    y: list[float]
    var_tau: list[float]
    var_gain: list[float]
    nis: list[float]
    alarms: list[StreamAlarm] | None = None
