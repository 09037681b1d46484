"""Long arrays travel as texts, to the last bit."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

from app.jobs.stored_state import packed, unpacked

TABLE = np.random.default_rng(3).standard_normal((40, 6)).tolist()


@pytest.mark.parametrize(
    "value",
    [
        {"population": TABLE, "history": [{"population": TABLE, "errors": [row[0] for row in TABLE]}] * 3},
        {"best": None, "rng": {"state": 2**100, "name": "PCG64"}, "done": False, "few": [0.1, 0.2]},
        {"whole numbers": list(range(100)), "mixed": [*range(50), 0.5], "empty": [], "of empty": [[], []]},
        {"ragged": [[0.5] * 30, [0.5] * 29], "deep": [TABLE, TABLE], "extremes": [5e-324, -0.0, math.inf, 1e308] * 20},
    ],
    ids=["a search", "short", "no arrays", "odd"],
)
def test_what_is_packed_is_the_same_again(value: dict[str, Any]) -> None:
    sent = json.loads(json.dumps(packed(value)))
    assert json.dumps(unpacked(sent)) == json.dumps(value)
    assert unpacked(value) == value  # what an earlier version sent


def test_a_table_is_a_text_shorter_than_its_decimals() -> None:
    sent = packed({"population": TABLE})
    assert sent["population"]["shape"] == [40, 6]
    assert len(json.dumps(sent)) < 0.6 * len(json.dumps({"population": TABLE}))
