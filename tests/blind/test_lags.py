"""What follows like a lag: the reference is one, and what is hidden in it shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from tests.blind.lags import Lag
from tests.blind.lags_table import HIDDEN


def test_with_nothing_hidden_it_answers_as_scipy_s_own_simulation_does():
    of = replace(Lag.drawn(169804), held=False)
    u = of.command(0)
    _, wanted, _ = lsim(([of.gain], [of.tau, 1.0]), u, np.arange(of.count))
    np.testing.assert_allclose(of.answer(u), wanted, atol=1e-4 * wanted.std())


@pytest.mark.parametrize("number", range(4))
def test_what_is_hidden_shows(number):
    of = next(lag for seed in range(20) if (lag := Lag.drawn(seed)).hidden == HIDDEN[number])
    u = of.command(0)
    assert np.std(of.answer(u) - of.answer(u, hidden=False)) > 0.02 * of.gain * np.std(u)
