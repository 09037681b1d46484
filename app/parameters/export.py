"""Parameter sets as CSV and Parquet: all that are asked for, however many, a block of rows at a time."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from typing import Any

from app.context import Context
from app.parameters import repository
from app.parameters.set_query import SetQuery

_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # a spreadsheet would run a text cell that begins so
_BLOCK = 2000  # sets in memory
_KINDS = {
    "id": "text", "serial": "text", "batch": "text", "model": "text", "created_at": "text", "approved_at": "text",
    "current": "bool", "error_fit": "number", "error_verify": "number", "data_hash": "text", "seed": "int",
    "version": "text", "equations": "text", "who": "text", "error_with_mean_fit": "number",
    "error_with_mean_verify": "number", "unstable_fit": "names", "unstable_verify": "names",
}  # fmt: skip
"""The columns before those of the parameters, and what they hold; names are written one after the other."""


def csv_rows(context: Context, wanted: SetQuery) -> Iterator[str]:
    """A parameter a column with its unit in the header; text cells never begin a formula."""
    names, blocks = _table(context, wanted)
    yield _lines([[_cell(name) for name in names]])
    for rows in blocks:
        yield _lines([[_cell(value) for value in row] for row in rows])


def parquet_blocks(context: Context, wanted: SetQuery) -> Iterator[bytes]:
    """The same table as Parquet, a block a row group."""
    import pyarrow as pa  # noqa: PLC0415  slow to import, and seldom wanted
    import pyarrow.parquet as pq  # noqa: PLC0415

    names, blocks = _table(context, wanted)
    types = {"bool": pa.bool_(), "int": pa.int64(), "text": pa.string(), "names": pa.string(), "number": pa.float64()}
    schema = pa.schema([(name, types[_KINDS.get(name, "number")]) for name in names])
    sink = io.BytesIO()
    with pq.ParquetWriter(sink, schema) as writer:
        for rows in blocks:
            columns = zip(*rows, strict=True) if rows else [()] * len(names)
            writer.write_table(pa.table([list(column) for column in columns], schema))
            yield sink.getvalue()
            sink.seek(0)
            sink.truncate()
    yield sink.getvalue()


def _table(context: Context, wanted: SetQuery) -> tuple[list[str], Iterator[list[list[Any]]]]:
    """The names of the columns, and the rows in blocks."""
    with context.sessions() as session:
        parameters = repository.titles(session, wanted)
    columns = [f"{before}{name} ({unit})" for name, unit in parameters for before in ("", "std_error ")]
    return [*_KINDS, *columns], _blocks(context, wanted, parameters)


def _blocks(context: Context, wanted: SetQuery, parameters: Sequence[tuple[str, str]]) -> Iterator[list[list[Any]]]:
    """Rows, newest first; each block is read by itself, so that the reader's pace holds no transaction open."""
    before: int | None = None
    while True:
        with context.sessions() as session:
            sets = repository.sets(session, wanted, before, _BLOCK)
            rows = [_row(one, parameters) for one in sets]
        if rows or before is None:
            yield rows
        if len(rows) < _BLOCK:
            return
        before = sets[-1].number


def _row(one: repository.FoundSet, parameters: Sequence[tuple[str, str]]) -> list[Any]:
    values = {(value.name, value.unit): (value.value, value.std_error) for value in one.values}
    cells = [getattr(one, "fit" if name == "id" else name) for name in _KINDS]
    cells = [", ".join(cell) if kind == "names" else cell for cell, kind in zip(cells, _KINDS.values(), strict=True)]
    return cells + [cell for parameter in parameters for cell in values.get(parameter, (None, None))]


def _lines(rows: Sequence[Sequence[Any]]) -> str:
    out = io.StringIO()
    csv.writer(out).writerows(rows)
    return out.getvalue()


def _cell(value: Any) -> Any:
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value
