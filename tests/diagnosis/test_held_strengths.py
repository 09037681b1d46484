"""A strength that is held: of what is there wholly or not at all, and of what the user holds, in fit and diagnosis."""

from __future__ import annotations

import numpy as np
import pytest

from ident.fit.parameter_bounds import with_candidates_given
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import diagnose, identify
from tests.conftest import rank_only

RATE, COUNT, LAG, NOISE, DRY = 100.0, 300, 0.1, 0.01, 0.4
LIGHT = {"population": 16.0, "generations": 3.0, "elite": 2.0}


def counted(seed: int, use: str) -> Run:
    """Held steps of voltage drive T w' = u − w against dry friction; the counter does not see the sign of w."""
    rng = np.random.default_rng([53, seed])
    u = np.repeat(rng.uniform(-2.0, 2.0, COUNT // 20), 20)
    w, share, stop = np.zeros(COUNT), -np.expm1(-1.0 / (20 * RATE * LAG)), 0.0
    for k in range(1, COUNT):
        now = w[k - 1]
        for _ in range(20):
            after, stop = now + share * (u[k - 1] - now), share * DRY
            now = after - stop if after > stop else after + stop if after < -stop else 0.0
        w[k] = now
    seen = np.abs(w) + NOISE * rng.standard_normal(COUNT)
    return Run(
        use,
        "",
        RATE,
        {"command": u, "velocity": seen},
        {"command": "V", "velocity": "rad/s"},
        hold="zoh",
        use=use,
        output="velocity",
    )


@pytest.fixture(scope="module")
def matrix() -> Matrix:
    return Matrix(Actuator("COUNTED"), (counted(0, "fit"), counted(1, "verify")))


@pytest.fixture
def two_effects(monkeypatch):
    """Look for two effects, whose kernels are compiled soon."""
    few = ("coulomb_friction", "rectified_sensor")
    rank_only(monkeypatch, few)


def test_a_counter_that_sees_no_sign_sees_none_of_it(matrix):
    """A user may still ask for a part of it."""
    settings = Settings(model="motor", effects=("rectified_sensor",), options=LIGHT)
    found = identify(matrix, settings)
    assert found.values["rectified_sensor.share"] == 1.0
    assert found.parameters["rectified_sensor.share"].std_error is None
    bounds = {"rectified_sensor.share": (0.0, 0.5)}
    searched = identify(matrix, Settings(model="motor", effects=settings.effects, options=LIGHT, bounds=bounds))
    assert searched.values["rectified_sensor.share"] == pytest.approx(0.5)


@pytest.mark.usefixtures("two_effects")
def test_what_is_there_wholly_or_not_at_all_is_named_wholly(matrix, full):
    if not full:
        pytest.skip("the long form: a diagnosis; the fit above holds the same strength")
    found = diagnose(matrix, identify(matrix, Settings(model="motor", options=LIGHT)), propose=False)
    assert set(found.verdict.effects) == {"rectified_sensor", "coulomb_friction"}
    last = found.ladder[-1].parameters
    assert last["rectified_sensor.share"].value == 1.0
    assert last["coulomb_friction.force"].value / last["c0"].value == pytest.approx(DRY, rel=0.05)


@pytest.mark.usefixtures("two_effects")
def test_a_strength_that_the_user_holds_is_tried_as_it_is_held(matrix):
    fit = with_candidates_given(identify(matrix, Settings(model="motor", options=LIGHT)), {}, {"coulomb_friction": 0.2})
    found = diagnose(matrix, fit, propose=False)
    tried = next(one for one in found.candidates if one.effect == "coulomb_friction")
    assert tried.parameters["coulomb_friction.force"].value == pytest.approx(0.2)
