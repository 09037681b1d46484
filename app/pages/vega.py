"""Vega for the page, served by the program itself: one bundle, made once from what draws the other formats."""

from __future__ import annotations

from functools import lru_cache
from hashlib import sha256
from importlib.metadata import version as distribution

import vl_convert

_SNIPPET = "globalThis.vegaEmbed = vegaEmbed;"


@lru_cache(maxsize=1)
def bundle() -> bytes:
    """The ES module that puts `vegaEmbed` in place; takes some seconds the first time."""
    return str(vl_convert.javascript_bundle(_SNIPPET)).encode()


def version() -> str:
    """Changes with the bundle, so that a browser may keep it for ever under this name."""
    return sha256(f"{distribution('vl-convert-python')} {_SNIPPET}".encode()).hexdigest()[:12]
