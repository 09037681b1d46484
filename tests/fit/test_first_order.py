"""A model that reads nothing of a run's conditions: the first-order lag, the same for every run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal

from ident.fit.identify import identify
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix, Run
from ident.parallel import cores

RATE, GAIN, LAG = 1000.0, 0.9, 5e-3


def test_more_runs_than_cores_are_fitted():
    """Gain and lag within 1 % of what made the records; each core reduces several runs at once."""
    command = np.random.default_rng(2).standard_normal(1024).cumsum()
    command -= command[0]
    phi = np.exp(-1 / (RATE * LAG))
    answer = scipy.signal.lfilter([0, GAIN * (1 - phi)], [1, -phi], command)  # the command is held
    run = Run("run", "", RATE, {"command": command, "displacement": answer}, hold="zoh")
    runs = tuple(replace(run, id=f"run-{i}") for i in range(2 * cores()))
    found = identify(Matrix(Actuator("A"), runs), Settings(model="first_order"))
    assert found.values["gain"] == pytest.approx(GAIN, rel=0.01)
    assert found.values["tau"] == pytest.approx(LAG, rel=0.01)
