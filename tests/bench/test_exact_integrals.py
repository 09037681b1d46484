"""The closed forms of a part of a sample are the integrals that they stand for, with their derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from ident.bench.exact_integrals import bend, gains_of, simpson_share, while_moving, while_starting

H, STILL = 1e-3, 0.02


def slope(of: Callable[..., float], at: tuple[float, ...], place: int) -> float:
    """The derivative of a function by one of its arguments, by central differences."""
    step = 1e-6 * at[place]
    above, below = ([*at[:place], at[place] + sign * step, *at[place + 1 :]] for sign in (1.0, -1.0))
    return (of(*above) - of(*below)) / (2.0 * step)


def moving(still: float, a0: float, a1: float) -> float:
    """The way over a part in which f/√a and a go along straight lines, f being 2 a² + a."""
    e0, e1 = ((2.0 * a**2 + a) / np.sqrt(a) for a in (a0, a1))
    return H * quad(lambda p: (e0 + (e1 - e0) * p) * np.sqrt(a0 + (a1 - a0) * p - still), 0.0, 1.0, epsabs=0.0)[0]


@pytest.mark.parametrize(("a0", "a1"), [(0.03, 0.04), (0.05, 0.021), (0.3, 0.31)])
def test_a_part_in_which_the_link_moves_is_the_integral_of_a_line_times_a_root(a0, a1):
    f0, f1 = (2.0 * a**2 + a for a in (a0, a1))
    W0, W1, by0, by1, by_still = while_moving(H, STILL, a0, f0, 4.0 * a0 + 1.0, a1, f1, 4.0 * a1 + 1.0)
    at = (STILL, a0, a1)
    assert W0 * f0 + W1 * f1 == pytest.approx(moving(*at), rel=1e-9, abs=0.0)
    assert [by_still, by0, by1] == pytest.approx([slope(moving, at, i) for i in range(3)], rel=1e-5, abs=0.0)


def starting(still: float, inner: float, outer: float) -> float:
    """The way from where the link starts, f/√a being 0.4 there, and that of f = 2 a² + a at the outer end."""
    d, end = outer - still, (2.0 * outer**2 + outer) / np.sqrt(outer)
    return H / (outer - inner) * quad(lambda p: (0.4 + (end - 0.4) * p / d) * np.sqrt(p), 0.0, d, epsabs=0.0)[0]


@pytest.mark.parametrize(("inner", "outer"), [(0.01, 0.03), (0.001, 0.021), (0.019, 0.1)])
def test_a_part_in_which_the_link_starts_begins_where_the_current_leaves_the_dead_space(inner, outer):
    f = 2.0 * outer**2 + outer
    W, Ws, by_inner, by_outer, by_still = while_starting(H, STILL, 0.4, inner, outer, f, 4.0 * outer + 1.0)
    assert W * f + Ws * 0.4 == pytest.approx(starting(STILL, inner, outer), rel=1e-9, abs=0.0)
    expected = [slope(lambda i, still, o: starting(still, i, o), (inner, STILL, outer), i) for i in range(3)]
    assert [by_inner, by_still, by_outer] == pytest.approx(expected, rel=1e-4, abs=0.0)


@pytest.mark.parametrize("T", [1e-4, 1e-3, 0.05])
def test_the_gains_of_a_part_are_those_of_a_lag_under_a_straight_line(T):
    """Those of a numerical solution, and their derivatives by T."""
    gains, slopes = gains_of(T, H, (1, 8))
    for row, parts in zip(gains, (1, 8), strict=True):
        h = H / parts
        for start, first, last, expected in ((1.0, 0.0, 0.0, row[0]), (0.0, 1.0, 0.0, row[1]), (0.0, 0.0, 1.0, row[2])):
            found = solve_ivp(
                lambda t, y, a=first, b=last, h=h: (a + (b - a) * t / h - y) / T,
                (0.0, h),
                [start],
                rtol=1e-10,
                atol=1e-13,
            )
            assert found.y[0, -1] == pytest.approx(expected, rel=1e-6, abs=1e-10)
    step = 1e-6 * T
    differences = (gains_of(T + step, H, (1, 8))[0] - gains_of(T - step, H, (1, 8))[0]) / (2.0 * step)
    assert slopes == pytest.approx(differences, rel=1e-4, abs=1e-9 / T)


def test_two_parts_together_integrate_a_cube_exactly():
    total = sum(
        simpson_share(part) * (0.5 * part) ** 3 + (1.0 - simpson_share(part)) * (0.5 * (part + 1)) ** 3
        for part in (0, 1)
    )
    assert 0.5 * total == pytest.approx(0.25)


def test_a_lagged_current_that_bends_moves_the_link_by_more_or_less_than_its_ends_say():
    """Under a straight line of the current, the speed in proportion to the lagged one: within 1 % of the difference."""
    T, q, first, rise = 0.01, 0.0, 0.0, 0.02
    (phi, g0, g1), _ = (rows[0] for rows in gains_of(T, H, (1,)))
    end = phi * q + g0 * first + g1 * (first + rise)
    way = quad(lambda t: rise * (t - T * (1.0 - np.exp(-t / T))) / H, 0.0, H)[0]
    found = 0.5 * H * (q + end) - bend(H, T, H, rise - end + q)
    assert found - way == pytest.approx(0.0, abs=0.01 * abs(0.5 * H * (q + end) - way))
