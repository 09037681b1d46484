"""Vega for the page, served by the program itself: one bundle, made once for a user from what draws other formats."""

from __future__ import annotations

from contextlib import suppress
from functools import lru_cache
from hashlib import sha256
from importlib.metadata import version as distribution

import vl_convert

from ident.simulation.cache import cache_folder, write

_SNIPPET = "globalThis.vegaEmbed = vegaEmbed;"


@lru_cache(maxsize=1)
def bundle() -> bytes:
    """The ES module that puts `vegaEmbed` in place; to make it takes seconds, so it is kept beside the kernels."""
    kept = cache_folder() / f"vega-{version()}.js"
    with suppress(OSError):
        return kept.read_bytes()
    made = str(vl_convert.javascript_bundle(_SNIPPET)).encode()
    with suppress(OSError):  # a cache that may only be read
        write(kept, made)
    return made


def version() -> str:
    """Changes with the bundle, so that a browser may keep it for ever under this name."""
    return sha256(f"{distribution('vl-convert-python')} {_SNIPPET}".encode()).hexdigest()[:12]
