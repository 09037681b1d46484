"""A servo motor whose torque ends at the speed that its voltage allows: no friction and no load stands for it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy
from numpy.typing import NDArray

from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.initial_guesses import strength_in_records
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

RATE, NOISE, TOP = 50.0, 0.01, 14.0
FEW = ("speed_limit", "coulomb_friction", "static_load", "quadratic_damping", "elastic_load", "damping_asymmetry")


def pulses(seed: int) -> Run:
    """1.1 ω′ = T f - 0.1 ω - 1.0 sign(ω): the share f of the torque falls to 0 between 12.6 and 14 rad/s, by SciPy.

    A pulse of torque each way, and then the motor runs down by its dry friction. In noise of 1 % of the deviation.
    """
    rng = np.random.default_rng(seed)
    torque = np.zeros(500)
    for first, way in ((10, 1.0), (100, -1.0)):
        torque[first : first + 20] = way * rng.uniform(40.0, 120.0)
    t = np.arange(len(torque)) / RATE

    def rates(at: float, s: NDArray[np.float64]) -> list[float]:
        asked = torque[min(int(at * RATE + 1e-9), len(torque) - 1)]
        left = float(np.interp(s[0] * np.sign(asked), [0.9 * TOP, TOP], [1.0, 0.0]))
        return [(asked * left - 0.1 * s[0] - np.tanh(s[0] / 0.01)) / 1.1]

    speed = scipy.integrate.solve_ivp(rates, (0.0, t[-1]), [0.0], t_eval=t, rtol=1e-7, max_step=0.5 / RATE).y[0]
    speed = speed + NOISE * np.std(speed) * rng.standard_normal(len(t))
    channels, units = {"command": torque, "velocity": speed}, {"command": "N*m", "velocity": "rad/s"}
    return Run(
        f"run-{seed}", "", RATE, channels, units, output="velocity", hold="zoh", use="verify" if seed == 3 else "fit"
    )


def test_a_search_for_the_limit_begins_at_the_largest_speed_of_all_runs():
    """Of speeds that were measured, and of rates of angles; along the range no limit acted on any record."""
    turned = [pulses(seed) for seed in range(3)]
    angles = [
        replace(
            run,
            output="displacement",
            channels={"command": run.command, "displacement": np.cumsum(run.measured) / RATE},
            units={"command": "N*m", "displacement": "rad"},
        )
        for run in turned
    ]
    for runs, close in ((turned, 1e-9), (angles, 0.1)):
        models = CandidateModels.of(Matrix(Actuator("SERVO"), tuple(runs)), Settings(model="drive"))
        base = models.refit((), {p.in_equations: p.value for p in models.preset.parameters})
        fastest = max(float(np.abs(run.measured).max()) for run in turned)
        assert strength_in_records(base, models.effects["speed_limit"]) == pytest.approx(1.0 / fastest, rel=close)


@pytest.mark.full
def test_a_torque_that_ends_at_a_speed_is_named_before_the_friction(monkeypatch):
    rank_only(monkeypatch, FEW)
    records = Matrix(Actuator("SERVO"), tuple(pulses(seed) for seed in range(4)))
    found = diagnose(records, identify(records, Settings(model="drive")), propose=False)
    assert found.verdict.effects[:2] == ("speed_limit", "coulomb_friction")
    limit = found.ladder[-1].parameters["speed_limit.inverse_speed"]
    assert limit.value == pytest.approx(1.0 / TOP, rel=0.03)
    assert found.ladder[-1].error["verify"] < 1.2 * NOISE
