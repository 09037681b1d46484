"""An arm whose weight was fitted as a spring: the weight is named, not a spring that bends."""

from __future__ import annotations

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.screening import predict
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.blind.various import Various
from tests.conftest import rank_only

FEW = ("arm_gravity", "cubic_stiffness", "coulomb_friction", "end_stop", "static_load")
LIGHT = {"population": 24.0, "generations": 8.0, "elite": 4.0}
RATE, COUNT, NOISE, TORQUE = 100.0, 3000, 0.002, 45.0


def lifted(seed: int) -> Run:
    """θ″ + 5 θ′ + 45 sin θ = 8 u with steps of u up to 3.5, by SciPy: the drive cannot hold the arm level."""
    rng, t = np.random.default_rng([9, seed]), np.arange(COUNT) / RATE
    volts = np.repeat(rng.uniform(-3.5, 3.5, COUNT // 150 + 1), 150)[:COUNT]
    volts[:50] = 0.0

    def rates(at: float, s: NDArray[np.float64]) -> list[float]:
        return [s[1], 8.0 * volts[min(int(at * RATE + 1e-9), COUNT - 1)] - 5.0 * s[1] - TORQUE * np.sin(s[0])]

    angle = scipy.integrate.solve_ivp(rates, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-8, max_step=1.0 / RATE).y[0]
    angle = angle + NOISE * np.std(angle) * rng.standard_normal(COUNT)
    channels, units = {"command": volts, "displacement": angle}, {"command": "V", "displacement": "rad"}
    return Run(f"run-{seed}", "", RATE, channels, units, use="verify" if seed else "fit", hold="zoh")


@pytest.fixture(scope="module")
def arm() -> Matrix:
    return Matrix(Actuator("ARM"), (lifted(0), lifted(1)))


def test_a_weight_may_be_larger_than_its_drive_can_hold_level(arm):
    fit = identify(arm, Settings(model="sprung_motor", effects=("arm_gravity",)))
    assert fit.parameters["arm_gravity.torque"].value / fit.values["m0"] == pytest.approx(TORQUE, rel=0.02)
    assert fit.error["verify"] < 1.5 * NOISE


def test_a_weight_is_predicted_in_the_place_of_a_part_of_the_spring(arm):
    """Beside the whole spring no weight promises anything: the machine is then twice as stiff."""
    models = CandidateModels.of(arm, Settings(model="sprung_motor"))
    base = models.refit((), identify(arm, Settings(model="sprung_motor")).values)
    weight, bent = predict(models, base, ["arm_gravity", "cubic_stiffness"])
    assert bent.remaining < weight.remaining < 0.2


@pytest.mark.full
def test_the_weight_of_an_arm_that_hangs_takes_the_place_of_a_part_of_the_spring(monkeypatch):
    """It swings by 100 degrees; its machine is integrated by SciPy."""
    rank_only(monkeypatch, FEW)
    arm = Various.drawn(168008, hidden=True)
    assert (arm.kind, arm.hidden) == ("arm", "arm_gravity")
    records = arm.measured()
    found = diagnose(records, identify(records, Settings(model="drive", options=LIGHT)), propose=False)
    assert found.verdict.effects == ("arm_gravity",)
    assert found.ladder[-1].error["fit"] < 1.05 * arm.noise
