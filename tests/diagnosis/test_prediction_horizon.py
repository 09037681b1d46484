"""Windows that were chosen without an effect are weighed again with it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.diagnosis.result import Diagnosis
from ident.fit.settings import Settings
from ident.matrix import Matrix
from ident.workflows import diagnose, identify
from tests.fit.test_windows import cylinder


def found(matrix: Matrix) -> tuple[float, Diagnosis]:
    """The window of the fit, and what is missing."""
    fit = identify(matrix, Settings(model="motor"))
    assert fit.window is not None
    return fit.window.horizon, diagnose(matrix, fit, most=1, propose=False)


@pytest.mark.full
@pytest.mark.usefixtures("few_effects")
def test_another_gain_each_way_is_judged_over_whole_runs():
    """Over the windows that it made necessary it is worth little: a free run falls to the noise."""
    matrix = cylinder(7, wander=0.0, skew=0.3, seconds=60.0)
    _, diagnosis = found(matrix)
    assert diagnosis.horizon is None
    assert diagnosis.verdict.effects == ("gain_asymmetry",)
    first, last = (rung.error["fit"] for rung in diagnosis.ladder)
    assert last < 1.5 * 2e-4 / np.std(matrix.runs[0].measured) < 0.1 * first
    assert "These errors are over whole runs. The fit used windows of" in diagnosis.verdict.text


@pytest.mark.usefixtures("few_effects")
def test_where_disturbances_add_up_the_windows_stay():
    horizon, diagnosis = found(cylinder(8, wander=1e-3, dead=0.2, seconds=60.0))
    assert diagnosis.horizon == horizon
    assert "whole runs" not in diagnosis.verdict.text
