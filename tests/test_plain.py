"""Dataclasses as plain JSON data: what a field holds that is written where it is known."""

from __future__ import annotations

import json
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
