"""Blobs in S3, with copies on this machine: against moto's server."""

from __future__ import annotations

import io
import os
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.blobs import open_storage
from app.blobs.cache import CachedStorage
from app.settings import Settings
from app.storage import Unreachable
from ident.errors import Unusable
from tests.running_s3 import S3, s3


@pytest.fixture(scope="module")
def bucket() -> Iterator[S3]:
    with s3() as server:
        yield server


def store(bucket: S3, folder: Path, monkeypatch: pytest.MonkeyPatch, size: int = 1 << 20) -> CachedStorage:
    for name, value in bucket.environment.items():
        monkeypatch.setenv(name, value)
    opened = open_storage(Settings(data=folder, blobs=bucket.url, cache_size=size))
    assert isinstance(opened, CachedStorage)
    return opened


def test_what_one_machine_stores_another_reads(bucket, tmp_path, monkeypatch):
    """Each has a folder of its own; a blob that is nowhere is missing."""
    one, other = (store(bucket, tmp_path / name, monkeypatch) for name in ("one", "other"))
    with one.staged() as staged:
        sha256 = staged.put(io.BytesIO(b"raw bytes"))
        assert sha256 not in {blob.sha256 for blob in other.blobs()}
        staged.keep()
    assert other.path(sha256).read_bytes() == b"raw bytes"
    assert sha256 in {blob.sha256 for blob in other.blobs()}
    other.remove(sha256)
    assert not list(one.blobs())
    with pytest.raises(FileNotFoundError):
        store(bucket, tmp_path / "third", monkeypatch).path(sha256)


def test_the_copies_stay_within_their_bound(bucket, tmp_path, monkeypatch):
    """The one that was not asked for longest goes; none that was asked for within the last minute."""
    here = store(bucket, tmp_path, monkeypatch, size=250)
    names = [here.put(io.BytesIO(bytes([number]) * 100)) for number in range(4)]
    places = [here.path(name) for name in names]
    assert all(place.exists() for place in places)
    for age, place in zip((400, 100, 300, 200), places, strict=True):
        os.utime(place, times=(time.time() - age,) * 2)
    here.put(io.BytesIO(b"5" * 40))
    assert [place.exists() for place in places] == [False, True, False, True]
    assert here.path(names[0]).read_bytes() == bytes(100)  # fetched again


def test_another_content_than_its_name_says_is_refused(bucket, tmp_path, monkeypatch):
    here = store(bucket, tmp_path, monkeypatch)
    wrong = "0" * 64
    (tmp_path / "file").write_bytes(b"something else")
    here.bucket.put(wrong, tmp_path / "file")
    with pytest.raises(Unusable, match="SHA-256") as refused:
        here.path(wrong)
    assert refused.value.code == "damaged-blob"
    assert not list((tmp_path / "cache").rglob("*.part"))


def test_a_refusing_s3_keeps_nothing_and_is_said(bucket, tmp_path, monkeypatch):
    here = store(bucket, tmp_path, monkeypatch)
    bucket.refuse(True)
    try:
        with pytest.raises(Unreachable):
            here.put(io.BytesIO(b"refused"))
    finally:
        bucket.refuse(False)
    assert not [path for path in (tmp_path / "cache").rglob("*") if path.is_file()]


@pytest.mark.parametrize("place", ["ftp://host/folder", "s3://"])
def test_another_place_is_refused(place, tmp_path):
    with pytest.raises(Unusable, match="s3://BUCKET/PREFIX"):
        open_storage(Settings(data=tmp_path, blobs=place))
