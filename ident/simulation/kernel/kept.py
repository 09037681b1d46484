"""Machine code on disk: a text that was compiled once is not compiled again, by any process of this user.

A file of the private cache folder is named by the hash of the text and of all that decides what becomes of it, and says
the hash of what it holds: a change of one equation is another file, and what was cut off or changed counts as absent.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path

from ident.simulation.cache import cache_folder, tidy, used, write

_MARK = hashlib.sha256().digest_size  # bytes before the code: its hash


def kept(text: str, compiled: Callable[[], bytes]) -> bytes:
    """The machine code of a text: what is on disk, or what `compiled` makes, which is then kept there if it can be."""
    path = cache_folder() / f"servoident_lines_{hashlib.sha256(text.encode()).hexdigest()[:32]}.o"
    found = _read(path)
    if found is not None:
        return found
    code = compiled()
    with suppress(OSError):  # a full disk, or a folder that may only be read: it is compiled the next time again
        write(path, hashlib.sha256(code).digest() + code)
        _tidied(path.parent)
    return code


def _read(path: Path) -> bytes | None:
    try:
        content = path.read_bytes()
    except OSError:
        return None
    code = content[_MARK:]
    if not code or hashlib.sha256(code).digest() != content[:_MARK]:
        return None
    used(path)
    return code


@cache
def _tidied(folder: Path) -> None:
    """The folder is looked through once by each process that adds to it."""
    tidy(folder)
