"""Two tanks in series, against Torricelli's law as SciPy integrates it; and where such a machine is thought of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy

from ident.diagnosis.candidate_models import CandidateModels
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.presets.suitable_models import suitable_models
from ident.run import Run
from ident.workflows import diagnose, identify

PERIOD, COUNT = 4.0, 400
OUT_1, OUT_2, PUMP = 0.05, 0.04, 0.09  # m^½/s, m^½/s, m/(V s)
WEIR = 0.05  # m/s for each metre above the edge
READS = 1.5  # above the level
LIGHT = {"population": 24.0, "generations": 5.0, "elite": 4.0}


def tanks(seed: int, use: str, edge: float = np.inf, bend: float = 0.0) -> Run:
    """A pump under a held voltage of 1 to 3 V: h₁' = k u − a₁ √h₁, h₂' = a₁ √h₁ − a₂ √h₂.

    Above an edge the upper tank runs over, half of it into the lower one. What the gauge reads is bent between 0 and
    25 m.
    """
    rng = np.random.default_rng([71, seed])
    u = np.repeat(rng.uniform(1.0, 3.0, COUNT // 10), 10)
    t = PERIOD * np.arange(COUNT)

    def rates(now: float, h: np.ndarray) -> list[float]:
        first, second = OUT_1 * np.sqrt(max(h[0], 0.0)), OUT_2 * np.sqrt(max(h[1], 0.0))
        over = WEIR * max(h[0] - edge, 0.0)
        pumped = PUMP * u[min(int(now / PERIOD + 1e-9), COUNT - 1)]
        return [pumped - first - over, first + 0.5 * over - second]

    level = scipy.integrate.odeint(rates, [8.0, 20.0], t, tfirst=True, rtol=1e-8, atol=1e-8, hmax=PERIOD)[:, 1]
    level = level * (1.0 + bend * (level - 25.0))
    level = level + READS + 0.005 * level.std() * rng.standard_normal(COUNT)
    return Run(
        use,
        "",
        1.0 / PERIOD,
        {"command": u, "displacement": level},
        {"command": "V", "displacement": "m"},
        hold="zoh",
        use=use,
    )


@pytest.fixture(scope="module")
def matrix() -> Matrix:
    return Matrix(Actuator("TANKS"), (tanks(0, "fit"), tanks(1, "verify")))


@pytest.mark.full
def test_the_tanks_are_followed_and_what_torricelli_s_law_determines_is_found(matrix):
    found = identify(matrix, Settings(model="two_tanks", options=LIGHT, seed=1))
    lag = identify(matrix, Settings(model="first_order", options=LIGHT, seed=1))
    assert found.error_with_mean["verify"] < 0.03
    assert found.error_with_mean["verify"] < 0.2 * lag.error_with_mean["verify"]
    gain, upper, lower = (found.parameters[name] for name in ("gain", "tau1", "tau2"))
    assert all(one.std_error is not None and one.std_error < 0.1 * one.value for one in (gain, upper, lower))
    assert 1.0 / lower.value == pytest.approx(OUT_2, rel=0.05)
    assert 1.0 / upper.value == pytest.approx(OUT_1**2 / OUT_2, rel=0.05)  # its level in the unit of the lower one
    assert gain.value / upper.value == pytest.approx(PUMP * (OUT_1 / OUT_2) ** 2, rel=0.05)
    assert found.transducer_offset["displacement"].value == pytest.approx(READS, abs=0.4)


def test_a_search_begins_where_the_levels_stand_under_the_mean_command():
    """From empty tanks the true values leave more of the record than tanks that hardly answer."""
    searched = Identification(Matrix(Actuator("TANKS"), (tanks(0, "fit"),)), Settings(model="two_tanks")).searched
    true = {"gain": PUMP / OUT_2, "tau1": OUT_2 / OUT_1**2, "tau2": 1.0 / OUT_2}  # the upper level in the lower's unit
    assert searched.errors(searched.space.point(true)[None])[0] < 0.5  # 2.1 from empty tanks


@pytest.mark.full
def test_a_bent_gauge_leaves_the_time_constants_determined():
    """A curve that is right at zero alone turns the scale of the level too, on which every parameter hangs."""
    matrix = Matrix(Actuator("TANKS"), (tanks(0, "fit", bend=0.03),))
    found = identify(matrix, Settings(model="two_tanks", effects=("sensor_curve",), options=LIGHT, seed=1))
    assert found.error["fit"] < 0.006
    for name in ("gain", "tau1", "tau2"):
        one = found.parameters[name]
        assert one.std_error is not None
        assert one.std_error < 0.02 * one.value


def test_an_overflow_of_the_upper_tank_is_named(full):
    """Its level is nowhere recorded; the lower one follows a large command no more than a smaller one."""
    if not full:
        pytest.skip("the long form: a diagnosis of four hundred samples that ring for long")
    runs = (tanks(0, "fit", edge=13.0), tanks(1, "verify", edge=13.0))
    matrix = Matrix(Actuator("TANKS"), runs)
    found = diagnose(matrix, identify(matrix, Settings(model="two_tanks", options=LIGHT, seed=1)), propose=False)
    assert "upper_overflow" in found.verdict.effects
    assert found.ladder[-1].error["verify"] < 0.7 * found.ladder[0].error["verify"]


def test_an_overflow_is_tried_whatever_is_predicted_of_it(matrix):
    """Without it a fit may lie so far off that an edge promises nothing there."""
    models = CandidateModels.of(matrix, Settings(model="two_tanks"))
    assert models.is_called_for("overflow")
    assert not models.is_called_for("dead_zone")


def test_tanks_are_thought_of_where_command_and_output_stay_on_one_side_of_zero(matrix):
    assert "two_tanks" in {model.name for model in suitable_models(matrix.runs)}
    run = matrix.runs[0]
    for name in ("command", "displacement"):
        about_zero = {**run.channels, name: run.channels[name] - run.channels[name].mean()}
        assert "two_tanks" not in {model.name for model in suitable_models([replace(run, channels=about_zero)])}
