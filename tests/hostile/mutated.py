"""Files of every kind that is read, as archives to upload, with bytes changed, cut, doubled or exchanged at random."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tests.app.conftest import archived
from tests.matrix_folder import WRITERS, MatrixFolder
from tests.readers.lab_files import BESIDE, DESCRIBED, FILES

DESCRIPTION, ARCHIVE = "matrix.yaml", "the archive"
SIGNS = np.frombuffer(b"{}[]:,&*!|>'\"#%@`-? \n\t\x00\xff0aZ9^/.", np.uint8)


def whole(folder: Path) -> dict[str, dict[str, bytes]]:
    """For each kind of file, the matrix that is unharmed: name → bytes."""
    found = {}
    for kind in WRITERS:
        path = MatrixFolder(folder / kind).write(kind)
        files = (file for file in sorted(path.rglob("*")) if file.is_file())
        found[kind] = {str(file.relative_to(path)): file.read_bytes() for file in files}
    for kind, (ending, made, (time, u, x)) in FILES.items():
        if not kind.startswith("mdf") or importlib.util.find_spec("asammdf"):
            described = DESCRIBED.format(ending=ending, time=time, u=u, x=x)
            found[f"lab {kind}"] = {DESCRIPTION: described.encode(), f"run{ending}": made(), **BESIDE.get(kind, {})}
    return found


def mutated(matrices: dict[str, dict[str, bytes]], count: int, seed: int) -> Iterator[tuple[str, bytes]]:
    """So many archives, each with what is harmed in it: of seven, five a run, one the description, one the archive."""
    draw, kinds = np.random.default_rng(seed), sorted(matrices)
    for number in range(count):
        kind = kinds[number % len(kinds)]
        files = dict(matrices[kind])
        name = (*[next(name for name in files if name != DESCRIPTION)] * 5, DESCRIPTION, ARCHIVE)[number % 7]
        if name == ARCHIVE:
            yield f"{kind}: {name}", harmed(archived(files), draw)
        else:
            files[name] = harmed(files[name], draw, SIGNS if name == DESCRIPTION else None)
            yield f"{kind}: {name}", archived(files)


def harmed(content: bytes, draw: np.random.Generator, signs: np.ndarray | None = None) -> bytes:
    """Some bytes changed; one in five cut short, one in ten with a piece of it twice, one in ten with two exchanged."""
    left = np.frombuffer(content, np.uint8).copy()
    end = int(draw.choice([len(left), min(600, len(left))]))  # headers are where it hurts
    places = draw.integers(0, end, draw.integers(1, 6))
    left[places] = draw.choice(draw.integers(0, 256, 12) if signs is None else signs, len(places))
    how, (first, second) = draw.random(), np.sort(draw.integers(0, len(left), 2))
    if how < 0.2:
        return left[: max(1, first)].tobytes()
    if how < 0.3:
        return np.concatenate([left[:second], left[first:]]).tobytes()
    return np.concatenate([left[first:], left[:first]]).tobytes() if how < 0.4 else left.tobytes()
