"""What came of controllers and hybrid simulations, in the contract's words; SI where no unit is."""

from pydantic import BaseModel, Field

from ident.hybrid.drawn_simulations import DrawnSimulations
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.hybrid.interval import Interval
from ident.hybrid.margins import Margins
from ident.hybrid.shaking_table import Acceleration
from ident.hybrid.target_loop import Target
from ident.stability.judgement import Judgement


class GammaView(BaseModel):
    """γmin of the target, γmin with its roll-off, and the γ that was used."""

    target: float
    min: float
    used: float


class OrderView(BaseModel):
    """States of the controller before and after its reduction."""

    full: int
    reduced: int


class RobustnessView(BaseModel):
    """Of how many draws from the `spread` how many stay stable and within 1 dB and 10° to 25 Hz.

    `margins`: `gain` (dB), `phase` (°) and `sensitivity_peak` of the loop, and of 90 % of the stable draws.
    """

    draws: int
    stable: int
    within: int
    held: list[str]
    spread: str = ""
    margins: dict[str, Interval] = Field(default_factory=dict)


class DesignView(BaseModel):
    """How a controller was designed; without `robustness` the fit states no standard errors.

    `state` is `stable` or `unstable`, of its case under it, null where that has no poles; `stability` judges the loop.
    """

    state: str | None = None
    stability: Judgement | None = None
    structure: str
    target: Target
    delay: float
    gamma: GammaView
    order: OrderView
    margins: Margins
    notes: list[str]
    robustness: RobustnessView | None = None


class ControllerView(BaseModel):
    """A stored controller, the fit and the case that it was designed for."""

    id: str
    fit: str
    case: str
    created_at: str
    name: str
    sample_rate: float
    design: DesignView


class ControllerPage(BaseModel):
    """A page of controllers, newest first."""

    items: list[ControllerView]
    next: str | None = None


class ScoresView(BaseModel):
    """Null where the simulation ran away. `delay` in s; `tracking_*` measured against numerical displacement,
    `reference_*` measured and `numerical_rms` numerical against the reference solution; fractions."""

    delay: float | None
    tracking_rms: float | None
    tracking_peak: float | None
    reference_rms: float | None
    reference_peak: float | None
    numerical_rms: float | None


class ShareMapView(BaseModel):
    """Over shares of `mass` (rows) and `stiffness` (columns) that are physical; null where it ran away."""

    mass: list[float]
    stiffness: list[float]
    stable: list[list[bool]]
    reference_rms: list[list[float | None]]
    tracking_rms: list[list[float | None]]
    critical_delay: list[list[float | None]]


class _OfOneActuator(BaseModel):
    """The verdict and the scores of a hybrid simulation, as `servoident hybrid --json` writes them.

    `ended` (s) is when it ran away; `largest_pole` the largest magnitude of a pole of the sampled loop, null where it
    is not linear; `seconds` what the computation took. `state` is `stable` or `unstable`; `stability` says of an
    unstable loop with poles what would make it stable. `acceleration` is there of a shaking table.
    """

    state: str | None = None
    stability: Judgement | None = None
    case: str
    ground: str
    controller: str
    effects: dict[str, float]
    stable: bool
    scores: ScoresView
    command_rms: float | None
    critical_delay: float | None
    ended: float | None
    largest_pole: float | None
    sample_rate: float
    delay: int
    samples: int
    units: dict[str, str]
    notes: list[str]
    seconds: float
    acceleration: Acceleration | None = None


class HybridPartView(_OfOneActuator):
    """What one of several actuators gave, by the `name` of its part; what holds for the whole stands with each."""

    name: str


class DelayMapView(BaseModel):
    """Whether the loop is stable over delays in samples of two `parts`: `first` (rows), `second` (columns).

    `radius` is the largest magnitude of a pole of the sampled loop.
    """

    parts: list[str]
    first: list[int]
    second: list[int]
    stable: list[list[bool]]
    radius: list[list[float]]


class HybridResultView(_OfOneActuator):
    """As one actuator gives it; of several the largest of each score, and each of the `parts`."""

    parts: list[HybridPartView] = Field(default_factory=list)
    delay_map: DelayMapView | None = None


class HybridView(HybridResultView):
    """A stored hybrid simulation; its id is that of its job.

    `without` is the same without a controller, `controller_id` the stored controller, `map` there where it was asked
    for, `feedforward` under that controller, `spread` where one was stated. Figures at
    `…/figures/NAME.{json,svg,png,pdf}` have the names in `figures`; of several actuators with `?part=NAME`.
    """

    id: str
    fit: str
    matrix: str
    serial: str
    created_at: str
    controller_id: str | None
    without: HybridResultView | None
    map: ShareMapView | None
    feedforward: FeedforwardTracking | None = None
    spread: DrawnSimulations | None = None
    figures: list[str]


class HybridPage(BaseModel):
    """A page of hybrid simulations, newest first, without their maps and curves."""

    items: list[HybridView]
    next: str | None = None
