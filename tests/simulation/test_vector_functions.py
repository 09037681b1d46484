"""Power, sine and cosine of eight lanes at once, against those of the mathematics library."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ident.simulation.kernel.machine_code import LANES, advance


def found(function, x, y=0.0):
    """The function of sixteen numbers, or pairs, by a kernel."""
    b, out, none, at = np.zeros(8 * LANES), np.zeros(LANES), np.zeros(LANES), np.zeros(LANES, dtype=np.int64)
    b[:LANES], b[LANES : 2 * LANES] = x, y
    line = f"b[{3 * LANES} + lane] = {function.replace('x', 'b[0 + lane]').replace('y', f'b[{LANES} + lane]')}"
    advance((line,), (), 3)(b, none, none, at, at, 0, 1, 1, out, LANES)
    return out


def powers(x, y):
    """x^y of sixteen pairs, by a kernel."""
    return found("pow(x, y)", x, y)


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


@pytest.mark.parametrize("name", ["sin", "cos"])
@pytest.mark.parametrize("largest", [1e-8, 1.0, 100.0, 1e5, 1e9])
def test_sine_and_cosine_are_right_to_the_last_digits(name, largest):
    rng = np.random.default_rng(4)
    for _ in range(100):
        x = rng.uniform(-largest, largest, LANES)
        assert found(f"{name}(x)", x) == pytest.approx(getattr(np, name)(x), rel=1e-13, abs=2e-15 * min(largest, 1.0))


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_at_right_angles_and_where_there_is_no_angle(name):
    x = np.array([0.0, -0.0, *np.arange(-5, 5) * np.pi / 2, np.inf, -np.inf, np.nan, 1e16])
    values = found(f"{name}(x)", x)
    assert values[:12] == pytest.approx(getattr(np, name)(x[:12]), rel=1e-9, abs=1e-16)
    assert np.all(np.isnan(values[12:]))
