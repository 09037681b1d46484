"""Blobs that no record names: of an upload whose process was killed before it was recorded."""

from __future__ import annotations

import time

from app.backup.service import named
from app.blobs import open_storage
from app.settings import Settings
from app.storage import Blob


def unused(settings: Settings, age: float) -> list[Blob]:
    """Blobs older than `age` (s) that no record names; a younger one may belong to an upload that is under way."""
    stored = [blob for blob in open_storage(settings).blobs() if time.time() - blob.changed >= age]
    wanted = named(settings) if stored else set()
    return [blob for blob in stored if blob.sha256 not in wanted]


def remove(settings: Settings, blobs: list[Blob]) -> None:
    """Remove blobs."""
    storage = open_storage(settings)
    for blob in blobs:
        storage.remove(blob.sha256)
