"""Matrices that cannot be used or were made to harm, each with the code of its refusal.

A case makes a folder or an archive from a good :class:`tests.matrix_folder.MatrixFolder`. The readers' own tests and
the tests of the service and the command line use the same ones.
"""

from __future__ import annotations

import os
import stat
import struct
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from tests.matrix_folder import MatrixFolder

Make = Callable[[MatrixFolder], Path]


@dataclass(frozen=True)
class Bad:
    """One bad matrix: what is wrong with it, how it is made, the code by which it is refused."""

    name: str
    code: str
    make: Make


# Archives


def with_member(name: str | zipfile.ZipInfo, content: str | bytes) -> Make:
    """The archive of a good matrix with one more member."""

    def make(matrix: MatrixFolder) -> Path:
        matrix.write()
        archive = matrix.pack()
        with zipfile.ZipFile(archive, "a", zipfile.ZIP_DEFLATED) as packed:
            packed.writestr(name, content)
        return archive

    return make


def archive_of(content: bytes) -> Make:
    """These bytes, called an archive."""

    def make(matrix: MatrixFolder) -> Path:
        archive = matrix.path.with_suffix(".zip")
        archive.write_bytes(content)
        return archive

    return make


def truncated_zip(matrix: MatrixFolder) -> Path:
    """The archive of a good matrix, cut short."""
    matrix.write()
    archive = matrix.pack()
    archive.write_bytes(archive.read_bytes()[:-30])
    return archive


def link() -> zipfile.ZipInfo:
    """An archive's member that is a symbolic link."""
    member = zipfile.ZipInfo("runs/link.csv")
    member.external_attr = (stat.S_IFLNK | 0o777) << 16
    return member


def linked_folder(matrix: MatrixFolder) -> Path:
    """A folder whose run file is a symbolic link to a file outside."""
    run = matrix.write() / "runs/first.csv"
    outside = matrix.path.parent / "outside.csv"
    run.rename(outside)
    run.symlink_to(outside)
    return matrix.path


def sparse(matrix: MatrixFolder) -> Path:
    """A folder whose run file declares 2 GB and takes no disk."""
    path = matrix.write()
    with (path / "runs/first.csv").open("wb") as file:
        file.truncate(2 << 30)
    return path


# Descriptions and samples


def described(old: str, new: str) -> Make:
    """The good matrix with one change of its description."""
    return lambda matrix: matrix.change(old, new).write()


def laughs(matrix: MatrixFolder) -> Path:
    """A billion laughs: nine levels of ten aliases each."""
    names = "abcdefghi"
    lines = [f"{names[0]}: &{names[0]} [{', '.join(['lol'] * 10)}]"]
    lines += [f"{n}: &{n} [{', '.join(['*' + b] * 10)}]" for b, n in pairwise(names)]
    matrix.text = "\n".join([*lines, matrix.text.replace("SW-1", "*i")])
    return matrix.write()


def recorded(change: Callable[[dict[str, Any]], None], kind: str = "csv") -> Make:
    """The good matrix with other samples."""

    def make(matrix: MatrixFolder) -> Path:
        change(matrix.columns)
        return matrix.write(kind)

    return make


def sample(value: float) -> Make:
    """One sample of the response is this."""
    return recorded(lambda columns: columns["x"].__setitem__(17, value))


def shortened(length: int, names: str = "tux", kind: str = "npz") -> Make:
    """Some columns end after so many samples."""
    return recorded(lambda columns: columns.update({name: columns[name][:length] for name in names}), kind)


def emptied(matrix: MatrixFolder) -> Path:
    """The run file holds nothing."""
    path = matrix.write()
    (path / "runs/first.csv").write_bytes(b"")
    return path


def backwards(matrix: MatrixFolder) -> Path:
    """A time column that jumps back."""
    matrix.columns["t"] = np.roll(matrix.columns["t"], 7)
    return matrix.change("sample_rate: 1000 Hz", "time: {column: t, unit: s}").write()


def truncated(kind: str, keep: float = 0.7) -> Make:
    """A run file of this type that was cut short."""

    def make(matrix: MatrixFolder) -> Path:
        path = matrix.write(kind)
        run = next((path / "runs").iterdir())
        whole = run.read_bytes()
        run.write_bytes(whole[: int(keep * len(whole))])
        return path

    return make


# NumPy archives


