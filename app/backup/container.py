"""The file of a backup: a zip that holds each table as lines of JSON, each blob, a list of what there is, and hashes.

The list says the SHA-256 of each table; a blob is named by its own; the last 64 bytes of the file, a comment to other
programs, are the SHA-256 of all before them. So any changed byte is noticed, and where it lies is said.
"""

from __future__ import annotations

import hashlib
import json
import zipfile
import zlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO, Any

from ident.errors import Unusable

_CHUNK = 1 << 20
_LIST, _END = "list.json", 64
_BROKEN = (zipfile.BadZipFile, zlib.error, OSError, EOFError, ValueError, NotImplementedError, RuntimeError)


class Writer:
    """Writes a backup; `close` completes it."""

    def __init__(self, file: Path) -> None:
        self.file, self.tables, self.blobs = file, {}, []  # type: ignore[var-annotated]
        self._zip = zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=1)

    def table(self, name: str, lines: Iterable[bytes]) -> None:
        """A table."""
        digest, count = hashlib.sha256(), 0
        with self._zip.open(f"records/{name}.jsonl", "w", force_zip64=True) as entry:
            for line in lines:
                digest.update(line)
                entry.write(line)
                count += 1
        self.tables[name] = {"rows": count, "sha256": digest.hexdigest()}

    def blob(self, sha256: str, file: Path) -> None:
        """A blob, as it is: most are packed. Raises Unusable where it is not what its name says."""
        digest = hashlib.sha256()
        info = zipfile.ZipInfo(f"blobs/{sha256}")
        with file.open("rb") as content, self._zip.open(info, "w", force_zip64=True) as entry:
            while chunk := content.read(_CHUNK):
                digest.update(chunk)
                entry.write(chunk)
        if digest.hexdigest() != sha256:
            raise Unusable("damaged-blob", "its content has changed", str(file), "restore it from an older backup")
        self.blobs.append(sha256)

    def close(self, **others: Any) -> None:
        """List what there is, and seal it."""
        listed = {**others, "tables": self.tables, "blobs": self.blobs}
        self._zip.writestr(_LIST, json.dumps(listed))
        self._zip.comment = b"0" * _END
        self._zip.close()
        seal = _digest(self.file)
        with self.file.open("r+b") as file:
            file.seek(-_END, 2)
            file.write(seal.encode())


class Reader:
    """Reads a backup. Raises Unusable that names what is damaged, before anything is taken from it."""

    def __init__(self, file: Path) -> None:
        self.file = file
        with file.open("rb") as content:
            content.seek(max(-_END, -file.stat().st_size), 2)
            sound = content.read() == _digest(file).encode()
        try:
            self._zip = zipfile.ZipFile(file)
            self.listed: dict[str, Any] = json.loads(self._zip.read(_LIST))
        except (*_BROKEN, KeyError):
            raise self._damaged("its list of contents, or its end") from None
        if not sound:
            raise self._damaged(next(self._changed(), "its frame, between the parts"))

    def lines(self, table: str) -> Iterator[bytes]:
        """The rows of a table."""
        with self._zip.open(f"records/{table}.jsonl") as entry:
            yield from entry

    def blob(self, sha256: str) -> IO[bytes]:
        """A blob."""
        return self._zip.open(f"blobs/{sha256}")

    def _changed(self) -> Iterator[str]:
        """Each part whose hash is another than the list says."""
        tables = self.listed["tables"].items()
        parts = [(f"the table {name}", f"records/{name}.jsonl", each["sha256"]) for name, each in tables]
        for name, entry, sha256 in [*parts, *((f"the blob {s}", f"blobs/{s}", s) for s in self.listed["blobs"])]:
            try:
                with self._zip.open(entry) as content:
                    found = hashlib.file_digest(content, "sha256").hexdigest()  # type: ignore[arg-type]
            except (*_BROKEN, KeyError):
                found = ""
            if found != sha256:
                yield name

    def _damaged(self, what: str) -> Unusable:
        return Unusable("damaged-backup", f"damaged: {what}", str(self.file), "take another backup")


def _digest(file: Path) -> str:
    """The SHA-256 of all but the last bytes, which hold it."""
    digest, left = hashlib.sha256(), file.stat().st_size - _END
    with file.open("rb") as content:
        while left > 0 and (chunk := content.read(min(_CHUNK, left))):
            digest.update(chunk)
            left -= len(chunk)
    return digest.hexdigest()
