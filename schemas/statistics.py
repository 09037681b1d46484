"""What the sets of a batch, or of an actuator over time, tell about the process that made them."""

from typing import Literal

from pydantic import BaseModel


class PointView(BaseModel):
    """One set on the chart, in the order of production; `moving_range` is the distance from the one before."""

    fit: str
    serial: str
    created_at: str
    value: float
    std_error: float | None
    moving_range: float | None


class SignalView(BaseModel):
    """The point at `place` (from 0) completes what a rule of Western Electric forbids."""

    place: int
    rule: int
    text: str


class ControlChartView(BaseModel):
    """Centre and 3 σ limits of individuals, σ from the mean moving range; the limit of moving ranges."""

    centre: float
    sigma: float
    lower: float
    upper: float
    mean_range: float
    upper_range: float
    signals: list[SignalView]
    wide_ranges: list[int]


class CapabilityView(BaseModel):
    """Cpk against the limits that are set, with the ends of its 95 % confidence interval."""

    lower: float | None
    upper: float | None
    cp: float | None
    cpk: float
    low: float
    high: float
    outside: int


class ProductLimitsView(BaseModel):
    """The limits that are set for the quantity, either of which may be open, and how many values lie outside."""

    lower: float | None
    upper: float | None
    outside: int


class OutlierView(BaseModel):
    """A value far from the others, with its modified z-score."""

    fit: str
    serial: str
    value: float
    score: float


class DriftView(BaseModel):
    """Change of the quantity a year, and the chance of one so steep where nothing drifts."""

    slope: float
    std_error: float
    p: float
    significant: bool


class StatisticsView(BaseModel):
    """Statistics of one parameter over sets; values are in `unit`, percentiles by their number.

    `left_out` is true where there are more sets than were taken, which are the newest. `limits` are those of the
    product, null where none are set; `capability` is null where Cpk is not given, and `no_capability` says why.
    `unstable` is the number of further sets whose model is unstable on a run: their error is in none of the numbers,
    and outside an upper limit.
    """

    parameter: str
    unit: str
    model: str
    n: int
    mean: float
    deviation: float | None
    minimum: float
    maximum: float
    percentiles: dict[str, float]
    control_chart: ControlChartView | None
    capability: CapabilityView | None
    outliers: list[OutlierView]
    drift: DriftView | None
    points: list[PointView]
    left_out: bool
    limits: ProductLimitsView | None = None
    no_capability: str = ""
    unstable: int = 0


class ConditionPointView(BaseModel):
    """The value of a set, and the condition of its test."""

    fit: str
    serial: str
    condition: float
    value: float
    std_error: float | None


class ConditionLawView(BaseModel):
    """A law that was tried: its formula, its probability among all, and the scatter of the sets about it.

    `scatter` is the standard deviation of the logarithm of the value where `relative`, else that of the value.
    `lack_of_fit` is the chance of so large a lack of fit were the law true; null of too few sets.
    """

    name: str
    formula: str
    probability: float
    scatter: float
    relative: bool
    lack_of_fit: float | None
    holds: bool


class LevelView(BaseModel):
    """The law at a condition, with its 95 % band."""

    condition: float
    value: float
    std_error: float
    lower: float
    upper: float


class AtView(BaseModel):
    """What is said at the condition that was asked for: null with the reason where the law says nothing there.

    `outcome` is against the limits of the quantity, null where none are set: on one side of them with 99 % confidence,
    or `unknown`.
    """

    condition: float
    level: LevelView | None
    outcome: Literal["inside", "outside", "unknown"] | None
    reason: str


class DependenceView(BaseModel):
    """A parameter over a condition of the tests, SI: the sets, the laws (the most probable first), and a band.

    `without` is the number of sets that do not know the condition; `law` the first of the laws, null where there are
    too few sets; `text` says it in words.
    """

    parameter: str
    unit: str
    model: str
    over: str
    over_unit: str
    n: int
    without: int
    left_out: bool
    points: list[ConditionPointView]
    laws: list[ConditionLawView]
    law: str | None
    holds: bool
    text: str
    band: list[LevelView]
    limits: ProductLimitsView | None
    at: AtView | None
