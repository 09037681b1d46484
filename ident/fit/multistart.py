"""From the best members of a search to the optimum on every sample, and where else the polish ends."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.fitness import Fitness, Local
from ident.fit.levenberg_marquardt import STEPS
from ident.fit.local_optima import LocalOptimum, agreeing, at_bound, competing_optima, equivalent_points
from ident.fit.result import Starts
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import Space
from ident.progress import Progress, Report
from ident.run import Run
from ident.statistics.robust import robust_deviation

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.optima


@dataclass(frozen=True)
class Beyond:
    """A parameter that was searched on beyond its `bound`, SI, at which the fit left `error`."""

    name: str
    bound: float
    error: float


@dataclass(frozen=True)
class Optimum:
    """The optimum of a fitness, and the fitness there; points that are as good, (k, p); where starts ended.

    The optimum is the first of the ends. `left_out` has the ids of runs that one model cannot explain beside the
    others: `fitness` is that of the runs without them. Where bounds were left `beyond` has them, and `searched` is the
    space of the search.
    """

    fitness: Fitness
    point: Array
    here: Local
    as_good: Array
    ends: tuple[LocalOptimum, ...] = ()
    starts: Starts | None = None
    left_out: tuple[str, ...] = ()
    beyond: tuple[Beyond, ...] = ()
    searched: Space | None = None


def multistart(
    searched: Fitness,
    objective: Fitness,
    starts: Sequence[Array],
    report: Report,
    further: Iterable[Array] = (),
    count: int = 0,
) -> Optimum:
    """The optimum of `objective` near starts that the fitness `searched` chose.

    Where those do not end together, or end at a bound, `further` starts are tried until three of them agree with the
    best: a search that narrowed has seen one basin, and the ones beside it lie where it did not look. With a `count`
    so many are tried, whether they agree or not.
    """
    ends = sorted(_all_ends(searched, starts, further, report, count), key=_error)
    first, here = _end(objective, ends[0].point, report)
    others = [_elsewhere(objective, end, report) for end in competing_optima(ends)[: _OF.competing]]
    least = min([first, *others], key=_error)
    if least is not first:
        others = [first, *(end for end in others if end is not least)]
        first, here = _end(objective, least.point, report)
    point, left_out = first.point, tuple[str, ...]()
    if isinstance(objective, SimulatedFitness) and (left_out := bad_runs(objective.runs, here)):
        objective = replace(objective, runs=tuple(run for run in objective.runs if run.id not in left_out))
        again, here = _end(objective, point, report)
        point = again.point
    somewhere = [end for end in ends if np.isfinite(end.error)]
    values = {name: tuple(end.values[name] for end in somewhere) for name in objective.space.names}
    starts_of = Starts(len(ends), agreeing(ends, ends[0]), tuple(end.error for end in somewhere), values)
    return Optimum(objective, point, here, np.array(equivalent_points(ends)), (first, *others), starts_of, left_out)


def _all_ends(
    searched: Fitness, starts: Sequence[Array], further: Iterable[Array], report: Report, count: int
) -> Iterator[LocalOptimum]:
    """Where every start ends that is worth a try, or so many, where a count is asked for."""
    ends = [_end(searched, start, report, roughly=True)[0] for start in starts]
    yield from ends
    best = min(ends, key=_error)
    if not count and agreeing(ends, best) == len(ends) and not at_bound(best):
        return
    later: list[LocalOptimum] = []
    for start in further:
        later.append(_end(searched, start, report, roughly=True)[0])
        yield later[-1]
        enough = len(ends) + len(later) >= count
        if enough and (count or agreeing(later, min([best, *later], key=_error)) >= _OF.settled):
            return


def _end(of: Fitness, start: Array, report: Report, roughly: bool = False) -> tuple[LocalOptimum, Local]:
    """Where the polish of a start ends, and the objective there."""

    def progress(count: int, error: float) -> None:
        report(Progress("polish", count, STEPS, error))

    point, here = of.optimum(start, report=progress, roughly=roughly)
    values = {name: float(value[0]) for name, value in of.space.values(point[None]).items()}
    return LocalOptimum(here.error, values, point), here


def _elsewhere(objective: Fitness, rival: LocalOptimum, report: Report) -> LocalOptimum:
    """Where a rival ends on every sample, with first states of its own."""
    fresh = objective.fresh(objective.runs)
    end, _ = _end(fresh, rival.point, report)
    objective.evaluations += fresh.evaluations
    return end


def _error(end: LocalOptimum) -> float:
    return end.error


def bad_runs(runs: Sequence[Run], here: Local) -> tuple[str, ...]:
    """The ids of runs that one model cannot explain beside the others: a wrong label, a spoilt record.

    Their error is more than three times the median, and beyond 5 deviations of the errors' logarithms; at most one
    run in twenty is taken for bad, and none of fewer than five.
    """
    if len(runs) < _OF.fewest_runs:
        return ()
    errors = np.log([run.error for run in here.runs])
    spread = robust_deviation(errors - np.median(errors))
    far = (errors - np.median(errors) > np.maximum(_OF.outlier * spread, np.log(_OF.times))).nonzero()[0]
    return tuple(runs[i].id for i in far) if len(far) <= max(1, int(_OF.most_bad * len(runs))) else ()
