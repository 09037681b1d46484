"""Raw uploads, byte for byte, each file named by the SHA-256 of its content."""

from __future__ import annotations

import hashlib
import os
import re
import secrets
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

_CHUNK = 1 << 20
PART = ".part"  # end of the names of files that are being written
_STAGED = "staged-"  # beginning of the names of folders that wait for a verdict
_FORGOTTEN = 86_400  # s after which such a folder belongs to a process that was killed


class Unreachable(OSError):
    """The store of blobs does not answer; it may the next moment."""


@dataclass(frozen=True)
class Blob:
    """A stored blob: its name, its bytes, and when it was stored, in seconds since 1970."""

    sha256: str
    size: int
    changed: float


class Storage:
    """A folder of blobs. A blob is there whole or not at all."""

    def __init__(self, folder: Path, behind: Storage | None = None) -> None:
        self.folder, self.behind = folder, behind
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)

    @contextmanager
    def staged(self) -> Iterator[Storage]:
        """A store in front of this one; at the end its blobs are gone, but for those that were kept."""
        with tempfile.TemporaryDirectory(dir=self.folder, prefix=_STAGED) as folder:
            yield Storage(Path(folder), self)

    def begun(self) -> tuple[str, Storage]:
        """A store in front of this one that stays until it is resumed by its name and taken away, or forgotten."""
        name = secrets.token_hex(16)
        return name, Storage(self.folder / f"{_STAGED}{name}", self)

    def resumed(self, name: str) -> Storage | None:
        """The store that was begun under a name; None where there is none."""
        folder = self.folder / f"{_STAGED}{name}"
        return Storage(folder, self) if re.fullmatch("[0-9a-f]{32}", name) and folder.is_dir() else None

    def put(self, content: BinaryIO) -> str:
        """Store a stream and return its SHA-256. Raises OSError where the disk is full; then nothing is left."""
        digest = hashlib.sha256()
        handle, temporary = tempfile.mkstemp(dir=self.folder, suffix=PART)
        try:
            with os.fdopen(handle, "wb") as file:
                while chunk := content.read(_CHUNK):
                    digest.update(chunk)
                    file.write(chunk)
                file.flush()
                os.fsync(file.fileno())
            self._move(temporary, digest.hexdigest())
        except BaseException:
            Path(temporary).unlink(missing_ok=True)
            raise
        return digest.hexdigest()

    def keep(self) -> None:
        """Move every blob of a staged store to the one behind it."""
        assert self.behind is not None
        for blob in self.folder.glob("*/*"):
            self.behind._move(blob, blob.name)

    def path(self, sha256: str) -> Path:
        """Where a blob lies."""
        own = self._place(sha256)
        return own if self.behind is None or own.exists() else self.behind.path(sha256)

    def blobs(self) -> Iterator[Blob]:
        """Every blob."""
        for file in self.folder.glob("[0-9a-f][0-9a-f]/*"):
            with suppress(FileNotFoundError):  # another has removed it
                status = file.stat()
                yield Blob(file.name, status.st_size, status.st_mtime)

    def remove(self, sha256: str) -> None:
        """Remove a blob."""
        self._place(sha256).unlink(missing_ok=True)

    def tidy(self) -> None:
        """Remove what processes that were killed in the middle of an upload have left, and what nobody came back to."""
        for left in (*self.folder.glob(f"{_STAGED}*"), *self.folder.glob(f"*{PART}")):
            with suppress(FileNotFoundError):  # another tidies too
                if time.time() - left.stat().st_mtime > _FORGOTTEN:
                    shutil.rmtree(left, ignore_errors=True) if left.is_dir() else left.unlink()

    def _place(self, sha256: str) -> Path:
        return self.folder / sha256[:2] / sha256

    def _move(self, file: str | Path, sha256: str) -> None:
        target = self._place(sha256)
        target.parent.mkdir(mode=0o700, exist_ok=True)
        try:
            os.replace(file, target)
        except PermissionError:  # Windows, while somebody reads the same blob
            if not target.exists():
                raise
            os.unlink(file)
