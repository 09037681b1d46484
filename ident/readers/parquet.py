"""Parquet through pyarrow, after the sizes that the file declares have been added up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size
from ident.readers.parquet_pages import unpacked_size
from ident.readers.table import Array, Table, numeric


def read_parquet(data: bytes, where: str, limits: Limits) -> Table:
    """The flat columns of a .parquet. Raises Unusable: ``broken-parquet``, ``not-numeric``, ``too-large``."""
    import pyarrow as pa  # noqa: PLC0415
    from pyarrow import parquet  # noqa: PLC0415

    try:
        file = parquet.ParquetFile(pa.BufferReader(data))
        schema = file.schema
        leaves = [schema.column(number) for number in range(len(schema))]
        names = tuple(leaf.path for leaf in leaves)
    except Exception as error:  # whatever pyarrow meets in a broken file
        raise broken(where) from error

    def load(numbers: Sequence[int]) -> list[Array]:
        check_size(8 * file.metadata.num_rows, limits.channel, "a column", where)
        for number in numbers:
            if leaves[number].max_repetition_level or "." in names[number]:
                what = f"column {names[number]!r} is nested"
                raise Unusable("not-numeric", what, where, "save plain columns of numbers")
            try:
                size = sum(
                    unpacked_size(data, file.metadata.row_group(group).column(number))
                    for group in range(file.metadata.num_row_groups)
                )
            except (IndexError, ValueError, OverflowError) as error:
                raise broken(where) from error
            check_size(size, limits.channel + limits.channel // 8, f"column {names[number]!r}", where)
        return [one_column(file, names[number], where) for number in numbers]

    return Table(names, load)


def one_column(file: Any, name: str, where: str) -> Array:
    """The samples of one column."""
    try:
        array: Array = file.read(columns=[name]).column(0).to_numpy()
    except Exception as error:
        raise broken(where) from error
    return numeric(array, name, where)


def broken(where: str) -> Unusable:
    """The error for a file that is no Parquet."""
    return Unusable("broken-parquet", "this is not a whole Parquet file", where, "write it again")
