"""Sets of the reference as the library reads them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import pytest

from ident.bench.model import Model
from ident.bench.records import BenchSet, bench_set
from ident.bench.speed_table import FRACTIONS, SpeedTable
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.synthesis import bench_matrix
from tests.reference import kononykhin_reference as reference


def as_matrix(truth: reference.Truth, records: Sequence[reference.Record]) -> Matrix:
    """SI, currents in rated currents."""
    actuator = Actuator("REFERENCE", supply_pressure=1e6 * truth.Ps, stroke=1e-3 * reference.STROKE)
    return Matrix(actuator, tuple(as_run(record) for record in records), data_hash="0" * 64)


def as_run(record: reference.Record) -> Run:
    """One record."""
    channels = {
        "current": record.current / 100,
        "displacement": record.position / 1e3,
        "pressure_a": 1e6 * record.pressure_a,
        "pressure_b": 1e6 * record.pressure_b,
    }
    low, high = record.position_range
    return Run(
        record.id,
        "",
        reference.RATE,
        channels,
        units={"current": "1", "displacement": "m"},
        kind=record.kind,
        frequency=record.frequency or None,
        rated_current=1.0,
        position_range=(1e-3 * low, 1e-3 * high) if record.kind == "static" else None,
    )


def as_set(truth: reference.Truth, records: Sequence[reference.Record]) -> BenchSet:
    """What the procedures take."""
    return bench_set(as_matrix(truth, records))


def true_model(truth: reference.Truth) -> Model:
    """The library's model with the reference's values."""
    u = 100 * np.array(FRACTIONS)
    table = SpeedTable(tuple(1e-3 * truth.speed(u)), tuple(1e-3 * truth.speed(-u)))
    return Model(truth.T, truth.B / 100, truth.I0 / 100, 1e8 * truth.kp, 1e6 * truth.dPfr, table, 1e6 * truth.Ps)


@contextmanager
def simulated(full: bool) -> Iterator[None]:
    """Sets that the program simulates have, but in the full form, a third of the records.

    One static record, the sines that last less than ten seconds, those of speed. Without the slow sines the position
    error is 3.6 % on average of all, for the smallest moves by a step of the converter: the limit is 5 % there.
    """
    whole, long = bench_matrix.plans, re.compile(r"static-(20|80)|sine-.*-0_[25]")

    def some(gain: float) -> Iterator[bench_matrix.Plan]:
        return (plan for plan in whole(gain) if full or not long.fullmatch(plan.id))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench_matrix, "plans", some)
        if not full:
            patch.setitem(bench_matrix.LIMITS, "position_error", {"max": "5 %"})
        yield
