"""HDF5 and MATLAB v7.3: datasets that lie in the file itself, found without following any link out of it."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from typing import Any

from ident.errors import Unusable
from ident.readers.hdf5_chunks import read_dataset
from ident.readers.hdf5_series import REFERENCES, SUBSYSTEM, is_object, signals73
from ident.readers.limits import Limits, check_size
from ident.readers.rate_variable import names_a_rate, rate_of
from ident.readers.table import NUMERIC, Array, Table, column_of, split_columns

SIGNATURE = b"\x89HDF\r\n\x1a\n"
OBJECTS = 10_000
DEEPEST = 8


def read_hdf5(data: bytes, where: str, limits: Limits) -> Table:
    """The datasets by path. Raises Unusable: ``broken-hdf5``, ``hdf5-link``, ``hdf5-virtual``, ``hdf5-external``,
    ``hdf5-filter``, ``not-numeric``, ``too-large``.
    """
    import h5py  # noqa: PLC0415

    try:
        file = h5py.File(io.BytesIO(data), "r")
        found = list(walk(file, "", where, {}, DEEPEST))
        objects = {name: dataset for name, dataset in found if is_object(dataset)}
        series = signals73(file, objects, lambda thing: checked(thing, thing.name, where, limits)) if objects else []
        datasets = [
            (name, dataset, dataset.shape or ()) for name, dataset in found if not series or name not in objects
        ]
        matlab = {name: "MATLAB_class" in dataset.attrs for name, dataset, _ in datasets}
    except Unusable:
        raise
    except Exception as error:  # whatever the library meets in a broken file
        raise broken(where) from error
    columns = [
        (column, number, name, dataset)
        for name, dataset, shape in datasets
        for number, column in enumerate(split_columns(name, shape[::-1] if matlab[name] else shape))
    ]

    signals = [
        (column, number, array, unit)
        for name, array, unit in series
        for number, column in enumerate(split_columns(name, array.shape))
    ]

    def load(numbers: Sequence[int]) -> list[Array]:
        found = []
        for n in numbers:
            if n >= len(columns):
                _, number, array, _ = signals[n - len(columns)]
                found.append(column_of(array, number))
                continue
            _, number, name, dataset = columns[n]
            array = checked(dataset, name, where, limits)
            found.append(column_of(array.T if matlab[name] else array, number))
        return found

    names = (*(column for column, _, _, _ in columns), *(column for column, _, _, _ in signals))
    units = (*("" for _ in columns), *(unit for _, _, _, unit in signals))
    single = {column: n for n, (column, _, _, dataset) in enumerate(columns) if _may_state_a_rate(column, dataset)}
    rate, variable = rate_of(zip(single, (float(array[0]) for array in load(list(single.values()))), strict=True))
    return Table(names, load, units=units if any(units) else (), rate=rate, rate_variable=variable)


def _may_state_a_rate(column: str, dataset: Any) -> bool:
    return names_a_rate(column) and bool(dataset.size == 1 and dataset.dtype.kind in NUMERIC)


def walk(group: Any, path: str, where: str, seen: dict[Any, None], depth: int) -> Iterator[tuple[str, Any]]:
    """Every dataset below a group with its path; a group that was seen before is not entered again."""
    import h5py  # noqa: PLC0415

    for name in group:
        place = f"{path}{name}"
        link = group.get(name, getlink=True)
        if not isinstance(link, h5py.HardLink):
            kind = "another file" if isinstance(link, h5py.ExternalLink) else "another place"
            raise Unusable("hdf5-link", f"{place!r} is a link to {kind}", where, "save the data itself")
        thing = group[name]
        key = h5py.h5o.get_info(thing.id).addr
        if isinstance(thing, h5py.Dataset):
            refuse_elsewhere(thing, place, where)
            yield place, thing
        elif isinstance(thing, h5py.Group) and key not in seen and depth and name not in (REFERENCES, SUBSYSTEM):
            seen[key] = None
            yield from walk(thing, place + "/", where, seen, depth - 1)
        if len(seen) > OBJECTS:
            raise Unusable("too-large", f"more than {OBJECTS} groups", where, "save the channels only")


def refuse_elsewhere(dataset: Any, name: str, where: str) -> None:
    """Refuse data that lie in other files."""
    if dataset.is_virtual:
        raise Unusable("hdf5-virtual", f"{name!r} is a virtual dataset", where, "save the data itself")
    if dataset.external:
        raise Unusable("hdf5-external", f"{name!r} is stored in another file", where, "save the data itself")


def checked(dataset: Any, name: str, where: str, limits: Limits) -> Array:
    """The samples of a dataset whose declared size and type are acceptable."""
    try:
        dtype, shape = dataset.dtype, dataset.shape
        size = math.prod(shape or (0,)) * max(dtype.itemsize, 8)
    except Exception as error:
        raise broken(where) from error
    if dtype.kind not in NUMERIC or dtype.subdtype is not None:
        what = f"dataset {name!r} holds {dtype} and not numbers"
        raise Unusable("not-numeric", what, where, "save real numbers")
    check_size(size, limits.file, f"dataset {name!r}", where)
    try:
        return read_dataset(dataset, name, where, limits)
    except Unusable:
        raise
    except Exception as error:
        raise broken(where) from error


def broken(where: str) -> Unusable:
    """The error for a file that is no HDF5 or was cut short."""
    return Unusable("broken-hdf5", "this is not a whole HDF5 file", where, "copy it or save it again")
