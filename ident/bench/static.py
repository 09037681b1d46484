"""The static procedure (Kononykhin, section 5.1): zero shift, dead space, slope of the pressure, friction, hysteresis.

Under a saw-tooth of the set position the link rests, moves, rests and moves back. At rest the pressure difference
follows the current behind the play, kp (I_BL − I0); in motion it is ±ΔPfr. So ΔP against the current is a loop whose
width at zero is twice the hysteresis B, whose corners are the dead space, B + ΔPfr/kp. Medians over the three groups
of samples give first values; the loop itself is then fitted to every sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.estimate import BenchEstimate
from ident.bench.least_squares import Solution, solve
from ident.bench.model import Model, dead_space
from ident.bench.motion import groups, onsets
from ident.bench.records import Record
from ident.bench.reduced_record import Observed, observe
from ident.bench.residual import Residual
from ident.bench.scatter import scatter
from ident.bench.speed_table import SpeedTable
from ident.errors import Unusable
from ident.words.run_name import run_name

Array = NDArray[np.float64]
NAMES = ("B", "I0", "kp", "dPfr")
_OF = BENCH_CRITERIA.static


@dataclass(frozen=True)
class Static:
    """What a static record, or several, say. Currents in rated currents, pressures in Pa; half-widths."""

    zero_shift: BenchEstimate
    dead_space: BenchEstimate
    slope: BenchEstimate
    friction: BenchEstimate
    hysteresis: BenchEstimate
    position_range: tuple[float, float] | None
    records: tuple[str, ...]
    model: Model


def static(records: Sequence[Record], start: Model, observed: Sequence[Observed]) -> Static:
    """The quantities from these records together; `start` gives T and the speeds, with which positions tell too."""
    return _result(records, solve(Residual(start, tuple(observed), NAMES), steps=_OF.steps))


def refined_static(records: Sequence[Record], whole: Solution) -> Static:
    """The quantities from these records alone, sample by sample, with T and weights of the fit of all records.

    The speeds that the records see are found with them: held, they would hand their errors on without a word.
    """
    wanted = {record.id for record in records}
    observed = tuple(one for one in whole.residual.observed if one.record.id in wanted)
    seen = max(one.reach for one in observed) + abs(whole.model.I0) if any(one.positions for one in observed) else 0.0
    table = whole.model.table
    sides = [
        names[: _speeds_seen(table, seen)]
        for names in (table.names[: len(table.fractions)], table.names[len(table.fractions) :])
    ]
    solution = solve(Residual(whole.model, observed, (*NAMES, *sides[0], *sides[1])), way=BENCH_CRITERIA.fits.last)
    return _result(records, replace(solution, scatter=scatter(solution)))


def _speeds_seen(table: SpeedTable, reach: float) -> int:
    """How many speeds of a side currents up to `reach` tell: those of the nodes below, and the one above."""
    return int(np.searchsorted(table.nodes[1:], reach)) + 1 if reach > 0 else 0


def ranges(records: Sequence[Record], whole: Solution) -> tuple[Static, ...]:
    """The same for each range of positions, where there are several."""
    by_range: dict[tuple[float, float] | str, list[Record]] = {}
    for record in records:
        by_range.setdefault(record.position_range or record.id, []).append(record)
    return tuple(refined_static(part, whole) for part in by_range.values()) if len(by_range) > 1 else ()


def _result(records: Sequence[Record], solution: Solution) -> Static:
    model, v = solution.model, solution.values
    deviations = solution.deviations
    bounds = {record.position_range for record in records}
    return Static(
        BenchEstimate(v["I0"], deviations["I0"], "1"),
        BenchEstimate(model.dead_space, solution.deviation(dead_space), "1"),
        BenchEstimate(v["kp"], deviations["kp"], "Pa"),
        BenchEstimate(v["dPfr"], deviations["dPfr"], "Pa"),
        BenchEstimate(v["B"], deviations["B"], "1"),
        bounds.pop() if len(bounds) == 1 else None,
        tuple(record.id for record in records),
        model,
    )


def first_values(records: Sequence[Record], T: float, supply: float) -> Model:
    """A model with static values from the three groups of samples; of several starts the one that fits best.

    Raises Unusable where the cavities were not measured, or the link did not move both ways.
    """
    zero, width, friction = by_groups(records)
    rough = any(record.jumps for record in records)
    slow = observe(records, position=False, rate=_OF.rough_rate if rough else _OF.rate)
    tried = []
    for narrower in _OF.narrower if rough else (1.0,):
        for share in _OF.shares:
            dead_space = narrower * width
            kp = friction / ((1.0 - share) * dead_space)
            model = Model(T, share * dead_space, zero, kp, friction, SpeedTable.straight(1.0), supply)
            tried.append(solve(Residual(model, slow, NAMES), steps=_OF.steps))
    return min(tried, key=lambda solution: solution.cost).model


def by_groups(records: Sequence[Record]) -> tuple[float, float, float]:
    """Zero shift and dead space from the currents at which movements began, ΔPfr from the pressures in motion."""
    starts: dict[int, list[Array]] = {1: [], -1: []}
    moving: dict[int, list[Array]] = {1: [], -1: []}
    for record in records:
        state = groups(record)
        for sign in (1, -1):
            starts[sign].append(onsets(state, record.current, sign))
            moving[sign].append(_pressure(record)[state == sign])
    up, down = (np.concatenate(starts[sign]) for sign in (1, -1))
    if not len(up) or not len(down):
        raise Unusable(
            "no-movement",
            "dead space and zero shift cannot be found: the link did not start both ways",
            run_name(records[0].id),
            "let the set position go further than the dead space",
        )
    high, low = (float(np.median(np.concatenate(moving[sign]))) for sign in (1, -1))
    zero, width = 0.5 * float(np.median(up) + np.median(down)), 0.5 * float(np.median(up) - np.median(down))
    return zero, max(width, _OF.least_width), max(0.5 * (high - low), 1.0)


def _pressure(record: Record) -> Array:
    if record.pressure is None:
        raise Unusable(
            "missing-channel",
            "kp, friction and hysteresis cannot be found without pressure_a, pressure_b",
            run_name(record.id),
            "record both cavity pressures at the static test",
        )
    return record.pressure
