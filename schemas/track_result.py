"""A run that was followed, in the contract's words; SI where no unit is."""

from pydantic import BaseModel


class TrackNoise(BaseModel):
    """Standard deviations assumed of the sensor (m) and of the drift of τ (s/√s) and k (1/√s)."""

    measurement: float
    tau: float
    gain: float


class TrackView(BaseModel):
    """A run followed as if it came in now, as `servoident track --json` writes it; at most 4,096 rows.

    `tau` in s (in samples where the clock of the run is unknown), `gain` and their standard deviations over `t`.
    """

    run: str
    nis_mean: float | None
    holds: bool
    reason: str
    outliers: int
    changes: int
    noise: TrackNoise
    t: list[float]
    tau: list[float]
    gain: list[float]
    std_tau: list[float]
    std_gain: list[float]
