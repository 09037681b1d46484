"""JSON through :mod:`ident.foreign.records`, in a process of its own."""

from __future__ import annotations

from ident.readers.apart import read_apart
from ident.readers.limits import Limits
from ident.readers.table import Table


def read_records(data: bytes, where: str, limits: Limits) -> Table:
    """The columns with their units. Raises Unusable: ``broken-records``, and what :func:`read_apart` raises."""
    return read_apart("records", data, where, limits)
