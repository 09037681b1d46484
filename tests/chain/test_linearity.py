"""What is linear is read off the equations, and what is not is linearised about an operating point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.chain.chain import Chain
from ident.effects import EFFECTS
from ident.presets import PRESETS, preset
from ident.stages import LINEAR_FLOW, MASS_SPRING_DAMPER, MEASURED_LOAD, SQUARE_ROOT_FLOW
from ident.stages.stage import Quantity, stage

QIAN = PRESETS["qian2014"].chain
LINEAR = {"integral_action", "lead", "pressure_feedback", "frame_compliance", "sensor_gain"}
"""Effects of the catalogue whose equations are."""


def with_stage(old, new) -> Chain:
    """The paper's chain with another stage in one place."""
    return replace(QIAN, stages=tuple(new if one is old else one for one in QIAN.stages))


def test_the_cores_are_linear_but_kononykhins_tanks_and_the_one_with_overlap_and_friction():
    assert {name for name, known in PRESETS.items() if not known.chain.is_linear} == {
        "kononykhin",
        "strano",
        "two_tanks",
    }


def test_a_square_root_and_a_measured_force_are_not():
    assert not with_stage(LINEAR_FLOW, SQUARE_ROOT_FLOW).is_linear
    assert not with_stage(MASS_SPRING_DAMPER, MEASURED_LOAD).is_linear


@pytest.mark.parametrize("name", [effect.name for effect in EFFECTS])
def test_an_effect_is_what_its_equations_are(name):
    assert preset("qian2014", (name,)).chain.is_linear is (name in LINEAR)


@pytest.mark.parametrize(
    ("text", "linear"),
    [
        ("x' = (u - x) / T", True),
        ("x' = u * k * c - 0 * x", True),
        ("x' = -(x + u)", True),
        ("x' = u + b", False),
        ("x' = u * x", False),
        ("x' = u / x", False),
        ("x' = abs(u)", False),
        ("x' = sqrt(k) * u", True),
        ("x' = x ** 2", False),
        ("x' = k ** 2 * x + u", True),
        ("x' = lag(u, T)", False),
        ("x' = u + t * k", False),
    ],
)
def test_a_rate_is_linear_where_it_is_of_the_first_degree(text, linear):
    load = stage("load", (Quantity("x", "m", "position"),), (text, "its rate"))
    assert Chain((load,), {"displacement": "x"}).is_linear is linear


def test_about_an_operating_point_the_slopes_are_those_of_the_equations():
    """dQ/dw = Z0/A sqrt(1 − P/Ps), dQ/dP = −Z0/A w / (2 Ps sqrt(1 − P/Ps)) with the spool open to one side."""
    chain = with_stage(LINEAR_FLOW, SQUARE_ROOT_FLOW)
    values = {p.name: p.value for p in PRESETS["qian2014"].parameters}
    values |= {"A": 4.97e-4, "Kp": 7.0, "mL": 1.0, "k": 1e4, "cL": 0.0, "Ps": 21e6}
    w, P = 2e-4, 6e6
    about = [{"q1": w, "P": P}.get(name, 0.0) for name in chain.states] + [0.0]
    q1, pressure = chain.states.index("q1"), chain.states.index("P")
    Z, left = values["Z0"] / values["A"], np.sqrt(1 - P / values["Ps"])
    A = chain.linearise(values, about=about).A
    assert A[pressure, q1] * values["Ka"] == pytest.approx(Z * left, rel=1e-4, abs=0)
    lost = -Z * w / (2 * values["Ps"] * left)
    assert A[pressure, pressure] * values["Ka"] == pytest.approx(lost - values["Cl"], rel=1e-3, abs=0)
    at_rest = chain.linearise(values).system
    assert at_rest == pytest.approx(QIAN.linearise(values).system, rel=1e-3, abs=0)
