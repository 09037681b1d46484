"""A stored matrix as a source of files for the readers: raw blobs, and the description of the newest revision."""

from __future__ import annotations

from typing import Any

from app.lru import LRU
from app.matrices.removed import check_there
from app.storage import Storage
from app.tables import MatrixRow
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.readers import read_source
from ident.readers.archive import Archive
from ident.readers.limits import check_size
from ident.readers.source import DESCRIPTION, inside, read_regular

_MOST = 2  # matrices in memory: one may take 130 MB
_loaded: LRU[Matrix] = LRU(_MOST)


class Blobs:
    """Files by name, each a blob."""

    def __init__(self, storage: Storage, files: dict[str, str]) -> None:
        self.storage, self.files = storage, files

    def read(self, name: str, limit: int) -> bytes:
        """The bytes of a file."""
        sha256 = self.files.get(inside(name, name))
        if sha256 is None:
            raise Unusable("missing-file", "it was not uploaded", name, "add it or correct the name")
        return read_regular(self.storage.path(sha256), name, limit)


class Revised:
    """Another source with a description of its own."""

    def __init__(self, source: Archive | Blobs, description: bytes | None) -> None:
        self.source, self.description = source, description

    def read(self, name: str, limit: int) -> bytes:
        """The bytes of a file; the description is the revised one."""
        if name == DESCRIPTION and self.description is not None:
            check_size(len(self.description), limit, "the description", name)
            return self.description
        return self.source.read(name, limit)


def read_stored(storage: Storage, source: dict[str, Any]) -> Matrix:
    """The matrix of a record's `source`: {"zip": sha} or {"files": {name: sha}}, and "description": sha if revised."""
    with opened(storage, source) as files:
        return read_source(files)


def load_row(storage: Storage, row: MatrixRow) -> Matrix:
    """The samples of a recorded matrix, from memory where they were used lately. Raises Removed, Unusable."""
    check_there(row)
    return _loaded.get((str(storage.folder), row.id), lambda: read_stored(storage, row.source))


class opened:  # noqa: N801  used as a function in a with statement
    """The files of a stored source, closed at the end."""

    def __init__(self, storage: Storage, source: dict[str, Any]) -> None:
        self.storage, self.source = storage, source
        self.archive: Archive | None = None

    def __enter__(self) -> Revised:
        if "zip" in self.source:
            self.archive = Archive(self.storage.path(self.source["zip"]), "upload.zip")
        files = self.archive or Blobs(self.storage, self.source["files"])
        sha256 = self.source.get("description")
        text = self.storage.path(sha256).read_bytes() if sha256 else None
        return Revised(files, text)

    def __exit__(self, *_: object) -> None:
        if self.archive is not None:
            self.archive.close()
