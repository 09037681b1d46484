"""Where raw uploads lie: in a folder, which several machines may share, or in S3 with a cache on each machine."""

from app.blobs.place import open_storage

__all__ = ["open_storage"]
