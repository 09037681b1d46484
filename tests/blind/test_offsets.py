"""Machines whose transducer is off: no headline hides it; `python -m tests.blind.offsets 171001 171200` counts many."""

from __future__ import annotations

import numpy as np
import pytest

from ident.workflows import compare
from tests.blind.offsets import Off, scores, trial
from tests.short_form import short_form

SPRINGLESS = (171019, 171084, 171090)  # an inertia that is turned: a torque that lasts would turn it as an offset reads
OTHERS = (171004, 171009, 171031, 171174)


@pytest.mark.parametrize("seed", short_form([*SPRINGLESS, *OTHERS], 171084, 171009, 171174))
def test_no_headline_hides_an_offset(seed):
    row = trial(seed)
    assert row["large"]
    assert row["said"]
    assert row["rmse"][0] < 1.3 * row["rmse"][1]
    assert max(abs(z) for z in row["z"].values()) < 4.0
    assert np.isfinite(list(row["z"].values())).all()


def test_a_comparison_tells_the_offset_that_the_fit_told():
    """Its first state is that of the fit, whatever else would do the same."""
    matrix, found = Off.drawn(SPRINGLESS[0]).fitted()
    compared = compare(matrix, found)
    assert compared.rmse["verify"] == pytest.approx(found.rmse["verify"], rel=1e-6)
    assert compared.offset["verify"] == pytest.approx(found.offset["verify"], rel=1e-6)


def test_parameters_lie_within_their_standard_errors_and_no_headline_hides_an_offset(full):
    """Of 200 fresh machines, as docs/accuracy.md has it: a minute of the processor."""
    if not full:
        pytest.skip("a minute: --full")
    found = [trial(seed) for seed in range(171201, 171401)]
    z = scores(found, offsets=False)
    assert all(row["said"] for row in found if row["large"])
    assert np.mean(np.abs(z) < 3.0) >= 0.98
    assert 0.8 < np.sqrt(np.mean(z**2)) < 1.25