def npy(shape: str, dtype: str = "'<f8'", data: bytes = b"") -> bytes:
    """A .npy that declares what it likes."""
    head = f"{{'descr': {dtype}, 'fortran_order': False, 'shape': {shape}, }}".encode()
    head += b" " * (63 - (len(head) + 10) % 64) + b"\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head + data


def with_npz(member: bytes) -> Make:
    """A run in a .npz whose arrays are this member."""

    def make(matrix: MatrixFolder) -> Path:
        matrix.change("first.csv", "first.npz").describe()
        with zipfile.ZipFile(matrix.path / "runs/first.npz", "w", zipfile.ZIP_DEFLATED) as packed:
            packed.writestr("u.npy", member)
            packed.writestr("x.npy", member)
        return matrix.path

    return make


class Trap:
    """An object that, when it is unpickled, makes the folder `sprung`."""

    def __init__(self, sprung: Path) -> None:
        self.sprung = sprung

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        return os.mkdir, (str(self.sprung),)


def object_array(matrix: MatrixFolder) -> Path:
    """A .npz of pickled objects; whoever unpickles them makes the folder `sprung` beside the matrix."""
    trap = np.array([Trap(matrix.path.parent / "sprung")] * 400, dtype=object)
    matrix.change("first.csv", "first.npz").describe()
    np.savez(matrix.path / "runs/first.npz", u=trap, x=np.arange(400.0))
    return matrix.path


# HDF5


def with_hdf5(make_x: Callable[[Any], None]) -> Make:
    """A run in a .h5 whose command is good, and whose response `make_x` adds to the file."""

    def make(matrix: MatrixFolder) -> Path:
        import h5py

        matrix.text = matrix.text.replace("first.csv", "first.h5")
        matrix.describe()
        with h5py.File(matrix.path / "runs/first.h5", "w") as file:
            file["u"] = np.arange(400.0)
            make_x(file)
        return matrix.path

    return make


def external_link(file: Any) -> None:
    """A link to a dataset of another file."""
    import h5py

    file["x"] = h5py.ExternalLink("/etc/passwd", "/x")


def soft_link(file: Any) -> None:
    """A link to another place of the same file."""
    import h5py

    file["x"] = h5py.SoftLink("/u")


def virtual(file: Any) -> None:
    """A dataset made of parts of another file."""
    import h5py

    layout = h5py.VirtualLayout((400,), "f8")
    layout[:] = h5py.VirtualSource("/etc/passwd", "x", (400,))
    file.create_virtual_dataset("x", layout)


def external_storage(file: Any) -> None:
    """A dataset whose bytes are another file."""
    file.create_dataset("x", (400,), "f8", external=[("/etc/passwd", 0, 3200)])


def huge(file: Any) -> None:
    """A dataset that declares 8 TB."""
    file.create_dataset("x", (1 << 40,), "f8", chunks=(1 << 20,), compression="gzip")


@cache
def swollen(first: bytes = b"") -> bytes:
    """What zlib unpacks to some bytes and 200 MB of zeros, of which a megabyte is packed: all take a second."""
    packer, megabyte, count = zlib.compressobj(9, zlib.DEFLATED, -15), bytes(1 << 20), 200
    begun = packer.compress(first) + packer.flush(zlib.Z_FULL_FLUSH)
    packed = packer.compress(megabyte) + packer.flush(zlib.Z_FULL_FLUSH)
    check = zlib.adler32(first)
    for _ in range(count):
        check = zlib.adler32(megabyte, check)
    return b"\x78\xda" + begun + count * packed + b"\x03\x00" + struct.pack(">I", check)


def swollen_chunk(file: Any) -> None:
    """A chunk that unpacks to 200 MB where 3 kB are declared."""
    data = file.create_dataset("x", (400,), "f8", chunks=(400,), compression="gzip")
    data.id.write_direct_chunk((0,), swollen())


# Parquet and MATLAB


def large_parquet(matrix: MatrixFolder) -> Path:
    """Columns of 320 MB of zeros, in some kilobytes."""
    import pyarrow as pa
    from pyarrow import parquet

    matrix.change("first.csv", "first.parquet").describe()
    batch = pa.table({name: np.zeros(1 << 20) for name in "ux"})
    with parquet.ParquetWriter(matrix.path / "runs/first.parquet", batch.schema) as writer:
        for _ in range(40):
            writer.write_table(batch)
    return matrix.path


def with_mat5(element: bytes) -> Make:
    """A run in a MATLAB v5 file of one element."""

    def make(matrix: MatrixFolder) -> Path:
        matrix.change("first.csv", "first.mat").describe()
        head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
        (matrix.path / "runs/first.mat").write_bytes(head + element)
        return matrix.path

    return make


