"""The store of blobs that the settings name."""

from __future__ import annotations

from pathlib import Path

from app.blobs.bucket import SCHEME, Bucket
from app.blobs.cache import CachedStorage
from app.settings import Settings
from app.storage import Storage
from ident.errors import Unusable


def open_storage(settings: Settings) -> Storage:
    """A folder, by default one in the data folder; or S3, with a cache in the data folder.

    Raises Unusable for the address of anything else.
    """
    place = settings.blobs
    if place.startswith(SCHEME):
        return CachedStorage(settings.data / "cache", Bucket(place), settings.cache_size)
    if "://" in place:
        raise Unusable("bad-blobs", "neither a folder nor S3", "--blobs", "write s3://BUCKET/PREFIX, or name a folder")
    return Storage(Path(place) if place else settings.data / "blobs")
