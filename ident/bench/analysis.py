"""The whole of a bench's analysis in the order of the paper: static, frequency, speed, and the model put together.

Each procedure needs something of the next: the loop of the static test is widened by the lag T, T is found with the
speed characteristic, and that with friction and hysteresis known. So static values come first without T, then speeds,
then T, then static values and speeds again; at last every value is moved at once on all records.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial

import numpy as np

from ident.bench.criteria import BENCH_CRITERIA
from ident.bench.frequency import Response, frequency_response
from ident.bench.least_squares import Solution, solve
from ident.bench.model import CONSTANTS, Model
from ident.bench.motion import groups
from ident.bench.records import BenchSet, Record, step_of
from ident.bench.reduced_record import Observed, errors, observe
from ident.bench.residual import Residual
from ident.bench.scatter import scatter
from ident.bench.speed import Speed, speed
from ident.bench.speed_table import SPLINE, SpeedTable
from ident.bench.static import Static, first_values, ranges, refined_static, static
from ident.bench.time_constant import DelayCheck, Dynamics, delay_check, dynamics
from ident.errors import Unusable
from ident.fit.levenberg_marquardt import Way
from ident.parallel import each
from ident.rig.regulator import PositionControl
from ident.words.result_tables import TabularResult

FIRST_T = BENCH_CRITERIA.time_constants.first
"""s, where the search for T begins."""
_ROUNDS = 1  # of the refinement, behind each of which the records are weighed anew
SPEED = ("speed-levels", "speed-continuous")


@dataclass(frozen=True)
class Missing:
    """A quantity that cannot be found, and the kind of record that would tell it."""

    quantity: str
    kind: str

    @property
    def text(self) -> str:
        """In words."""
        return f"{self.quantity} cannot be found without a record of kind {self.kind}"


@dataclass(frozen=True)
class Analysis(TabularResult):
    """What the records say. `steps` is the model put together step by step, `model` the one moved on all records.

    A procedure whose records are missing is None, and so are the models then; `missing` says why.
    """

    static: Static | None = None
    by_range: tuple[Static, ...] = ()
    frequency: tuple[Response, ...] = ()
    dynamics: Dynamics | None = None
    delay: DelayCheck | None = None
    speed: Speed | None = None
    steps: Model | None = None
    whole: Solution | None = None
    errors: Mapping[str, float] = field(default_factory=dict)
    step_errors: Mapping[str, float] = field(default_factory=dict)
    missing: tuple[Missing, ...] = ()
    notes: tuple[str, ...] = ()
    seconds: float = 0.0
    regulator: PositionControl | None = None

    @property
    def model(self) -> Model | None:
        """The model of the whole fit."""
        return None if self.whole is None else self.whole.model

    def complete(self) -> Analysis:
        """Itself; raises Unusable where a quantity cannot be found, with the record that would tell it."""
        if self.missing:
            what = "; ".join(missing.text for missing in self.missing)
            kinds = ", ".join(dict.fromkeys(missing.kind for missing in self.missing))
            raise Unusable("missing-record", what, "runs", f"add a run with kind: {kinds}")
        return self


def analyse(bench: BenchSet) -> Analysis:
    """Every procedure for which there are records. Raises Unusable where a record is not usable for its procedure.

    `seconds` are those of the work; loading compiled code, once in a process, is not counted.
    """
    load_compiled()
    began = time.monotonic()
    found = _found(bench)
    doubts = (found.delay.doubt,) if found.delay is not None and found.delay.doubt else ()
    return replace(
        found,
        missing=tuple(_missing(bench)),
        notes=(*bench.notes, *doubts),
        seconds=time.monotonic() - began,
        regulator=bench.regulator,
    )


def _found(bench: BenchSet) -> Analysis:
    still, sines, moving = bench.of_kind("static"), bench.of_kind("frequency"), bench.of_kind(*SPEED)
    found = Analysis(frequency=frequency_response(sines))
    if not still:
        return found
    model = first_values(still, FIRST_T, bench.supply_pressure)
    if not moving:
        return replace(found, static=static(still, model, observe(still, position=False)))
    seen = {record.id: observed for record, observed in zip(bench.records, observe(bench.records), strict=True)}
    first = speed(model, moving, _of(seen, moving))
    model = replace(model, table=first.table)
    if not sines:
        return replace(found, static=static(still, model, _of(seen, still)), speed=first)
    return _whole(bench, model, seen, found)


def _whole(bench: BenchSet, model: Model, seen: dict[str, Observed], found: Analysis) -> Analysis:
    """T, then static values and speeds with it, then everything at once."""
    still, sines, moving = bench.of_kind("static"), bench.of_kind("frequency"), bench.of_kind(*SPEED)
    drifting = observe(sines, pressure=False, drifting=True)
    lag = dynamics(model, drifting)
    if any(record.jumps for record in still):
        # A loop crossed in milliseconds is as wide by T as by B: the sines tell the two apart.
        told = solve(
            Residual(replace(model, T=lag.T.value), drifting, ("T", "B")), steps=BENCH_CRITERIA.fits.whole
        ).model
        lag = dynamics(told, drifting)
        model = told
    at_rest = static(still, replace(model, T=lag.T.value), _of(seen, still))
    characteristic = speed(at_rest.model, moving, _of(seen, moving))
    steps, every = replace(at_rest.model, table=characteristic.table), list(seen.values())
    first = fit_whole(steps, every).model
    whole = refined(first, every, bench.records)
    with_delay, doubt = delay_check(whole, drifting)
    whole = replace(whole, scatter=scatter(whole) if doubt.doubt else with_delay[:-1, :-1])
    return replace(
        found,
        static=refined_static(still, whole),
        by_range=ranges(still, whole),
        dynamics=lag,
        speed=characteristic,
        delay=doubt,
        steps=steps,
        whole=whole,
        errors=errors(whole.model, every),
        step_errors=errors(steps, every),
    )


def fit_whole(
    start: Model,
    observed: Sequence[Observed],
    steps: int = BENCH_CRITERIA.fits.whole,
    way: Way = BENCH_CRITERIA.fits.rough,
) -> Solution:
    """Every value of the model at once on all records."""
    return solve(Residual(start, tuple(observed), (*CONSTANTS, *start.table.names)), steps=steps, way=way)


def refined(start: Model, observed: Sequence[Observed], records: Sequence[Record]) -> Solution:
    """Every value once more on the whole records, each weighed by its residual.

    Means over several ms cut the peaks of a regulator's current, which the play keeps: kp would come out 1 % too high.
    """
    step, start = step_of(records), replace(start, table=replace(start.table, kind=SPLINE))
    exact = each(lambda pair: pair[0].exact(pair[1], start, step), list(zip(observed, records, strict=True)))
    for _ in range(_ROUNDS):
        start = fit_whole(start, exact, way=BENCH_CRITERIA.fits.but_one).model
        exact = each(partial(Observed.reweighed, model=start), exact)
    return fit_whole(start, exact, way=BENCH_CRITERIA.fits.last)


def _of(seen: dict[str, Observed], records: Sequence[Record]) -> tuple[Observed, ...]:
    return tuple(seen[record.id] for record in records)


@lru_cache
def load_compiled() -> None:
    """Have the compiled functions at hand: their first call loads them from the disk, or compiles them.

    No answer depends on it, nor on the values with which they are called here.
    """
    ramp = np.linspace(0.0, 0.1, 16)
    record = Record("ramp", "static", 100.0, "linear", ramp, ramp, ramp, 1e-3)
    groups(record)
    model = Model(FIRST_T, 1e-3, 0.0, 1e8, 1e5, SpeedTable.straight(0.1))
    model.answer(ramp, 100.0)
    observed = Observed.of(record)
    Residual(model, (observed,), ("T",)).normal(np.zeros(1))
    stairs = replace(record, position=1e-2 * np.round(1e2 * ramp))
    exact = Residual(model, (observed.exact(stairs, model, 1e-2),), ("T",))
    scatter(Solution(exact, np.zeros(1), exact.normal(np.zeros(1)), 1))
    exact.cost(np.zeros(1))


def _missing(bench: BenchSet) -> list[Missing]:
    out = []
    if not bench.of_kind("static"):
        out.append(Missing("zero shift, dead space, kp, friction and hysteresis", "static"))
    if not bench.of_kind("frequency"):
        out.append(Missing("the time constant T", "frequency"))
    if not bench.of_kind(*SPEED):
        out.append(Missing("the speed characteristic", "speed-levels"))
    return out
