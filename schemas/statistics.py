"""What the sets of a batch, or of an actuator over time, tell about the process that made them."""

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
