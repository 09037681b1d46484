"""Lines on rows of numbers as machine code, against the same lines in NumPy."""

from __future__ import annotations

import numpy as np
import pytest

from ident.simulation.kernel.elementwise import elementwise

LINES = ("sum = a * x + 0.5 * y", "least = sum if sum < b else b", "ratio = -x / (y * y + 2.0)")


@pytest.mark.parametrize("count", [1, 7, 8, 9, 40])
def test_each_place_of_each_row_is_what_the_lines_say_and_no_other_is_written(count):
    """Of rows that lie apart, at three times with other shared numbers; the third row of four is read by no line."""
    rng, times = np.random.default_rng(count), 3
    shared, rows = rng.standard_normal((2, 5)), rng.standard_normal((4, count + 2))
    rows[2] = np.nan
    out = np.full((2, times * (count + 3)), 7.0)
    apply = elementwise(LINES, ("a", "b"), ("x", "z", "unused", "y"), ("least", "ratio"))
    apply(shared, shared.shape[1], times, rows, rows.shape[1], count, out, out.shape[1], count + 3)
    x, y = rows[0, :count], rows[3, :count]
    for time, found in enumerate(np.split(out, times, axis=1)):
        a, b = shared[:, time]
        np.testing.assert_allclose(found[0, :count], np.minimum(a * x + 0.5 * y, b), rtol=1e-13, atol=1e-15)
        np.testing.assert_allclose(found[1, :count], -x / (y * y + 2.0), rtol=1e-13)
        assert np.all(found[:, count:] == 7.0)


@pytest.mark.parametrize(("times", "count"), [(0, 4), (2, 0)])
def test_where_there_is_nothing_nothing_is_written(times, count):
    out = np.full(8, 7.0)
    apply = elementwise(LINES, ("a", "b"), ("x", "z", "unused", "y"), ("least", "ratio"))
    apply(np.ones(4), 2, times, np.ones(16), 4, count, out, 4, 4)
    assert np.all(out == 7.0)


def test_an_output_may_be_a_row_a_shared_number_or_a_number():
    out = np.empty((3, 2))
    elementwise(("row = x", "number = 2.0"), ("a",), ("x",), ("row", "a", "number"))(
        np.array([3.0]), 1, 1, np.array([5.0, 6.0]), 2, 2, out, 2, 0
    )
    assert out.tolist() == [[5.0, 6.0], [3.0, 3.0], [2.0, 2.0]]
