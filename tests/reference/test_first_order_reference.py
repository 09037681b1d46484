"""The closed form of the first-order loop against SciPy's integration of the same equation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.reference import first_order_reference as reference


def test_the_closed_form_solves_the_equation_through_a_step_of_both_parameters():
    sines = (reference.Sine(), reference.Sine(0.01, 7.3, 0.4))
    loops = (reference.Loop(5e-3, 1.0), reference.Loop(50e-3, 0.9, 0.3))
    t = reference.times(0.6)
    value, expected = 0.0, []
    for loop, (first, last) in zip(loops, ((0.0, 0.3), (0.3, 0.6)), strict=True):
        inside = t[(t >= first) & (t < last)]

        def rate(at, y, loop=loop):
            return (loop.gain * reference.reference(np.array([at]), sines) - y) / loop.tau

        found = solve_ivp(rate, (first, last), [value], t_eval=[*inside, last], rtol=1e-10, atol=1e-13, method="DOP853")
        expected.append(found.y[0, :-1])
        value = found.y[0, -1]
    assert reference.response(t, loops, sines) == pytest.approx(np.concatenate(expected), abs=1e-9)


def test_a_held_reference_is_answered_by_decays_to_its_levels():
    found = reference.held(np.array([1.0, 1.0, 0.0, 0.0]), reference.Loop(1 / 4096, 2.0))
    rise = 2 * (1 - np.exp(-2.0))
    assert found == pytest.approx([0.0, 2 * (1 - np.exp(-1.0)), rise, rise * np.exp(-1.0)])