def compressed_mat5(inside: bytes) -> Make:
    """A run in a MATLAB v5 file of one compressed element."""
    packed = zlib.compress(inside, 9)
    return with_mat5(struct.pack("<II", 15, len(packed)) + packed)


def mat5_bomb(matrix: MatrixFolder) -> Path:
    """Some kilobytes that swell to 200 MB when they are read."""
    packed = swollen(struct.pack("<II", 14, 1000))
    return with_mat5(struct.pack("<II", 15, len(packed)) + packed)(matrix)


BAD_MATRICES = (
    Bad("not a zip", "not-a-zip", archive_of(b"not a zip at all")),
    Bad("an empty zip file", "not-a-zip", archive_of(b"")),
    Bad("truncated zip", "not-a-zip", truncated_zip),
    Bad("zip bomb", "zip-bomb", with_member("runs/bomb.csv", bytes(32 << 20))),
    Bad("path traversal in a zip", "outside-folder", with_member("../evil.csv", "x")),
    Bad("absolute path in a zip", "outside-folder", with_member("/evil.csv", "x")),
    Bad("symbolic link in a zip", "symbolic-link", with_member(link(), "/etc/passwd")),
    Bad("file: that leaves the folder", "outside-folder", described("file: runs/", "file: ../runs/")),
    Bad("file: with an absolute path", "outside-folder", described("file: runs/first.csv", "file: /etc/passwd")),
    Bad("YAML aliases", "yaml-alias", laughs),
    Bad("YAML that is none", "not-yaml", described("gain: 7", "gain: [7")),
    Bad("missing file", "missing-file", MatrixFolder.describe),
    Bad("missing column", "missing-column", described("column: x", "column: nothing")),
    Bad("missing unit", "missing-unit", described("{column: u, unit: mm}", "{column: u}")),
    Bad("quantity without unit", "missing-unit", described("497 mm^2", "497")),
    Bad("unknown unit", "unknown-unit", described("{column: u, unit: mm}", "{column: u, unit: furlong}")),
    Bad("wrong dimension", "wrong-dimension", described("0.87 kg", "0.87 N")),
    Bad("negative mass", "negative-mass", described("0.87 kg", "-0.87 kg")),
    Bad("Kp = 0", "zero-gain", described("gain: 7", "gain: 0")),
    Bad("no value", "no-values", recorded(lambda columns: columns["x"].fill(np.nan))),
    Bad("infinity", "not-finite", sample(np.inf)),
    Bad("unequal lengths", "unequal-lengths", shortened(300, "x")),
    Bad("empty file", "empty-file", emptied),
    Bad("no samples", "empty-file", shortened(0)),
    Bad("1 sample", "too-short", shortened(1)),
    Bad("zero variance", "zero-variance", recorded(lambda columns: columns["x"].fill(0.3))),
    Bad("non-monotonic time", "time-not-monotonic", backwards),
    Bad("HDF5 external link", "hdf5-link", with_hdf5(external_link)),
    Bad("HDF5 virtual dataset", "hdf5-virtual", with_hdf5(virtual)),
    Bad("HDF5 external storage", "hdf5-external", with_hdf5(external_storage)),
    Bad("HDF5 that declares 8 TB", "too-large", with_hdf5(huge)),
    Bad("HDF5 bomb", "broken-hdf5", with_hdf5(swollen_chunk)),
    Bad("npz that declares 8 GB", "too-large", with_npz(npy("(1000000000,)"))),
    Bad("npz bomb", "broken-npz", with_npz(npy("(400,)", data=bytes(16 << 20)))),
    Bad("object arrays in npz", "object-array", object_array),
    Bad("Parquet bomb", "too-large", large_parquet),
    Bad("MAT bomb", "broken-mat", mat5_bomb),
    *(Bad(f"truncated {kind}", f"broken-{code}", truncated(kind)) for kind, code in (
        ("mat5", "mat"), ("mat4", "mat"), ("mat73", "hdf5"), ("h5", "hdf5"), ("tdms", "tdms"), ("parquet", "parquet"),
        ("npz", "npz"))),
)  # fmt: skip
"""Bad matrices that may be uploaded as one archive as well as read from disk."""

BAD_FOLDERS = (
    Bad("symbolic link in a folder", "symbolic-link", linked_folder),
    Bad("2 GB declared", "too-large", sparse),
)
"""Bad matrices that only a disk can hold."""
