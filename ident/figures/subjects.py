"""What figures are of, where that is more than one result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ident.comparison.profile import Profile
from ident.comparison.side_by_side import SideBySide
from ident.decimation.levels import Levels
from ident.errors import Unusable
from ident.figures.traces import Trace, traced
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller_design import ControllerDesign
from ident.hybrid.coupled_stability import DelayMap
from ident.hybrid.feedforward_tracking import FeedforwardTracking
from ident.hybrid.hybrid_simulation import HybridResult
from ident.hybrid.share_map import ShareMap
from ident.hybrid.tracked_run import Track
from ident.matrix import Actuator
from ident.run import Run
from ident.statistics import ControlChart
from ident.statistics.dependence import Dependence
from ident.words.nearest import did_you_mean

Step = tuple[str, float | None, float | None]
"""Label, error on the runs to fit, error on the runs to verify."""


@dataclass(frozen=True)
class Ladder:
    """The steps of adding effects, and the noise floor below them."""

    steps: Sequence[Step]
    floor: float | None
    actuator: Actuator


@dataclass(frozen=True)
class Recorded:
    """What was measured of an actuator, before any fit. `levels`, where they are stored, thin the runs over time."""

    runs: Sequence[Run]
    actuator: Actuator
    levels: Levels | None = None

    def chosen(self, wanted: str | Sequence[str] | None, most: int) -> tuple[Run, ...]:
        """The runs of these ids, the first run where none is named.

        Raises Unusable: ``unknown-run``; ``too-many-runs`` for more than `most`.
        """
        ids = [wanted] if isinstance(wanted, str) else list(wanted or ())
        known = {run.id: run for run in self.runs}
        for name in ids:
            if name not in known:
                what = f"there is no run {name!r}"
                raise Unusable("unknown-run", what, "figure option run", did_you_mean(name, known))
        if len(ids) > most:
            raise Unusable(
                "too-many-runs", f"{len(ids)} runs are chosen", "figure option run", f"choose {most} at most"
            )
        return tuple(known[name] for name in dict.fromkeys(ids)) or tuple(self.runs[:1])

    def traced(self, wanted: str | Sequence[str] | None, most: int) -> tuple[Trace, ...]:
        """The chosen runs as they are drawn over time. Raises Unusable as :meth:`chosen`."""
        return tuple(traced(run, self.levels) for run in self.chosen(wanted, most))


@dataclass(frozen=True)
class Profiled:
    """The profile likelihood of a parameter of a fit."""

    profile: Profile
    actuator: Actuator
    fit: FitResult


@dataclass(frozen=True)
class Compared:
    """Several fits, and the actuator whose runs they are of."""

    fits: SideBySide
    actuator: Actuator


@dataclass(frozen=True)
class Designed:
    """A controller, and the name of the case that it was designed for."""

    design: ControllerDesign
    case: str = ""


@dataclass(frozen=True)
class Simulated:
    """Hybrid simulations of a case by what controlled them, the first the one that was asked for; what else was."""

    runs: Mapping[str, HybridResult]
    case: Case
    share_map: ShareMap | None = None
    feedforward: FeedforwardTracking | None = None

    @property
    def controller(self) -> str:
        """Of the simulation that was asked for."""
        return next(iter(self.runs))


@dataclass(frozen=True)
class Coupled:
    """What holds for all actuators of a hybrid simulation, and the name of its case."""

    delay_map: DelayMap
    case: str


@dataclass(frozen=True)
class Tracked:
    """A run that was followed, of this actuator."""

    track: Track
    actuator: Actuator


@dataclass(frozen=True)
class Charted:
    """Values of a quantity in the order of production, a label each, and the limits of the product."""

    chart: ControlChart
    quantity: str
    unit: str
    where: str
    labels: Sequence[str]
    limits: tuple[float | None, float | None]


@dataclass(frozen=True)
class OverCondition:
    """A parameter over a condition, a label a set, and the limits of the product."""

    dependence: Dependence
    quantity: str
    unit: str
    where: str
    labels: Sequence[str]
    limits: tuple[float | None, float | None]
