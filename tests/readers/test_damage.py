"""Damaged files are refused in words or read; nothing else may come out of a reader."""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.limits import Limits

LIMITS = Limits(file=1 << 26, channel=1 << 24, total=1 << 26, samples=1 << 26)


def refused_or_read(path) -> bool:
    """True where the matrix was refused."""
    try:
        run = read_matrix(path, LIMITS).runs[0]
    except Unusable as error:
        refused = error
    else:
        assert np.isfinite(run.measured).all()
        return False
    assert "\n" not in str(refused)
    assert all((refused.code, refused.what, refused.where, refused.remedy))
    return True


def test_a_binary_file_that_was_cut_short_anywhere_is_refused(matrix, kind, full):
    if kind in ("csv", "tsv", "txt"):
        pytest.skip("a text that ends early is a shorter text")
    run = next((matrix.write(kind) / "runs").iterdir())
    whole = run.read_bytes()
    for keep in np.linspace(0, len(whole) - 1, 60 if full else 20).astype(int):
        run.write_bytes(whole[:keep])
        assert refused_or_read(matrix.path), f"cut to {keep} of {len(whole)} bytes"


def test_a_file_with_bytes_changed_at_random_is_refused_or_read(matrix, kind, full):
    run = next((matrix.write(kind) / "runs").iterdir())
    whole = np.frombuffer(run.read_bytes(), np.uint8)
    random = np.random.default_rng(3)
    for _ in range(3000 if full else 50):
        damaged = whole.copy()
        ends = random.choice([len(whole), min(600, len(whole))])  # headers are where it hurts
        places = random.integers(0, ends, random.integers(1, 6))
        damaged[places] = random.choice([0, 255, 127, 128, *random.integers(0, 256, 8)], len(places))
        if random.random() < 0.2:
            damaged = damaged[: random.integers(1, len(whole))]
        run.write_bytes(damaged.tobytes())
        refused_or_read(matrix.path)


def test_an_archive_with_bytes_changed_at_random_is_refused_or_read(matrix, full):
    matrix.write()
    archive = matrix.pack()
    whole = np.frombuffer(archive.read_bytes(), np.uint8)
    random = np.random.default_rng(4)
    for _ in range(3000 if full else 100):
        damaged = whole.copy()
        places = random.integers(0, len(whole), random.integers(1, 5))
        damaged[places] = random.integers(0, 256, len(places))
        archive.write_bytes(damaged[: random.integers(1, len(whole)) if random.random() < 0.2 else None].tobytes())
        refused_or_read(archive)


def test_a_description_with_characters_changed_at_random_is_refused_or_read(matrix, full):
    path = matrix.write()
    whole = (path / "matrix.yaml").read_bytes()
    random = np.random.default_rng(5)
    signs = b"{}[]:,&*!|>'\"#%@`-? \n\t\x00\xff0aZ9^/."
    for _ in range(5000 if full else 150):
        damaged = bytearray(whole)
        for place in random.integers(0, len(whole), random.integers(1, 5)):
            damaged[place] = signs[random.integers(len(signs))]
        (path / "matrix.yaml").write_bytes(bytes(damaged))
        refused_or_read(path)
