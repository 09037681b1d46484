"""The error of the mean of a correlated series. Seeds stand in each test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.diagnosis.evidence.blocks import block_mean, correlation_time
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from tests.diagnosis.test_evidence import slow, white


def test_the_error_of_a_difference_holds_for_correlated_residuals(full: bool) -> None:
    """Chance carries a mean of AR(0.95) beyond its error about once in twenty to each side; seeds 800 and up."""
    count = 1000 if full else 60
    held = 0
    for seed in range(800, 800 + count):
        found = block_mean([slow(np.random.default_rng(seed), 1500, 0.95)], EVIDENCE_CRITERIA)
        held += not (found.above(0.0, EVIDENCE_CRITERIA) or found.below(0.0, EVIDENCE_CRITERIA))
    assert held >= 0.84 * count
    assert block_mean([white(np.random.default_rng(8), 20_000)], EVIDENCE_CRITERIA).blocks > 50


def test_the_error_of_a_difference_holds_for_a_record_of_twenty_correlation_times(full: bool) -> None:
    """Blocks of four correlation times hold zero as often as two of ten do, and can be passed; seeds 900 up."""
    count, held, two, bounds = (1000 if full else 60), 0, 0, []
    few = replace(EVIDENCE_CRITERIA, enough_blocks=1, least_blocks=2)
    for seed in range(900, 900 + count):
        series = slow(np.random.default_rng(seed), 800, 0.95)
        found, of_few = block_mean([series], EVIDENCE_CRITERIA), block_mean([series], few)
        assert found.blocks >= 4
        held += abs(found.mean) <= found.bound(EVIDENCE_CRITERIA)
        two += abs(of_few.mean) <= of_few.bound(few)
        bounds.append(found.bound(EVIDENCE_CRITERIA) / of_few.bound(few))
    assert held >= 0.8 * count  # both sides: 10 % are chance
    assert held >= two - 0.06 * count
    assert np.median(bounds) < 0.8


def test_a_record_of_forty_correlation_times_has_more_blocks_than_ten_of_them_would_give() -> None:
    """Ten of four correlation times and more, where blocks of ten would be four; seeds 700 to 719."""
    found, long = [], replace(EVIDENCE_CRITERIA, enough_blocks=1)
    for seed in range(700, 720):
        series = slow(np.random.default_rng(seed), 1600, 0.95)
        found.append((block_mean([series], EVIDENCE_CRITERIA).blocks, block_mean([series], long).blocks))
    short, of_ten = np.median(found, axis=0)
    assert short >= 8
    assert of_ten <= 5


def test_the_series_of_a_run_that_nearly_left_all_numbers_has_the_blocks_of_any_other() -> None:
    """Its squares are no numbers, and a diagnosis ended there: cannot convert float NaN to integer. Seed 7."""
    series = slow(np.random.default_rng(7), 500, 0.8)
    for scale in (2.0**-500, 2.0**500, 2.0**1000):
        assert correlation_time(scale * series) == correlation_time(series)
    assert block_mean([2.0**500 * series], EVIDENCE_CRITERIA).blocks == block_mean([series], EVIDENCE_CRITERIA).blocks
    assert correlation_time(np.zeros(10)) == 1.0
