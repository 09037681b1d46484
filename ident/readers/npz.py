"""NumPy archives: only arrays of numbers, never an object, whose declared size is looked at first."""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.readers.archive import ENCRYPTED, METHODS
from ident.readers.limits import Limits, check_size
from ident.readers.rate_variable import names_a_rate, rate_of
from ident.readers.table import NUMERIC, Array, Table, column_of, numeric, split_columns

LARGEST_HEADER = 10_000
MEMBERS = 1000


@dataclass(frozen=True)
class Member:
    """One array of the archive as its header declares it; `start` is where its samples begin."""

    info: zipfile.ZipInfo
    shape: tuple[int, ...]
    fortran: bool
    dtype: np.dtype[Any]
    start: int


def read_npz(data: bytes, where: str, limits: Limits) -> Table:
    """The columns of a .npz. Raises Unusable: ``broken-npz``, ``object-array``, ``not-numeric``, ``too-large``."""
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
        infos = archive.infolist()
    except Exception as error:  # a broken archive fails in many ways
        raise broken(where) from error
    if len(infos) > MEMBERS or any(info.flag_bits & ENCRYPTED or info.compress_type not in METHODS for info in infos):
        raise broken(where)
    members = [(info.filename.removesuffix(".npy"), header(archive, info, where)) for info in infos]
    columns = [
        (name, number, member)
        for top, member in members
        for number, name in enumerate(split_columns(top, member.shape))
    ]

    def load(numbers: Sequence[int]) -> list[Array]:
        arrays: dict[str, Array] = {}  # an array of many columns is read once
        found = []
        for number in numbers:
            name, place, member = columns[number]
            if member.info.filename not in arrays:
                arrays[member.info.filename] = samples(archive, member, name, where, limits)
            found.append(column_of(arrays[member.info.filename], place))
        return found

    single = [top for top, member in members if math.prod(member.shape) == 1 and member.dtype.kind in NUMERIC]
    stating = [top for top in single if names_a_rate(top)]
    numbers = [number for number, (name, _, _) in enumerate(columns) if name in stating]
    scalars = zip(stating, (float(array[0]) for array in load(numbers)), strict=True)
    rate, variable = rate_of(scalars)
    return Table(tuple(name for name, _, _ in columns), load, rate=rate, rate_variable=variable)


def broken(where: str) -> Unusable:
    """The error for an archive that numpy would not have written."""
    return Unusable("broken-npz", "this is not a whole .npz file", where, "save it again with numpy.savez")


def header(archive: zipfile.ZipFile, info: zipfile.ZipInfo, where: str) -> Member:
    """What a member declares."""
    try:
        with archive.open(info) as file:
            version = np.lib.format.read_magic(file)
            read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
            shape, fortran, dtype = read(file, max_header_size=LARGEST_HEADER)
            return Member(info, shape, fortran, dtype, file.tell())
    except Exception as error:
        raise broken(where) from error


def samples(archive: zipfile.ZipFile, member: Member, name: str, where: str, limits: Limits) -> Array:
    """The array of one member."""
    if member.dtype.hasobject:
        what = f"array {name!r} holds Python objects, which are never unpickled"
        raise Unusable("object-array", what, where, "save arrays of numbers")
    numeric(np.empty(0, member.dtype), name, where)
    size = math.prod(member.shape) * member.dtype.itemsize
    check_size(size, limits.file, f"array {name!r}", where)
    if min(member.shape, default=0) < 0 or member.info.file_size != member.start + size:
        raise broken(where)
    try:
        with archive.open(member.info) as file:
            raw = file.read(member.start + size)
        array = np.frombuffer(raw, member.dtype, offset=member.start)
        return array.reshape(member.shape, order="F" if member.fortran else "C")
    except Exception as error:
        raise broken(where) from error
