"""The variables of a file that state a sample rate."""

from __future__ import annotations

import pytest

from ident.readers.rate_variable import rate_of


@pytest.mark.parametrize(
    ("scalars", "found"),
    [
        ([("rec.Ts", 0.002)], (500.0, "rec.Ts")),
        ([("group/Fs", 200.0), ("group/dt", 0.005)], (200.0, "group/Fs")),
        ([("offset", 3.0)], (0.0, "")),
        ([("a.Ts", 0.002), ("b.Ts", 0.004)], (0.0, "")),
        ([("Ts", float("nan"))], (0.0, "")),
    ],
)
def test_the_variable_is_named_with_its_structure_and_two_must_agree(scalars, found):
    assert rate_of(scalars) == found
