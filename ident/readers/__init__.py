"""A folder or an archive in, a :class:`ident.matrix.Matrix` in SI out."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path, PurePosixPath
from typing import Unpack

from ident.errors import Unusable
from ident.matrix import Matrix
from ident.readers.archive import Archive
from ident.readers.controldesk import read_controldesk
from ident.readers.dat import read_dat
from ident.readers.description import Description, describe
from ident.readers.dialect import FOUND, Dialect
from ident.readers.gzipped import unpacked
from ident.readers.hold import with_hold
from ident.readers.limits import LIMITS, Limits, check_size
from ident.readers.record_without_description import from_arrays, from_table, of_file
from ident.readers.rig import rig_in
from ident.readers.run import read_run
from ident.readers.run_description import RunDescription
from ident.readers.sandboxed_parser import read_sandboxed
from ident.readers.source import DESCRIPTION, Beside, Folder, Source, alone, beside
from ident.readers.table import Table
from ident.readers.text import read_text
from ident.run import Run
from ident.words.arguments import of_kind
from ident.words.number import count
from ident.words.record_description import Stated
from ident.words.run_name import run_name

__all__ = ["Limits", "from_arrays", "from_table", "read_matrix", "read_source"]

Reader = Callable[[bytes, str, Limits], Table]

BINARY = {
    ".parquet": "parquet",
    ".npz": "npz",
    ".mat": "mat",
    ".h5": "hdf5",
    ".hdf5": "hdf5",
    ".tdms": "tdms",
    ".lvm": "lvm",
    ".dat": "dat",
}
"""Endings of names, each with the file that reads what ends so: `read_npz` in npz.py and the like."""
FOREIGN = {".uff": "uff", ".unv": "uff", ".xlsx": "excel", ".json": "records", ".mf4": "mdf", ".mdf": "mdf"}
"""Endings of names, each with the parser of :mod:`ident.foreign` that reads it in a process of its own."""
TEXT = (".csv", ".tsv", ".txt", ".log")
PACKED = ".gz"
"""The ending behind that of a text that was compressed."""
ENDINGS = (*TEXT, *(kind + PACKED for kind in TEXT), *BINARY, *FOREIGN)
"""Every ending that is read."""


def read_matrix(path: Path | str, limits: Limits = LIMITS, **stated: Unpack[Stated]) -> Matrix:
    """The matrix in a folder, beside its matrix.yaml, or in a .zip, nothing being unpacked to disk.

    Of a bare record, as run.csv, the caller states what matrix.yaml would: the unit of each channel, the clock, and
    what else is known, see :class:`ident.words.record_description.Stated`.

    Raises Unusable for everything that is wrong with it; docs/matrix-format.md lists the codes.
    """
    of_kind("read_matrix", "path", path, Path | str)
    of_kind("read_matrix", "limits", limits, Limits)
    path = Path(path)
    if path.suffix.lower() in (*BINARY, *FOREIGN, *TEXT) and not path.is_dir():
        return _read_file(path, limits, stated)
    if stated:
        what = f"{next(iter(stated))} is stated of a whole matrix"
        raise Unusable("bad-option", what, str(path), "leave it to its matrix.yaml, or give one run's file")
    if path.is_dir():
        return read_source(Folder(path, limits), limits)
    if path.name == DESCRIPTION:
        return read_source(Folder(path.parent, limits), limits)
    archive = Archive(path, path.name, limits)
    try:
        return read_source(archive, limits)
    finally:
        archive.close()


def _read_file(path: Path, limits: Limits, stated: Stated) -> Matrix:
    """One file of a record, of which all else is stated."""
    folder = Folder(path.parent, limits)
    parts = [folder.read(path.name, limits.file)]
    near = beside(folder, path.name, limits, parts)
    return of_file(path, parts, stated, lambda run: read_table(parts[0], path.name, run.dialect, limits, "", near))


def read_source(source: Source, limits: Limits = LIMITS) -> Matrix:
    """The matrix that any :class:`ident.readers.source.Source` holds. Raises Unusable."""
    text = source.read(DESCRIPTION, limits.description)
    described = describe(text, limits)
    runs, notices, digest = read_runs(source, described, text, limits)
    stated = "" if described.limits is None else limits_text(source, described.limits, limits)
    actuator = described.actuator
    if described.profile:
        profile = source.read(described.profile, limits.description)
        actuator = replace(actuator, rig=rig_in(profile, described.profile))
        digest = hashlib.sha256(digest.encode() + profile).hexdigest()
    return Matrix(
        actuator,
        runs,
        digest,
        described.controller,
        described.limits,
        stated,
        notices,
        described.machine,
        test=described.test,
        regulator=described.regulator,
    )


def limits_text(source: Source, name: str, limits: Limits) -> str:
    """The limits file that is named, which must be there. Raises Unusable."""
    try:
        return source.read(name, limits.description).decode("utf-8")
    except UnicodeDecodeError:
        raise Unusable("not-text", "the limits file is not text in UTF-8", name, "write it as YAML") from None


def read_runs(
    source: Source, described: Description, text: bytes, limits: Limits
) -> tuple[tuple[Run, ...], tuple[str, ...], str]:
    """Every run, what reading assumed, and the SHA-256 of matrix.yaml and each run file in order of first mention.

    Behind a run file stand the files beside it that it names.
    """
    digest = hashlib.sha256(text)
    runs: dict[int, tuple[Run, ...]] = {}
    splits: list[str] = []
    notices: dict[str, list[str]] = {}  # alike but for the file's name
    read, in_memory = 0, 0
    for name, wanted in by_file(described.runs).items():
        parts = [source.read(name, limits.file)]
        near = beside(source, name, limits, parts)
        read += len(parts[0])
        check_size(read, limits.total, "all run files together", name)
        tables: dict[Dialect, Table] = {}
        for number, run in wanted:
            if run.dialect not in tables:
                of_run = run_name(run.labels.id)
                table = read_table(parts[0], name, run.dialect, limits, of_run, near)
                tables[run.dialect] = replace(table, file=name)
                for notice in tables[run.dialect].notices:
                    notices.setdefault(notice.replace(name, "", 1), []).append(notice)
            runs[number], told_of_split = _read_run(run, tables[run.dialect])
            splits += told_of_split
            in_memory += sum(samples.nbytes for part in runs[number] for samples in part.channels.values())
            check_size(in_memory, limits.samples, "all samples together", name)
        read += sum(map(len, parts[1:]))
        for part in parts:
            digest.update(part)
    made = [(run, of) for n, of in enumerate(described.runs) for run in runs[n]]
    held, chosen = with_hold([run for run, _ in made], [of.hold_stated for _, of in made])
    outputs = (one for run, (_, of) in zip(held, made, strict=True) for one in run.of_outputs(of.outputs))
    told = [
        one if not more else f"{one}; so it was with {count(len(more), 'more file')}" for one, *more in notices.values()
    ]
    return tuple(outputs), (*told, *splits, *chosen), digest.hexdigest()


def _read_run(run: RunDescription, table: Table) -> tuple[tuple[Run, ...], tuple[str, ...]]:
    """As :func:`read_run`; what the description says wrongly of the file is refused with its name."""
    try:
        return read_run(run, table)
    except Unusable as error:
        raise error.within(DESCRIPTION) if error.code in _OF_DESCRIPTION else error from None


_OF_DESCRIPTION = ("missing-column", "ambiguous-column", "rows-outside", "time-stamps", "bad-split")


def by_file(runs: tuple[RunDescription, ...]) -> dict[str, list[tuple[int, RunDescription]]]:
    """The runs of each file, so that a file is read and hashed once."""
    files: dict[str, list[tuple[int, RunDescription]]] = {}
    for number, run in enumerate(runs):
        files.setdefault(run.labels.file, []).append((number, run))
    return files


def read_table(data: bytes, name: str, stated: Dialect, limits: Limits, where: str = "", near: Beside = alone) -> Table:
    """The table of a file by the ending of its name; `where` is the run that asks for it, `near` has what lies beside.

    Raises Unusable: ``unknown-type``, ``empty-file``, ``bad-rows``, and what the reader raises.
    """
    ending = ending_of(name)
    if ending not in ENDINGS:
        remedy = f"use one of {', '.join(ENDINGS)}"
        raise Unusable("unknown-type", f"files ending in {ending or 'nothing'!r} cannot be read", name, remedy)
    if not data:
        raise Unusable("empty-file", "the file is empty", name, "give a record")
    if ending.endswith(PACKED):
        data, ending = unpacked(data, name, limits), ending.removesuffix(PACKED)
    if ending in TEXT:
        recording = read_controldesk(data, name, limits) if stated == FOUND else None
        return recording or read_text(data, name, limits, stated)
    if stated.skip_rows:
        raise Unusable("bad-rows", "skip_rows is for text files", f"{where} skip_rows".strip(), "use rows")
    if stated != FOUND:
        raise Unusable("bad-dialect", "a dialect is for text files", f"{where} dialect".strip(), "leave it out")
    if ending in FOREIGN:
        return read_sandboxed(FOREIGN[ending], data, name, limits)
    kind = BINARY[ending]
    if kind == "dat":
        return read_dat(data, name, limits, near)
    read: Reader = getattr(import_module(f"ident.readers.{kind}"), f"read_{kind}")
    return read(data, name, limits)


def ending_of(name: str) -> str:
    """The ending of a name in small letters, with the one before it where that was compressed."""
    *_, before, last = ("", "", *PurePosixPath(name.lower()).suffixes)
    return before + last if last == PACKED else last
