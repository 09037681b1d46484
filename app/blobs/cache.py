"""Blobs in S3 and a copy of those in use on this machine."""

from __future__ import annotations

import hashlib
import os
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from app.blobs.bucket import Bucket
from app.storage import PART, Blob, Storage
from ident.errors import Unusable

_IN_USE = 60  # s for which a blob that was asked for is not dropped: its reader has yet to open it


class CachedStorage(Storage):
    """A bucket behind a folder of at most `size` bytes, from which the blobs go that were not asked for longest."""

    def __init__(self, folder: Path, bucket: Bucket, size: int) -> None:
        super().__init__(folder)
        self.bucket, self.size = bucket, size

    def path(self, sha256: str) -> Path:
        """Where a copy of a blob lies, fetched and verified where there was none. Raises Unreachable, Unusable."""
        place = self._place(sha256)
        try:
            os.utime(place)
        except FileNotFoundError:
            self._fetch(sha256)
        return place

    def blobs(self) -> Iterator[Blob]:
        """Every blob of the bucket."""
        return self.bucket.blobs()

    def remove(self, sha256: str) -> None:
        """Remove a blob from the bucket and here."""
        self.bucket.remove(sha256)
        super().remove(sha256)

    def _move(self, file: str | Path, sha256: str) -> None:
        self.bucket.put(sha256, Path(file))
        super()._move(file, sha256)
        self._shrink()

    def _fetch(self, sha256: str) -> None:
        handle, temporary = tempfile.mkstemp(dir=self.folder, suffix=PART)
        try:
            with os.fdopen(handle, "w+b") as file:
                self.bucket.get(sha256, file)
                file.seek(0)
                found = hashlib.file_digest(file, "sha256").hexdigest()
            if found != sha256:
                raise Unusable("damaged-blob", f"its SHA-256 is {found[:12]}…", sha256, "restore it from a backup")
            super()._move(temporary, sha256)
        finally:
            Path(temporary).unlink(missing_ok=True)
        self._shrink()

    def _shrink(self) -> None:
        """Drop the copies that were not asked for longest until the rest has room."""
        copies = sorted(super().blobs(), key=lambda blob: blob.changed)
        excess = sum(blob.size for blob in copies) - self.size
        for blob in copies:
            if excess <= 0 or abs(time.time() - blob.changed) < _IN_USE:
                return
            self._place(blob.sha256).unlink(missing_ok=True)
            excess -= blob.size
