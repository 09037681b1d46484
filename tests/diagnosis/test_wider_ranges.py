"""A diagnosis begins where the fit ended, also where it ended beyond the range of its search."""

from __future__ import annotations

import numpy as np
import pytest

from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only
from tests.short_form import short_form

STEP, COUNT, NOISE = 0.5, 2000, 0.01


def kettle(tau: float, seed: int = 3) -> Matrix:
    """A body with a lag far longer than the record, heated now and then: it all but integrates what it is given."""
    rng = np.random.default_rng(seed)
    heated = np.repeat(rng.random(COUNT // 40) < 0.25, 40).astype(float)
    heated[:40] = 0.0
    keep, answer = np.exp(-STEP / tau), np.zeros(COUNT)
    for at in range(1, COUNT):
        answer[at] = keep * answer[at - 1] + (1.0 - keep) * heated[at - 1]
    noisy = answer + NOISE * np.std(answer) * rng.standard_normal(COUNT)
    channels = {"command": heated, "displacement": noisy}
    return Matrix(Actuator("KETTLE"), (Run("a", "", 1.0 / STEP, channels, {"displacement": "1"}, hold="zoh"),))


@pytest.mark.parametrize("tau", short_form([1500.0, 3000.0], 3000.0))
def test_a_lag_that_the_fit_found_beyond_its_range_is_that_of_the_diagnosis(monkeypatch, tau):
    rank_only(monkeypatch, ("speed_asymmetry", "command_delay", "dead_zone"))
    records = kettle(tau)
    fit = identify(records, model="first_order")
    found = diagnose(records, fit, propose=False)
    assert fit.error["fit"] < 1.2 * NOISE
    assert found.ladder[0].error["fit"] == pytest.approx(fit.error["fit"], rel=0.05)
    assert found.verdict.effects == ()
