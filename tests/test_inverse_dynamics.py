"""Mass and friction of a drive by inverse dynamics: on measured data, and on a rigid mass of known friction."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from ident.errors import Unusable
from ident.inverse_dynamics import regress
from ident.matrix import Actuator, Matrix, Run
from ident.readers import read_matrix

EMPS = Path(__file__).parents[2] / "shared" / "data" / "emps"
PUBLISHED = {"mass": 95.0, "viscous": 203.0, "coulomb": 20.4, "offset": -3.2}


@pytest.fixture(scope="module")
def measured():
    """The regression on the measured positioning system."""
    if not EMPS.exists():
        pytest.skip("the measured data emps is not here")
    return regress(read_matrix(EMPS))


def test_the_published_values_are_found(measured):
    """Mass, viscous and dry friction and offset within 5 % of the publication."""
    for name, value in PUBLISHED.items():
        assert measured.coefficients[name].value == pytest.approx(value, rel=0.05)


def test_dry_friction_explains_the_force(measured):
    """Leaving it out makes the residual at least 2.5 times as large, 1.8 times on the pulses that no fit saw."""
    ratio = {run: measured.residual_without_friction[run] / measured.residual[run] for run in measured.residual}
    assert ratio["estimation"] >= 2.5
    assert ratio["validation-pulses"] >= 1.8


def drive(seed: int) -> Matrix:
    """A rigid mass of 5 kg that is moved along a known path, the force computed from it."""
    t = np.arange(0, 8, 1e-3)
    rng = np.random.default_rng(seed)
    x = sum(
        a * np.sin(2 * np.pi * f * t + p) for a, f, p in zip((0.1, 0.03), (0.4, 1.1), rng.uniform(0, 6, 2), strict=True)
    )
    v, a = np.gradient(x, t), np.gradient(np.gradient(x, t), t)
    force = 5.0 * a + 12.0 * v + 3.0 * np.sign(v) + 0.7 + 0.05 * rng.standard_normal(len(t))
    channels = {"command": x, "displacement": x + 1e-6 * rng.standard_normal(len(t)), "drive_force": force}
    return Matrix(Actuator("DRIVE"), (Run("run", "", 1000.0, channels),))


def test_a_known_drive_is_found_within_its_standard_errors():
    """Every coefficient is within 4 standard errors, or within 1 % where these are smaller still."""
    found = regress(drive(3)).coefficients
    for name, truth in {"mass": 5.0, "viscous": 12.0, "coulomb": 3.0, "offset": 0.7}.items():
        assert abs(found[name].value - truth) < max(4 * found[name].std_error, 0.01 * truth)


def test_without_a_measured_force_it_says_so():
    """The refusal names the channel."""
    run = drive(3).runs[0]
    bare = Run("run", "", 1000.0, {"command": run.command, "displacement": run.measured})
    with pytest.raises(Unusable, match="drive_force"):
        regress(Matrix(Actuator("DRIVE"), (bare,)))
