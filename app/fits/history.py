"""The history of a fit's search, kept once beside the fit and compact; only its figure and its own page read it."""

from __future__ import annotations

import json
import zlib
from typing import Any


def packed(evolution: list[Any]) -> bytes:
    """The generations as compressed JSON."""
    return zlib.compress(json.dumps(evolution, separators=(",", ":")).encode(), 9)


def unpacked(content: bytes) -> list[Any]:
    """The generations again, as they were."""
    found: list[Any] = json.loads(zlib.decompress(content))
    return found
