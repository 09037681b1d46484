"""A mode that is faster in motion than at rest is followed as it is in motion."""

from __future__ import annotations

import numpy as np
import pytest

from ident.effects import CATALOGUE
from ident.presets import preset
from ident.simulation.steps import fastest_mode

C, M, C2 = 1050.0, 10.0, 7.3e5
KNOWN = {"m0": M, "c0": C, "k0": 0.0}


def fastest(effect: str, value: float, motion: dict[str, float]) -> float:
    """The fastest mode, 1/s, of a driven mass with an effect."""
    chosen = tuple(one for one in CATALOGUE if one.name == effect)
    chain = preset("drive").with_effects(chosen).chain
    values = {name: np.array([KNOWN.get(name, 0.0)]) for name in chain.symbols}
    values[chosen[0].added[0].in_equations] = np.array([value])
    return float(np.abs(fastest_mode(chain, values, "displacement", motion))[0])


def test_damping_that_grows_with_the_speed_makes_a_mode_faster_in_motion():
    """(c + 2 c2 |v|) / m, about a speed v."""
    assert fastest("quadratic_damping", C2, {}) == pytest.approx(C / M, rel=1e-3)
    assert fastest("quadratic_damping", C2, {"v": 0.06}) == pytest.approx((C + 2 * C2 * 0.06) / M, rel=1e-3)


def test_a_spring_that_hardens_makes_a_mode_faster_where_the_motion_ends():
    """The root of largest size of m s² + c s + 3 k3 x² about a position x."""
    k3, x = 1e9, 0.02
    slope = 3 * k3 * x**2
    assert fastest("cubic_stiffness", k3, {"x": x}) == pytest.approx(np.sqrt(slope / M), rel=1e-3)


def test_a_chain_that_is_linear_is_as_fast_everywhere():
    assert fastest("static_load", 5.0, {"v": 1.0}) == pytest.approx(C / M, rel=1e-6)
