"""The simulation of whole records: as exact as the readings of thousands of steps tell, with its derivatives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.bench.exact_response import delayed, respond_exact
from ident.bench.model import CONSTANTS as NAMES
from ident.bench.model import DELAY, Model
from ident.bench.reduced_record import Observed
from ident.bench.residual import Residual
from ident.bench.response import respond
from ident.bench.speed_table import SPLINE
from tests.bench.sets import as_set, true_model
from tests.reference import kononykhin_reference as reference

SEED = 811
TRUTH = reference.scattered(SEED)
PLANS = {  # kind, law, settings, seconds of a record, and how far off it may be, nm
    "static": ("static", 0, [TRUTH.I0, 1.0, 0.25, 1.5], 12.0, 0.5),
    "sine": ("frequency", 1, [TRUTH.I0, 10.0, 1.0, 0.3], 2.0, 3.0),
    "fast": ("frequency", 1, [TRUTH.I0, 50.0, 5.0, 1.5], 1.0, 15.0),
    "levels": ("speed-levels", 2, [TRUTH.I0, 25.0, 1.0, 0.3, 2000.0], 2.6, 6.0),
}


def model() -> Model:
    """The truth, its table a spline."""
    found = true_model(TRUTH)
    return replace(found, table=replace(found.table, kind=SPLINE))


def recorded(name: str) -> reference.Record:
    kind, law, settings, seconds, _ = PLANS[name]
    rng = np.random.default_rng([SEED, 3])
    labels = {"frequency": settings[2], "amplitude": settings[1]} if kind == "frequency" else {}
    return reference.record(TRUTH, name, kind, law, settings, seconds, 50.0, rng, **labels)


def answer(of: Model, current: np.ndarray, start: float, held: bool = False) -> tuple[np.ndarray, np.ndarray]:
    position, pressure = np.empty((1, len(current))), np.empty((1, len(current)))
    respond_exact(
        current,
        of.delay * reference.RATE,
        1 / reference.RATE,
        held,
        of.constants,
        of.table.nodes,
        of.table.pieces,
        np.zeros((0, 2, 1, 4)),
        start,
        np.arange(len(current)),
        0.0,
        position,
        pressure,
    )
    return position[0], pressure[0]


@pytest.mark.parametrize("name", PLANS)
def test_the_way_is_that_of_the_reference_to_nanometres(name):
    """Under a regulator, too, whose current jumps at each reading: the play keeps the peaks between two samples."""
    record = recorded(name)
    found, _ = answer(model(), record.current / 100, 1e-3 * record.true_position[0])
    off = (1e9 * found - 1e6 * record.true_position)[250:]  # the reference's past, before its first sample, is unknown
    assert np.std(record.true_position) > 1e-2
    assert np.std(off) < PLANS[name][-1]


@pytest.mark.parametrize("held", [False, True])
def test_position_and_pressure_are_those_of_many_parts_of_a_sample(held):
    """The simulation that knows effects, with all of them off and in 256 parts; in nm, and pressure to rounding."""
    record, of = recorded("sine"), model()
    current = np.ascontiguousarray(record.current / 100)
    out = np.empty((3, len(current)))
    play = min(max(of.I0, current[0] - of.B), current[0] + of.B)
    begin = np.array([0.05, current[0], current[0], play])
    respond(current, 1 / reference.RATE, 256, held, of.constants, of.table.nodes, of.table.pieces, begin, out)
    position, pressure = answer(of, current, 0.05, held)
    assert 1e9 * np.abs(position - out[0]).max() < 5.0
    assert np.abs(pressure - out[1])[1:].max() < 1e-6 * of.dPfr


def test_a_delayed_current_is_late_and_tells_its_slope():
    current = np.cumsum(np.random.default_rng(5).standard_normal(50))
    for late in (0.0, 0.3, 2.0, 2.7):
        found, slope = delayed(current, late)
        assert found == pytest.approx(np.interp(np.arange(50) - late, np.arange(50), current))
        assert slope == pytest.approx((delayed(current, late + 1e-6)[0] - found) / 1e-6, abs=1e-6)


@pytest.mark.parametrize("name", ["static", "levels"])
def test_derivatives_are_those_of_differences(name):
    """Of every value and of a delay, at readings and pressures: within 1 % of the largest."""
    record, of = recorded(name), model()
    run = as_set(TRUTH, [record]).records[0]
    observed = Observed.of(run).exact(run, of, 1e-3 * reference.STROKE / 2**reference.BITS)
    names = (*NAMES, *of.table.names, DELAY)
    residual = Residual(of, (observed,), names, frozenset({DELAY}))
    found, base = residual.slopes(residual.origin, observed)
    assert base == pytest.approx(observed.residual(of))
    moved = 0
    for axis, own in zip(np.eye(len(names)), names, strict=True):
        step = 1e-5
        differences = residual.at(residual.origin + step * axis), residual.at(residual.origin - step * axis)
        ahead, behind = (observed.residual(at) for at in differences)
        expected = (ahead - behind) / (2 * step) if own != DELAY else (ahead - base) / step
        row = found[names.index(own)]
        if np.any(row):  # a table's value far beyond the currents of a record is taken as unseen
            assert np.std(row - expected) < 0.01 * np.std(expected), own
            moved += 1
    assert moved > len(NAMES) + 2
