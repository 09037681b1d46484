"""When a share of the explainable power matters. Seeds stand in each test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.diagnosis.evidence.evidence import BlockMean
from ident.diagnosis.evidence.rule import matters
from tests.diagnosis.test_evidence import NOISE, WHITE, common, compared, slow, white

SEEDS, N = range(700, 730), 2000


@pytest.mark.parametrize(("taken", "least", "most"), [(0.3, 0.95, 1.0), (0.0, 0.0, 0.05)], ids=["acts", "acts nowhere"])
def test_an_effect_that_acts_in_one_run_of_two_matters_whatever_bursts_the_other_has(
    taken: float, least: float, most: float
) -> None:
    """Its share is another in each block, so the error of the share is large; that of the difference is not."""
    burst = np.repeat([1.0, 0.0, 0.0, 0.0] * 2, N // 8)
    found = []
    for seed in SEEDS:
        rng = np.random.default_rng(seed)
        acts, other = 3 * NOISE * slow(rng, N), 15 * NOISE * slow(rng, N) * burst
        (first, second), drawn = (white(rng, N) for _ in range(2)), 0.3 * NOISE * slow(rng, N)
        after = [first + (1 - taken) * acts, second + other + drawn]
        found.append(compared([first + acts, second + other], after, [WHITE] * 2))
    assert least <= np.mean([matters(one) for one in found]) <= most
    by_share = np.mean([one.share.above(EVIDENCE_CRITERIA.share, EVIDENCE_CRITERIA) for one in found])
    assert by_share < 0.9


@pytest.mark.parametrize("period", [200, 400])
def test_an_effect_matters_below_a_drift_that_scatters_the_difference_of_the_powers(period: int) -> None:
    """A narrow band of 8 % of the output and a random walk of 30 %: by the difference fewer than half are seen."""
    seen = {"by the power": 0, "by the loss": 0}
    for seed in range(12):
        rng = np.random.default_rng(seed)
        walk = np.cumsum(rng.standard_normal(8000))
        drift = 0.3 * (walk - walk.mean()) / walk.std() + white(rng, 8000)
        narrow = lfilter([1.0], [1.0, -1.98 * np.cos(2 * np.pi / period), 0.9801], rng.standard_normal(8000))
        found = compared([drift + 0.08 * narrow / narrow.std()], [drift], [Record(1.0)])
        unweighted = replace(found, weighted_share=BlockMean(0.0, 0.0, 12))
        seen["by the power"] += matters(unweighted)
        seen["by the loss"] += matters(found)
    assert seen["by the power"] < 7
    assert seen["by the loss"] > 9


def test_a_weight_of_one_changes_no_residual_and_the_weighted_floor_is_that_of_noise() -> None:
    """In bands of an octave and in harmonics; the second model leaves the noise alone."""
    rng = np.random.default_rng(5)
    for record in (Record(1.0, floor=1e-4), Record(1.0, period=40.0, floor=1e-4)):
        noise, more = 0.01 * rng.standard_normal(4000), 0.1 * np.sin(2 * np.pi * np.arange(4000) / 40.0)
        bands = EnergyBands((record,), (4000,))
        (run,) = bands.runs
        assert run.weighted(more + noise, np.ones(bands.size)) == pytest.approx(more + noise, abs=1e-12)
        found = common(bands, [[more + noise], [noise]])
        (weighted,) = found.weighted([noise])
        assert np.mean(weighted**2) == pytest.approx(found.weighted_floors[0], rel=0.2)
