"""Levels of the signals of a large matrix, stored as a blob: a plot reads the levels, not the files."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from tempfile import TemporaryFile
from typing import Any, cast

from app.context import Context
from app.lru import LRU
from app.matrices.removed import check_there
from app.matrices.stored import read_stored
from app.storage import Storage
from app.tables import MatrixRow
from ident.decimation.levels import Levels, write_levels
from ident.matrix import Matrix
from ident.run import Run, Samples, Specimen

LARGE = 1 << 21
"""Samples of a matrix, all channels together, from which on levels are stored: fewer are read within a blink."""
KEY = "levels"
"""Names the blob in the source of a matrix."""
_MOST = 8  # heads of levels in memory
_opened: LRU[Levels] = LRU(_MOST)


def is_large(runs: list[dict[str, Any]]) -> bool:
    """Whether the runs of a summary have so many samples that levels are worth their room."""
    return bool(sum(run["samples"] * len(run["channels"]) for run in runs) >= LARGE)


def stored_levels(matrix: Matrix, storage: Storage) -> str:
    """Put the levels of a matrix into a store; the name of the blob."""
    with TemporaryFile() as file:
        write_levels(matrix.runs, file)
        file.seek(0)
        return storage.put(file)


def levelled(context: Context, row: MatrixRow, in_reader: Callable[..., str]) -> tuple[list[Run], Levels] | None:
    """The runs of a large matrix and their levels, which are made where they are not there yet; None of a small one.

    `in_reader` calls what makes them where uploads are read. Raises Removed, Unusable.
    """
    check_there(row)
    if not is_large(row.summary["runs"]):
        return None
    if KEY not in row.source:
        sha256 = in_reader(context, made, context.storage, row.source)
        with context.sessions() as session:
            row = session.merge(row)
            row.source = {**row.source, KEY: sha256}
            session.commit()
    path = context.storage.path(row.source[KEY])
    levels = _opened.get(str(path), lambda: Levels(path))
    return [_shell(run, levels) for run in row.summary["runs"]], levels


def made(storage: Storage, source: dict[str, Any]) -> str:
    """The levels of a recorded matrix, put into its store; the name of the blob."""
    return stored_levels(read_stored(storage, source), storage)


class _Channels(Mapping[str, Samples]):
    """The channels of a run, each read when it is asked for."""

    def __init__(self, run: str, names: list[str], levels: Levels) -> None:
        self._run, self._names, self._levels = run, names, levels

    def __getitem__(self, name: str) -> Samples:
        if name not in self._names:
            raise KeyError(name)
        return self._levels.samples(self._run, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


def _shell(run: dict[str, Any], levels: Levels) -> Run:
    """A run by its summary, whose samples are read from the levels when they are asked for."""
    specimen = cast("tuple[float, float, float]", tuple(run[key] for key in ("mass", "stiffness", "damping")))
    return Run(
        run["id"], "", run["sample_rate"], _Channels(run["id"], run["channels"], levels), run["units"],
        run["time_unit"], None if None in specimen else Specimen(*specimen), run["gain"], run["amplitude"],
        run["kind"], run["hold"], run["output"], run["use"],
    )  # fmt: skip
