"""MDF 3 and 4 through :mod:`ident.foreign.mdf`, in a process of its own."""

from __future__ import annotations

from ident.readers.apart import read_apart
from ident.readers.limits import Limits
from ident.readers.table import Table


def read_mdf(data: bytes, where: str, limits: Limits) -> Table:
    """The columns with their units. Raises Unusable: ``broken-mdf``, and what :func:`read_apart` raises."""
    return read_apart("mdf", data, where, limits, "install servoident[mdf], or save it as .csv")
