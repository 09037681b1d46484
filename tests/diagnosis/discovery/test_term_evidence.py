"""Whether the runs that confirm a term agree."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.discovery.term_evidence import TermEvidence

BAR = 14.0


@pytest.mark.parametrize(
    ("gains", "steady", "beyond"),
    [
        ([30.0, 28.0, 33.0, 31.0, 29.0, 30.0], True, True),
        ([0.1, -0.2, 0.0, 900.0, 700.0, 0.3], False, True),  # a stop that two of six runs reach
        ([0.1, -0.2, 0.0, 900.0, 0.2, 0.3], False, False),  # one run alone
        ([40.0, -35.0, 50.0, -20.0, 45.0, -30.0], False, False),  # as many lose
        ([400.0, -35.0, 500.0, -20.0, 0.1, -30.0], False, False),  # two gain much, the others lose
        ([4.0, 3.0, 2.0, 3.0, 2.0, 3.0], True, False),
    ],
)
def test_all_runs_gain_or_some_gain_much_and_none_loses(gains, steady, beyond):
    found = TermEvidence(np.array(gains), 0.1)
    assert found.consistent is steady
    assert found.beyond(BAR) is beyond
