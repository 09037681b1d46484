"""Dataclasses as plain JSON data: what a field holds that is written where it is known."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from ident.plain import WHERE_KNOWN, read, written


@dataclass(frozen=True)
class Known:
    """A field that is left out where nothing is known."""

    entry: Any = field(default=None, metadata=WHERE_KNOWN)


@pytest.mark.parametrize("entry", [None, False, "", (), {}])
def test_what_holds_nothing_is_left_out(entry):
    assert written(Known(entry)) == {}


@pytest.mark.parametrize("entry", [0.5, np.float64(0.5), np.float64(0.0), 0.0, 0, "text", True])
def test_what_is_known_is_written_numbers_of_numpy_too(entry):
    data = json.loads(json.dumps(written(Known(entry))))
    assert data == {"entry": entry}
    assert read(Known, data) == Known(entry)


@dataclass(frozen=True)
class Judged:
    """An error that is infinite where a model is unstable, and one by use."""

    error: float | None
    by_use: Mapping[str, float | None]


def test_what_is_no_finite_number_is_written_as_not_known():
    """JSON has none of them, and a result is not lost for one."""
    data = written(Judged(math.inf, {"held_out": math.nan, "fit": 0.1}))
    assert data == {"error": None, "by_use": {"held_out": None, "fit": 0.1}}
    assert read(Judged, json.loads(json.dumps(data, allow_nan=False))) == Judged(None, {"held_out": None, "fit": 0.1})
