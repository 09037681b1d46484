"""Generated source, compiled once and kept on disk.

A generated function is written to a file of a private cache folder, named by the hash of its text, and imported from
there: numba keeps machine code beside it, and a change of one equation is another file, never stale code.
"""

from __future__ import annotations

import hashlib
import importlib.util
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

from ident.simulation.cache import cache_folder, tidy_daily, used, write
from ident.simulation.jit import in_turns

_watchers: list[Callable[[], None]] = []


@contextmanager
def watching(tell: Callable[[], None]) -> Iterator[None]:
    """Until the block ends, `tell` is called before each compilation: it takes seconds, once on a machine."""
    _watchers.append(tell)
    try:
        yield
    finally:
        _watchers.remove(tell)


@lru_cache(maxsize=64)
def function(name: str, source: str) -> Callable[..., Any]:
    """The function `name` defined by a generated module `source`."""
    digest = hashlib.sha256(source.encode()).hexdigest()[:24]
    path = cache_folder() / f"servoident_{name}_{digest}.py"
    try:
        compiled = _loaded(name, path, source)
    except FileNotFoundError:  # another process made room at that moment
        compiled = _loaded(name, path, source)
    if not is_compiled(compiled):
        tidy_daily(path.parent)
        for tell in tuple(_watchers):
            tell()
    return compiled


def _loaded(name: str, path: Path, source: str) -> Callable[..., Any]:
    """The function from its file, which is written first where it is not there."""
    if not path.exists() or path.read_text(encoding="utf-8") != source:
        write(path, source.encode())
    used(path)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise ImportError(path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    compiled: Callable[..., Any] = in_turns(getattr(module, name), lambda: source)
    return compiled


def is_compiled(function: Any) -> bool:
    """Whether machine code of one of numba's functions is on disk; numba writes it on the first call."""
    place = function.stats.cache_path
    return place is not None and any(Path(place).glob(f"{function.__module__}.{function.__name__}-*.nbi"))
