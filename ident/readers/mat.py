"""MATLAB files: v4 and v5, and v7.3 as the HDF5 file that it is."""

from __future__ import annotations

from collections.abc import Sequence

from ident.errors import Unusable
from ident.readers.hdf5 import SIGNATURE, read_hdf5
from ident.readers.limits import Limits
from ident.readers.mat4 import variables4
from ident.readers.mat5 import Damaged, Variable, variables5
from ident.readers.mat_inflate import byte_order, inflated
from ident.readers.mat_series import Signal, signals
from ident.readers.rate_variable import rate_of
from ident.readers.table import NUMERIC, Array, Table, column_of, split_columns

_STEP, _INPUT = "Ts", "InputData"
"""Fields of MATLAB's ``iddata``: the time between two samples, and the inputs."""
Column = tuple[str, Array | str, int]
"""Name, the variable it is a column of, and which."""


def read_mat(data: bytes, where: str, limits: Limits) -> Table:
    """The variables, and the fields of structures as ``name.field``.

    Raises Unusable: ``broken-mat``, ``not-numeric``, ``too-large``, and what :func:`read_hdf5` raises.
    """
    if SIGNATURE in (data[:8], data[512:520]):
        return read_hdf5(data, where, limits)
    try:
        found, series = contents(data, where, limits)
    except Damaged as damaged:
        remedy = "copy it or save it again from MATLAB"
        raise Unusable("broken-mat", f"this is not a whole MAT file: {damaged}", where, remedy) from None
    columns = [column for name, array in found for column in columns_of(name, array)]
    units = [""] * len(columns)
    for name, samples_of, unit in series:
        columns += (more := columns_of(name, samples_of))
        units += [unit] * len(more)

    def load(numbers: Sequence[int]) -> list[Array]:
        return [samples(columns[number], where) for number in numbers]

    names, units_of = tuple(name for name, _, _ in columns), tuple(units) if any(units) else ()
    rate, variable = (_rate(found), "") if _rate(found) else rate_of(_scalars(found))
    return Table(names, load, units=units_of, rate=rate, rate_variable=variable)


def _rate(found: Sequence[Variable]) -> float:
    """The sample rate in Hz of MATLAB's ``iddata``, which states the step Ts in s; 0 where there is none."""
    held = dict(found)
    for name, step in held.items():
        owner, _, field = name.rpartition(".")
        if field == _STEP and f"{owner}.{_INPUT}" in held and not isinstance(step, str) and step.size == 1:
            return 1.0 / float(step.ravel()[0]) if 0.0 < float(step.ravel()[0]) < float("inf") else 0.0
    return 0.0


def _scalars(found: Sequence[Variable]) -> list[tuple[str, float]]:
    """The variables that hold one real number."""
    single = [(name, array) for name, array in found if not isinstance(array, str) and array.size == 1]
    return [(name, float(array.ravel()[0])) for name, array in single if array.dtype.kind in NUMERIC]


def contents(data: bytes, where: str, limits: Limits) -> tuple[list[Variable], list[Signal]]:
    """Every variable of a v4 or v5 file, and the signals that a v5 file holds as objects. Raises Damaged.

    A v4 file is marked by a zero among its first four bytes.
    """
    if b"\0" in data[:4]:
        return list(variables4(data)), []
    elements, order = inflated(data, where, limits), byte_order(data, where)
    return list(variables5(elements, order)), signals(elements, order)


def columns_of(name: str, array: Array | str) -> list[Column]:
    """The columns of a variable; what is no array of numbers counts as one, to be refused when asked for."""
    names = [name] if isinstance(array, str) else split_columns(name, array.shape)
    return [(each, array, number) for number, each in enumerate(names)]


def samples(column: Column, where: str) -> Array:
    """The samples of a column. Raises Unusable: ``not-numeric``."""
    name, array, number = column
    if isinstance(array, str):
        raise Unusable("not-numeric", f"variable {name!r} holds {array}", where, "save real numbers")
    return column_of(array, number)
