"""The power of eight lanes at once, against the one of the mathematics library."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ident.simulation.kernel.machine_code import LANES, advance

LINE = f"b[{3 * LANES} + lane] = pow(b[0 + lane], b[{LANES} + lane])"


def powers(x, y):
    """x^y of sixteen pairs, by a kernel."""
    b, out, none, at = np.zeros(8 * LANES), np.zeros(LANES), np.zeros(LANES), np.zeros(LANES, dtype=np.int64)
    b[:LANES], b[LANES : 2 * LANES] = x, y
    advance((LINE,), (), 3)(b, none, none, at, at, 0, 1, 1, out, LANES)
    return out


def test_all_digits_of_a_power_are_right():
    rng = np.random.default_rng(3)
    for _ in range(200):
        x, y = np.exp(rng.uniform(-30.0, 8.0, LANES)), rng.uniform(-3.0, 10.0, LANES)
        wanted = np.array([math.pow(a, b) for a, b in zip(x, y, strict=True)])
        assert powers(x, y) == pytest.approx(wanted, rel=2e-14)


def test_far_from_one_a_power_keeps_thirteen_digits():
    x = np.array([1e-300, 1e300, 1e-160, 1e150, 3e-310, 5e-324, 1.0 + 1e-15, 1.0 - 1e-16] * 2)
    y = np.array([0.9, 0.9, 1.9, 2.0, 0.5, 0.25, 1e14, 1e15, -0.9, -0.9, -1.9, -2.0, -0.5, -0.25, -1e14, -1e15])
    wanted = np.array([math.pow(a, b) for a, b in zip(x, y, strict=True)])
    assert powers(x, y) == pytest.approx(wanted, rel=1e-13)


def test_what_is_not_positive_follows_the_library():
    x = np.array([0.0, 0.0, 0.0, -2.0, -2.0, -2.0, -2.0, np.inf, np.inf, np.nan, 2.0, 1e300, 1e300, 1.0, -3.0, 0.5])
    y = np.array([2.0, 0.0, -1.0, 3.0, 2.0, 0.5, -1.0, 2.0, -2.0, 2.0, np.nan, 2.0, -2.0, 5.0, 0.0, 5000.0])
    with np.errstate(all="ignore"):
        wanted = np.power(x, y)
    assert powers(x, y) == pytest.approx(wanted, rel=1e-15, nan_ok=True)
