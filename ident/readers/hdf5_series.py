"""The signals of a v7.3 MAT file that MATLAB and Simulink saved as objects: the table of a v5 file, in HDF5.

A variable that is an object is an array with a reference. What it refers to stands in ``#subsystem#/MCOS``: a cell with
the table of objects and the value of each property, each of them a reference to a dataset or group of ``#refs#``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ident.readers.mat_objects import Objects, Value, objects_of, reference
from ident.readers.mat_series import Signal, columns_of_series
from ident.readers.table import NUMERIC, Array

SUBSYSTEM = "#subsystem#"
REFERENCES = "#refs#"
_TABLE = "MCOS"
_CLASS, _EMPTY, _OBJECT = "MATLAB_class", "MATLAB_empty", "MATLAB_object_decode"
_DEEPEST = 4
_MOST = 4096
"""Elements of a cell, as of a v5 file, but for the cell of the table itself."""
_MOST_CELLS = 100_000
Load = Callable[[Any], Array]
"""The samples of a dataset whose size and type are acceptable."""


def is_object(dataset: Any) -> bool:
    """Whether a variable is one of MATLAB's objects."""
    return _OBJECT in dataset.attrs


def signals73(file: Any, variables: dict[str, Any], load: Load) -> list[Signal]:
    """The signals that the `variables` which are objects hold, and their time: once where all have the same."""
    objects = _objects(file, load)
    if objects is None:
        return []
    found = [
        series
        for name, dataset in variables.items()
        for series in objects.series(_value(file, dataset, load, _DEEPEST), name)
    ]
    return columns_of_series(found)


def _objects(file: Any, load: Load) -> Objects | None:
    """The table of objects; None where the file has none that can be read."""
    import h5py  # noqa: PLC0415

    behind = file.get(SUBSYSTEM)
    table = behind.get(_TABLE) if isinstance(behind, h5py.Group) else None
    if not isinstance(table, h5py.Dataset) or not _holds_references(table) or table.size > _MOST_CELLS:
        return None
    cells = tuple(_value(file, _behind(file, each), load, _DEEPEST) for each in np.ravel(table[()]))
    return objects_of(cells, "<")


def _value(file: Any, thing: Any, load: Load, depth: int) -> Value:
    """The value of a property as far as it is one of signals; None for what is not."""
    import h5py  # noqa: PLC0415

    if thing is None or not depth or _EMPTY in thing.attrs:
        return None
    if isinstance(thing, h5py.Group):
        names = [name for name in list(thing)[:_MOST] if isinstance(thing.get(name, getlink=True), h5py.HardLink)]
        return {name: _value(file, _own(thing[name]), load, depth - 1) for name in names}
    if _holds_references(thing):
        few = np.ravel(thing[()]) if thing.size <= _MOST else ()
        return tuple(_value(file, _behind(file, each), load, depth - 1) for each in few)
    if thing.dtype.kind not in NUMERIC or thing.dtype.subdtype is not None:
        return None
    values = load(thing).T  # MATLAB's order of the dimensions
    if thing.attrs.get(_CLASS) == b"char":
        return "".join(map(chr, values.ravel(order="F").astype(np.uint16)))
    return reference(values.ravel(order="F")) or values


def _holds_references(dataset: Any) -> bool:
    import h5py  # noqa: PLC0415

    return bool(h5py.check_ref_dtype(dataset.dtype) is h5py.Reference)


def _behind(file: Any, link: Any) -> Any:
    """What a reference leads to within the file; None where it leads nowhere."""
    return _own(file[link]) if link else None


def _own(thing: Any) -> Any:
    """A dataset or a group; None for samples that lie in another file."""
    import h5py  # noqa: PLC0415

    if isinstance(thing, h5py.Dataset):
        return None if thing.is_virtual or thing.external else thing
    return thing if isinstance(thing, h5py.Group) else None
