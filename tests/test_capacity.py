"""The page on capacity follows from what was measured, and from nothing else."""

from __future__ import annotations

import pytest

from benchmarks import capacity, figures


def test_the_page_is_what_the_figures_say():
    """It is written again by `python -m benchmarks.capacity` after a measurement."""
    assert capacity.PAGE.read_text(encoding="utf-8") == capacity.page(figures.known())


def test_the_largest_day_is_twelve_terabytes():
    one = capacity.need(100_000, 30, figures.known())
    assert one.raw == pytest.approx(12.4e12, rel=0.01)
    assert one.traffic == pytest.approx(3 * 12.4e12 / 86_400, rel=0.01)


def test_what_costs_twice_takes_twice_as_much_and_may_become_the_bottleneck():
    known = figures.known()
    before = capacity.need(1_000, 30, known)
    slow = {**known, "fit_of_63_runs_of_30_s": 100 * known["fit_of_63_runs_of_30_s"]}
    after = capacity.need(1_000, 30, slow)
    assert after.workers == pytest.approx(100 * before.workers)
    assert after.bottleneck == "worker"
    assert capacity.page(slow) != capacity.page(known)
