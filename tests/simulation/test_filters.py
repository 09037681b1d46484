"""The gains of a lag against integrals of its own convolution, from no time at all to any."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from ident.equations.grammar import tree_of
from ident.simulation.filters import pack_filter
from ident.simulation.kernel import Filter
from ident.simulation.kernel.layout import filter_rows

STEP = 1e-3


def gains(order: int, *coefficients: float) -> list[float]:
    """The rows of a filter in a buffer of eight lanes, which are alike."""
    rows = np.full((2 + filter_rows(order), 8), np.nan)
    names = ("T",) if order == 1 else ("a1", "a2")
    known = Filter(order, tree_of("u"), tuple(tree_of(name) for name in names), 2)
    values = {name: np.full(8, value) for name, value in zip(names, coefficients, strict=True)}
    pack_filter(rows, known, values | {"dt": np.full(8, STEP)})
    found = rows[2 + order :]
    assert np.all(np.isfinite(found))
    assert np.all(found == found[:, :1])
    return list(found[:, 0])


def weight(a: float, polynomial) -> float:
    """∫ a e^(−a (1 − σ)) p(σ) dσ over a step: what an input p leaves in a lag of a = step/T."""
    return quad(
        lambda s: a * np.exp(-a * (1 - s)) * polynomial(s),
        0,
        1,
        epsabs=1e-15,
        epsrel=1e-12,
        points=[1 - 1 / a] if a > 1 else None,
    )[0]


@pytest.mark.parametrize("a", [1e-4, 0.02, 0.7, 1.0, 1.4, 8.0, 60.0])
def test_a_lag_is_advanced_exactly(a):
    start, half, whole = np.split(np.array(gains(1, STEP / a)), [2, 5])
    assert list(start) == [1.0, 0.0]
    line = [weight(a / 2, lambda s: 1 - s), weight(a / 2, lambda s: s)]
    assert half == pytest.approx([np.exp(-a / 2), *line], rel=1e-9, abs=1e-14)
    parabola = [
        weight(a, lambda s: 1 - 3 * s + 2 * s * s),
        weight(a, lambda s: 4 * s - 4 * s * s),
        weight(a, lambda s: 2 * s * s - s),
    ]
    assert whole == pytest.approx([np.exp(-a), *parabola], rel=1e-9, abs=1e-14)


@pytest.mark.parametrize("T", [0.0, 1e-12])
def test_a_lag_of_no_time_passes_its_input_on(T):
    start, half, whole = np.split(np.array(gains(1, T)), [2, 5])
    assert list(start) == ([0.0, 1.0] if T == 0 else [1.0, 0.0])
    assert half == pytest.approx([0, 0, 1], abs=1e-8)
    assert whole == pytest.approx([0, 0, 0, 1], abs=1e-8)


def test_two_poles_a_step_apart_are_the_two_lags_that_they_are():
    """(T s + 1)² x = u, from rest: the response to a constant is 1 − (1 + a) e⁻ᵃ."""
    T = STEP / 2
    whole = np.array(gains(2, 2 * T, T * T))[-10:].reshape(2, 5)
    assert whole[0, 2:].sum() == pytest.approx(1 - 3 * np.exp(-2.0), rel=1e-12)
    assert gains(2, 0.0, 0.0)[-10:] == [0, 0, 0, 0, 1, 0, 0, 0, 0, 0]
