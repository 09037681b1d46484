"""MATLAB files: v4 and v5 through scipy, v7.3 as the HDF5 file that it is."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.readers.hdf5 import SIGNATURE, read_hdf5
from ident.readers.limits import Limits
from ident.readers.mat_inflate import inflated
from ident.readers.table import Array, Table, column_of, numeric, split_columns

HEADER = 128
DEEPEST = 4


def read_mat(data: bytes, where: str, limits: Limits) -> Table:
    """The variables, and the fields of structures as ``name.field``.

    Raises Unusable: ``broken-mat``, ``not-numeric``, ``too-large``, and what :func:`read_hdf5` raises.
    """
    if SIGNATURE in (data[:8], data[512:520]):
        return read_hdf5(data, where, limits)
    try:
        arrays = list(flat(variables(data, where, limits), "", DEEPEST))
    except Unusable:
        raise
    except Exception as error:  # whatever scipy meets in a broken file
        raise broken(where) from error
    columns = [(part, number, array) for name, array in arrays for number, part in enumerate(columns_of(name, array))]

    def load(numbers: Sequence[int]) -> list[Array]:
        return [column_of(numeric(columns[n][2], columns[n][0], where), columns[n][1]) for n in numbers]

    return Table(tuple(name for name, _, _ in columns), load)


def variables(data: bytes, where: str, limits: Limits) -> dict[str, Any]:
    """Everything in a v4 or v5 file. Compressed parts are unpacked by us, within the limits, before scipy sees them."""
    from scipy.io import loadmat  # noqa: PLC0415

    if not data:
        raise broken(where)
    version5 = data[:4].isalpha() or b"\0" not in data[:4]
    plain = inflated(data, where, limits) if version5 else data
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        found: dict[str, Any] = loadmat(io.BytesIO(plain), struct_as_record=True, chars_as_strings=False)
    return {name: value for name, value in found.items() if not name.startswith("__")}


def flat(found: dict[str, Any], before: str, depth: int) -> Iterator[tuple[str, Array]]:
    """Arrays by name, the fields of single structures too."""
    for name, value in found.items():
        if not isinstance(value, np.ndarray):
            continue  # a sparse matrix or a MATLAB object is no record
        if value.dtype.names and value.size == 1 and depth:
            fields = {field: value[field].item() for field in value.dtype.names}
            yield from flat(fields, f"{before}{name}.", depth - 1)
        elif value.dtype.names is None:
            yield before + name, value


def columns_of(name: str, array: Array) -> list[str]:
    """The columns of a variable; text and cells count as one, to be refused by name when asked for."""
    return split_columns(name, array.shape) if array.dtype.kind in "iuf" else [name]


def broken(where: str) -> Unusable:
    """The error for a file that is no MAT file or was cut short."""
    return Unusable("broken-mat", "this is not a whole MAT file", where, "save it again from MATLAB")
