"""Where the files of a matrix come from: a folder here, an archive in :mod:`ident.readers.archive`."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from pathlib import Path, PurePosixPath
from shlex import quote
from typing import Protocol

from ident.errors import Unusable
from ident.readers.limits import LIMITS, Limits, check_size

DESCRIPTION = "matrix.yaml"


class Source(Protocol):
    """Named files. Names are relative, with ``/``, and have passed :func:`inside`."""

    def read(self, name: str, limit: int) -> bytes:
        """The bytes of a file. Raises Unusable: ``missing-file``, ``too-large``, and what the source adds."""
        ...


Beside = Callable[[str], bytes]
"""Gives the bytes of a file that a record names as beside itself. Raises Unusable."""


def alone(name: str) -> bytes:
    """For a record that comes by itself. Raises Unusable: ``missing-file``."""
    what = "the samples are in this second file, which was not given"
    raise Unusable("missing-file", what, name, "give both files in a folder or a .zip with a matrix.yaml")


def beside(source: Source, record: str, limits: Limits, parts: list[bytes]) -> Beside:
    """The files beside a record, as they are named or in small or capital letters; `parts` gets what is read."""
    folder = PurePosixPath(record).parent

    def read(name: str) -> bytes:
        for like in (name.lower(), name.upper(), name):
            try:
                parts.append(source.read(str(folder / inside(like, record)), limits.file))
            except Unusable as error:
                if error.code == "missing-file" and like != name:
                    continue
                raise
            break
        check_size(sum(map(len, parts)), limits.total, "the record together with its other files", record)
        return parts[-1]

    return read


def inside(name: str, where: str) -> str:
    """A relative file name that stays in the matrix, as it is. Raises Unusable: ``outside-folder``."""
    parts = PurePosixPath(name).parts
    drive = len(name) > 1 and name[1] == ":"
    if not parts or name.startswith("/") or ".." in parts or "\\" in name or drive or not name.isprintable():
        raise Unusable(
            "outside-folder", f"{name!r} does not stay in the matrix folder", where, "give a path below it, with /"
        )
    return str(PurePosixPath(name))


class Folder:
    """A matrix folder on disk."""

    def __init__(self, folder: Path, limits: Limits = LIMITS) -> None:
        self.folder, self.limits = folder, limits

    def read(self, name: str, limit: int) -> bytes:
        """The bytes of a file; no part of its path may be a symbolic link (``symbolic-link``)."""
        path = self.folder
        for part in PurePosixPath(inside(name, name)).parts:
            path = path / part
            if path.is_symlink():
                raise Unusable("symbolic-link", f"{part!r} is a symbolic link", name, "put the file itself there")
        if not path.exists():
            remedy = f"add it, or correct the name in {DESCRIPTION}"
            if name == DESCRIPTION:
                remedy = f"write one with `servoident init {quote(str(self.folder))}`, or name a folder that has one"
            raise Unusable("missing-file", "there is no such file", name, remedy)
        return read_regular(path, name, limit)


def read_regular(path: Path, name: str, limit: int) -> bytes:
    """The bytes of a regular file, which is not a link, a pipe or a device. Raises Unusable."""
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    try:
        with os.fdopen(os.open(path, flags), "rb") as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise Unusable("not-a-file", "it is not a regular file", name, "put a file there")
            check_size(status.st_size, limit, "the file", name)
            return file.read(status.st_size)  # of what there is: a larger number would be allocated
    except FileNotFoundError:
        raise Unusable("missing-file", "there is no such file", name, "add it or correct the name") from None
    except OSError as error:
        reason = error.strerror or "it cannot be opened"
        raise Unusable("unreadable-file", reason, name, "make it a readable file") from None
