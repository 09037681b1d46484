"""When a share of the explainable power matters. Seeds stand in each test."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.rule import matters
from tests.diagnosis.test_evidence import NOISE, WHITE, compared, slow, white

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
