"""Results to a file or to standard output, whole or not at all."""

from __future__ import annotations

import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

from ident.errors import Unusable

STANDARD_OUTPUT = Path("-")


def check_target(target: Path | None) -> None:
    """Raise Unusable where the folder of an output file does not exist: before the work, not after it."""
    if target is not None and not target.parent.is_dir():
        raise Unusable("no-such-folder", "the folder does not exist", str(target.parent), "create it, or name another")


def write_json(data: Any, target: Path) -> None:
    """Write `data` as JSON (no NaN) to `target`, or to standard output where that is ``-``."""
    text = json.dumps(data, indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    if target == STANDARD_OUTPUT:
        sys.stdout.write(text)
    else:
        write_bytes(text.encode(), target)


def write_bytes(data: bytes, target: Path) -> None:
    """Write `data` to `target`; a regular file appears whole or not at all. Raises OSError that names `target`."""
    try:
        if target.exists() and not target.is_file():  # a device or a pipe, which nothing may replace
            target.write_bytes(data)
        else:
            replace(data, target)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(target)) from error


def replace(data: bytes, target: Path) -> None:
    """Write a file beside `target` and move it there, so that no reader ever sees half of it."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}-")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(name).chmod(0o666 & ~umask())
        Path(name).replace(target)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def umask() -> int:
    """The permissions that this process withholds from new files."""
    current = os.umask(0)
    os.umask(current)
    return current
