"""Standard errors of the bench are as large as what is wrong: pass and fail at two standard errors rest on them.

Actuators and records are the independent reference's: 100 actuators from 800 on, on full sets, each with one of the
eight instruments in turn: an RMS of z over 100 sets is known to 7 %.
"""

from __future__ import annotations

import numpy as np
import pytest

from ident.bench.acceptance import QUANTITIES
from tests.bench.calibration import instruments_of, wrong

pytestmark = pytest.mark.full
FIRST = 800
HONEST, UNBIASED = (0.8, 1.25), 0.5  # RMS of z over many sets; its mean


@pytest.fixture(scope="module")
def found() -> list[dict[str, float]]:
    return [wrong(seed, instruments_of(seed)) for seed in range(FIRST, FIRST + 100)]


def test_every_quantity_of_the_sheet_is_judged(found: list[dict[str, float]]) -> None:
    of_regulator = {"gain_margin", "phase_margin"}  # no regulator is stated here
    assert set(QUANTITIES) - of_regulator <= set(found[0])
    assert np.isfinite([list(one.values()) for one in found]).all()


def test_standard_errors_are_honest_and_nothing_is_biased(found: list[dict[str, float]]) -> None:
    """Of every quantity over 100 sets."""
    by_name = {name: np.array([one[name] for one in found]) for name in found[0]}
    rms = {name: float(np.sqrt(np.mean(z**2))) for name, z in by_name.items()}
    assert not {name: value for name, value in rms.items() if not HONEST[0] <= value <= HONEST[1]}
    assert not {name: z.mean() for name, z in by_name.items() if abs(z.mean()) > UNBIASED}
