"""Generated source, compiled once and kept on disk.

A generated function is written to a file of a private cache folder, named by the hash of its text, and imported from
there: numba keeps machine code beside it, and a change of one equation is another file, never stale code.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

_watchers: list[Callable[[], None]] = []


@contextmanager
def watching(tell: Callable[[], None]) -> Iterator[None]:
    """Until the block ends, `tell` is called before each compilation: it takes seconds, once on a machine."""
    _watchers.append(tell)
    try:
        yield
    finally:
        _watchers.remove(tell)


@lru_cache
def cache_folder() -> Path:
    """A folder that only this user can read; where none can be made, one that lives as long as the process."""
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    try:
        folder = base / "servoident" / "kernels"
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if folder.stat().st_uid != os.getuid() or folder.stat().st_mode & 0o022:
            raise PermissionError(folder)
    except OSError:
        folder = Path(tempfile.mkdtemp(prefix="servoident-"))
    return folder


@lru_cache(maxsize=64)
def function(name: str, source: str) -> Callable[..., Any]:
    """The function `name` defined by a generated module `source`."""
    digest = hashlib.sha256(source.encode()).hexdigest()[:24]
    module_name = f"servoident_{name}_{digest}"
    path = cache_folder() / f"{module_name}.py"
    if not path.exists() or path.read_text() != source:
        handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
        with os.fdopen(handle, "w") as file:
            file.write(source)
        os.replace(temporary, path)  # whole or not at all, also with two processes at it
    spec = importlib.util.spec_from_file_location(module_name, path)
    if spec is None or spec.loader is None:
        raise ImportError(path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[module_name] = module
    spec.loader.exec_module(module)
    compiled: Callable[..., Any] = getattr(module, name)
    if not is_compiled(compiled):
        for tell in tuple(_watchers):
            tell()
    return compiled


def is_compiled(function: Any) -> bool:
    """Whether machine code of one of numba's functions is on disk; numba writes it on the first call."""
    place = function.stats.cache_path
    return place is not None and any(Path(place).glob(f"{function.__module__}.{function.__name__}-*.nbi"))
