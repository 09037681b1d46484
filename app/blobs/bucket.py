"""Blobs in S3, or in what speaks its protocol: each an object that is named by the SHA-256 of its content.

Keys, region and the address of another provider come from the environment, as everywhere: AWS_ACCESS_KEY_ID,
AWS_SECRET_ACCESS_KEY, AWS_REGION, AWS_ENDPOINT_URL.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from datetime import timedelta
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

from app.storage import Blob, Unreachable
from ident.errors import Unusable

SCHEME = "s3://"
_PATIENCE = timedelta(seconds=5)  # within a request; a job waits longer, see app/jobs/steps.py
_CHUNK = 1 << 20
_Answer = TypeVar("_Answer")


class Bucket:
    """A bucket, or what of it lies below a prefix."""

    def __init__(self, url: str) -> None:
        from obstore.store import S3Store  # noqa: PLC0415  only where it is asked for

        self.url = url
        patience: Any = {"max_retries": 3, "retry_timeout": _PATIENCE}
        options: Any = {"allow_http": True, "connect_timeout": "5s", "timeout": "600s"}
        try:
            self._store = S3Store.from_url(url, client_options=options, retry_config=patience)
        except Exception as error:
            what = str(error).partition("\n")[0]
            raise Unusable("bad-blobs", f"S3 cannot be used: {what}", url, "write s3://BUCKET/PREFIX") from None

    def __reduce__(self) -> tuple[Any, ...]:
        """As it passes from one process to another: each has connections of its own."""
        return Bucket, (self.url,)

    def put(self, sha256: str, file: Path) -> None:
        """Store a file, whole or not at all."""
        import obstore  # noqa: PLC0415

        self._asked(lambda: obstore.put(self._store, _key(sha256), file))

    def get(self, sha256: str, into: BinaryIO) -> None:
        """Write a blob. Raises FileNotFoundError where there is none."""
        import obstore  # noqa: PLC0415

        def copied() -> None:
            for chunk in obstore.get(self._store, _key(sha256)).stream(min_chunk_size=_CHUNK):
                into.write(chunk)

        self._asked(copied)

    def blobs(self) -> Iterator[Blob]:
        """Every blob."""
        import obstore  # noqa: PLC0415

        for page in self._asked(lambda: list(obstore.list(self._store))):
            for entry in page:
                yield Blob(str(entry["path"]).rpartition("/")[2], entry["size"], entry["last_modified"].timestamp())

    def remove(self, sha256: str) -> None:
        """Remove a blob."""
        import obstore  # noqa: PLC0415

        self._asked(lambda: obstore.delete(self._store, _key(sha256)))

    def _asked(self, act: Callable[[], _Answer]) -> _Answer:
        """What S3 answers. Raises Unreachable where it does not, or refuses."""
        from obstore.exceptions import BaseError  # noqa: PLC0415

        try:
            return act()
        except FileNotFoundError:
            raise
        except BaseError as error:
            raise Unreachable(f"{self.url} does not answer: {str(error).partition(chr(10))[0]}") from error


def _key(sha256: str) -> str:
    return f"{sha256[:2]}/{sha256}"
