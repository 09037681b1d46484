"""Targets from files: what they may hold, and how a mistake is told."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ident.errors import Unusable
from ident.hybrid.target_loop import QIAN2014_TARGET, Target, read_target


def test_the_papers_target_is_eq_19():
    """1000 at standstill, and one near 39 Hz."""
    found = QIAN2014_TARGET.rational
    assert found.static_gain == pytest.approx(1000)
    assert abs(found.response(np.array([2j * np.pi * 39.0]))[0]) == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("as_json", [False, True])
def test_a_target_is_read_from_yaml_and_json(as_json):
    """The same target, and a roll-off in Hz or rad/s."""
    data = {"numerator": [1.2e6], "denominator": [0.008, 20, 65, 1200], "roll_off": "3000 rad/s", "name": "faster"}
    yaml = "numerator: [1.2e6]\ndenominator: [0.008, 20, 65, 1200]\nroll_off: 3000 rad/s\nname: faster\n"
    found = read_target((json.dumps(data) if as_json else yaml).encode(), "target.yaml")
    assert found == Target((1.2e6,), (0.008, 20.0, 65.0, 1200.0), 3000.0, "faster")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("numerator: [1]\n", "missing-field"),
        ("numerator: [1]\ndenominator: 3\n", "bad-target"),
        ("numerator: [1, 2]\ndenominator: [1, 2]\n", "bad-target"),
        ("numerator: [1]\ndenominator: [1, 0]\n", "bad-target"),
        ("numerator: [1]\ndenominator: [0, 1, 1]\n", "bad-target"),
        ("numerator: []\ndenominator: [1, 1]\n", "bad-target"),
        ("numerator: [1]\ndenominator: [1, 1]\nroll_off: -1 rad/s\n", "bad-target"),
        ("numerator: [one]\ndenominator: [1, 1]\n", "not-a-quantity"),
        ("numerater: [1]\ndenominator: [1, 1]\n", "unknown-key"),
        ("- 1\n", "not-a-mapping"),
        ("[", "not-yaml"),
        ("#" * 200_000, "bad-target"),
    ],
)
def test_a_target_that_is_none_is_refused(text, code):
    """With a code, and the field at fault."""
    with pytest.raises(Unusable) as refused:
        read_target(text.encode(), "target.yaml")
    assert refused.value.code == code
