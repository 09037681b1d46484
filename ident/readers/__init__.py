"""A folder or an archive in, a :class:`ident.matrix.Matrix` in SI out."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from importlib import import_module
from pathlib import Path, PurePosixPath

from ident.errors import Unusable
from ident.matrix import Matrix, Run
from ident.readers.archive import Archive
from ident.readers.description import Description, describe
from ident.readers.limits import LIMITS, Limits, check_size
from ident.readers.run import read_run
from ident.readers.run_description import RunDescription
from ident.readers.source import DESCRIPTION, Folder, Source
from ident.readers.table import Table
from ident.readers.text import read_text

Reader = Callable[[bytes, str, Limits], Table]

BINARY = {
    ".parquet": "parquet",
    ".npz": "npz",
    ".mat": "mat",
    ".h5": "hdf5",
    ".hdf5": "hdf5",
    ".tdms": "tdms",
}
"""Endings of names, each with the file that reads what ends so: `read_npz` in npz.py and the like."""
TEXT = (".csv", ".tsv", ".txt")


def read_matrix(path: Path, limits: Limits = LIMITS) -> Matrix:
    """The matrix in a folder, beside its matrix.yaml, or in a .zip, nothing being unpacked to disk.

    Raises Unusable for everything that is wrong with it; docs/matrix-format.md lists the codes.
    """
    path = Path(path)
    if path.is_dir():
        return read_source(Folder(path, limits), limits)
    if path.name == DESCRIPTION:
        return read_source(Folder(path.parent, limits), limits)
    archive = Archive(path, path.name, limits)
    try:
        return read_source(archive, limits)
    finally:
        archive.close()


def read_source(source: Source, limits: Limits = LIMITS) -> Matrix:
    """The matrix that any :class:`ident.readers.source.Source` holds. Raises Unusable."""
    text = source.read(DESCRIPTION, limits.description)
    described = describe(text, limits)
    runs, notices, digest = read_runs(source, described, text, limits)
    stated = "" if described.limits is None else limits_text(source, described.limits, limits)
    return Matrix(
        described.actuator, runs, digest, described.controller, described.limits, stated, notices, described.machine
    )


def limits_text(source: Source, name: str, limits: Limits) -> str:
    """The limits file that is named, which must be there. Raises Unusable."""
    try:
        return source.read(name, limits.description).decode("utf-8")
    except UnicodeDecodeError:
        raise Unusable("not-text", "the limits file is no text in UTF-8", name, "write it as YAML") from None


def read_runs(
    source: Source, described: Description, text: bytes, limits: Limits
) -> tuple[tuple[Run, ...], tuple[str, ...], str]:
    """Every run, what reading assumed, and the SHA-256 of matrix.yaml and each run file in order of first mention."""
    digest = hashlib.sha256(text)
    runs: dict[int, Run] = {}
    notices: list[str] = []
    read, held = 0, 0
    for name, wanted in by_file(described.runs).items():
        data = source.read(name, limits.file)
        digest.update(data)
        read += len(data)
        check_size(read, limits.total, "all run files together", name)
        tables: dict[int, Table] = {}
        for number, run in wanted:
            if run.skip_rows not in tables:
                tables[run.skip_rows] = read_table(data, name, run, limits)
                notices.extend(tables[run.skip_rows].notices)
            runs[number] = read_run(run, tables[run.skip_rows])
            held += sum(samples.nbytes for samples in runs[number].channels.values())
            check_size(held, limits.samples, "all samples together", name)
    outputs = (run for number in sorted(runs) for run in runs[number].of_outputs(described.runs[number].outputs))
    return tuple(outputs), tuple(notices), digest.hexdigest()


def by_file(runs: tuple[RunDescription, ...]) -> dict[str, list[tuple[int, RunDescription]]]:
    """The runs of each file, so that a file is read and hashed once."""
    files: dict[str, list[tuple[int, RunDescription]]] = {}
    for number, run in enumerate(runs):
        files.setdefault(run.labels.file, []).append((number, run))
    return files


def read_table(data: bytes, name: str, run: RunDescription, limits: Limits) -> Table:
    """The table of a file by the ending of its name. Raises Unusable: ``unknown-type``, ``empty-file``."""
    ending = PurePosixPath(name).suffix.lower()
    if ending not in (*BINARY, *TEXT):
        remedy = "use one of " + ", ".join((*TEXT, *BINARY))
        raise Unusable("unknown-type", f"files ending in {ending or 'nothing'!r} cannot be read", name, remedy)
    if not data:
        raise Unusable("empty-file", "the file is empty", name, "give a record")
    if ending in TEXT:
        return read_text(data, name, limits, run.skip_rows)
    if run.skip_rows:
        raise Unusable("bad-rows", "skip_rows is for text files", f"run {run.labels.id} skip_rows", "use rows")
    kind = BINARY[ending]
    read: Reader = getattr(import_module(f"ident.readers.{kind}"), f"read_{kind}")
    return read(data, name, limits)
