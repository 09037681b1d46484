"""Windows that were chosen without an effect are weighed again with it."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

from ident.diagnosis.diagnose import models_of
from ident.diagnosis.prediction_horizon import may_hide_an_effect
from ident.diagnosis.result import Diagnosis
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.fit.test_windows import MOTOR, cylinder


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


def slowly_driven(skew: float) -> Matrix:
    """x' = (1 + skew sgn u) u / 10, of a command of low-passed noise at 50 Hz; the noise is 2 mm."""
    random = np.random.default_rng(67)
    u = scipy.signal.lfilter(*scipy.signal.butter(4, 0.1), random.standard_normal(1500))
    x = np.cumsum(0.1 / 50.0 * u * (1.0 + skew * np.sign(u))) + 2e-3 * random.standard_normal(len(u))
    return Matrix(Actuator("CYLINDER"), (Run("fit", "", 50.0, {"command": u, "displacement": x}, {}, hold="zoh"),))


@pytest.mark.parametrize(("skew", "over", "hides"), [(0.3, (0.32, 0.05), True), (0.0, (None, None), False)])
def test_windows_that_leave_their_noise_say_whether_a_model_may_hide_an_effect(skew, over, hides):
    """Each begins with a speed that was told from noise: what the effect adds to a window is next to nothing then."""
    matrix = slowly_driven(skew)
    fit = identify(matrix, MOTOR)
    models = models_of(matrix, fit, ()).over_windows(*over)
    values = {models.model(()).parameter(name).in_equations: value for name, value in fit.values.items()}
    base = models.converged(models.refit((), values))
    assert not models.residual_above_noise(base)
    assert may_hide_an_effect(models, base) == hides
