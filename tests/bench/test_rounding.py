"""Readings and currents that lie on a limit, as round numbers do, are taken the same way however they are rounded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.bench.motion import groups
from ident.bench.records import Record, bench_set
from ident.bench.reduced_record import Observed
from ident.bench.speed import _constant
from ident.resolution import resolution
from tests.bench.sets import as_matrix
from tests.reference import kononykhin_reference as reference
from tests.rounding import moved, perturbed
from tests.short_form import short_form

RATE = 1000.0
STEP = 0.1 / 4096  # m, of a converter of 12 bits
SEEDS = range(4)


def record(current: np.ndarray, position: np.ndarray) -> Record:
    return Record("r", "speed-levels", RATE, "linear", current, position, None, resolution(position))


def swing(steps: int, at: float = 0.05, every: int = 20) -> np.ndarray:
    """Two strokes up and down by so many steps of the converter, a step every so many samples."""
    up = np.repeat(np.arange(steps + 1), every)
    return at + STEP * np.concatenate([up, up[::-1]] * 2)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_small_stroke_far_from_zero_is_read_in_the_steps_of_its_converter(seed):
    """1e-12 of a position of half a metre is a billionth of a stroke of two steps."""
    assert resolution(moved(swing(2, at=0.5), seed)) == pytest.approx(STEP, rel=1e-4)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_link_at_rest_does_not_move_by_rounding(seed):
    """The groups of rest and motion are those of the readings themselves, which repeat to the last bit."""
    position = swing(40)
    position = np.concatenate([position, np.full(3000, position[-1]), position])
    still = np.zeros(len(position))
    assert np.any(groups(record(still, position)) == 0)
    assert np.all(groups(record(still, position)) == groups(record(still, moved(position, seed))))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_record_is_compared_from_the_same_sample_on(seed):
    """Three steps of the converter are no accident, or are: not by chance."""
    position = swing(4, at=0.05 + 1e-3 * seed, every=200)
    one, other = (Observed.of(record(np.zeros(len(position)), x), rate=RATE) for x in (position, moved(position, seed)))
    assert one.parts == other.parts


def test_a_sample_rate_told_by_a_clock_is_divided_as_the_round_one():
    """A time column makes 999.9999999999 Hz of 1 kHz: four samples still make one at 250 Hz."""
    position = swing(40)
    exact = record(np.zeros(len(position)), position)
    assert replace(exact, rate=RATE * (1 - 1e-13)).reduced(250.0).length == exact.reduced(250.0).length


@pytest.mark.parametrize("seed", SEEDS)
def test_a_current_on_a_limit_is_on_the_same_side_of_it(seed):
    """At 2 % from its middle for as long as an end takes to show, and in levels 0.2 % apart."""
    position = np.concatenate([swing(40), np.full(400, 0.05)])
    current = np.full(len(position), 0.02)
    current[: len(current) // 2] = -0.02
    parts = [record(moved(current, s), position).parts for s in (seed, seed + 10)]
    assert parts[0] == parts[1]
    stairs = np.repeat(0.002 * np.arange(1, 6), 200)
    levels = [_constant(record(moved(stairs, s), np.arange(1000.0))) for s in (seed, seed + 10)]
    assert levels[0] == levels[1]


@pytest.mark.parametrize("number", short_form([1, 9, 66], 9))
def test_a_whole_set_is_seen_the_same(number):
    """Ranges in which the link is free, at rest, or compared; levels of the current: of every record."""
    truth = reference.scattered(number)
    matrix = as_matrix(truth, reference.full_set(truth, number))
    for one, other in zip(bench_set(matrix).records, bench_set(perturbed(matrix, 3)).records, strict=True):
        assert one.parts == other.parts, one.id
        assert one.jumps == other.jumps, one.id
        assert np.all(groups(one) == groups(other)), one.id
        assert Observed.of(one).parts == Observed.of(other).parts, one.id
        assert _constant(one) == _constant(other), one.id
