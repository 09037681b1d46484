"""Every query of a backup: whole tables, as the database itself describes them, whichever version made it."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from itertools import islice
from typing import Any

from sqlalchemy import Connection, Engine, LargeBinary, MetaData, Table, func, insert, select, text

_AT_A_TIME = 1000
_REVISION = "alembic_version"
_PASSING = {_REVISION, "workers"}
"""What is not kept: which processes run, and the schema's own mark, which the list has."""


@contextmanager
def snapshot(engine: Engine) -> Iterator[Connection]:
    """A connection that sees one moment, whatever others write meanwhile."""
    lite = engine.dialect.name == "sqlite"
    with engine.connect() as plain:
        connection = plain.execution_options(isolation_level="AUTOCOMMIT" if lite else "REPEATABLE READ")
        if lite:  # whose driver begins no transaction for what only reads
            connection.exec_driver_sql("BEGIN")
        yield connection
        connection.exec_driver_sql("ROLLBACK") if lite else connection.rollback()


def revision(connection: Connection) -> str:
    """That of the schema."""
    return str(connection.exec_driver_sql(f"SELECT version_num FROM {_REVISION}").scalar_one())


def tables(connection: Connection) -> Sequence[Table]:
    """The tables, each after those that it refers to; the queue's own are elsewhere, and no part of it."""
    described = MetaData()
    described.reflect(connection)
    return [table for table in described.sorted_tables if table.name not in _PASSING]


def holds_anything(connection: Connection) -> bool:
    """Whether any table has a row."""
    return any(connection.execute(select(table).limit(1)).first() for table in tables(connection))


def lines(connection: Connection, table: Table) -> Iterator[bytes]:
    """The rows as lines of JSON, parents before children."""
    order = [column for column in (table.columns.get("created_at"), *table.primary_key) if column is not None]
    binary = {column.name for column in table.columns if isinstance(column.type, LargeBinary)}
    found = connection.execution_options(yield_per=_AT_A_TIME).execute(select(table).order_by(*order))
    for row in found.mappings():
        values = {name: _text(value) if name in binary else value for name, value in row.items()}
        yield json.dumps(values, separators=(",", ":")).encode() + b"\n"


def fill(connection: Connection, table: Table, rows: Iterable[bytes]) -> None:
    """Insert rows; one that is numbered by the database goes on from the last."""
    binary = {column.name for column in table.columns if isinstance(column.type, LargeBinary)}
    entries = (_row(json.loads(line), binary) for line in rows)
    while some := list(islice(entries, _AT_A_TIME)):
        connection.execute(insert(table), some)
    number_on(connection, table)


def number_on(connection: Connection, table: Table) -> None:
    """Have the database number rows from the last one that is there, where it numbers them."""
    (column, *others) = table.primary_key
    if connection.dialect.name == "postgresql" and not others and column.type.python_type is int:
        last = select(func.max(column)).scalar_subquery()
        place = func.pg_get_serial_sequence(table.name, column.name)
        connection.execute(select(func.setval(place, last)).where(place.is_not(None), last.is_not(None)))


def requeue(connection: Connection) -> None:
    """Jobs that were under way wait again."""
    connection.execute(text("UPDATE jobs SET state = 'queued' WHERE state = 'running'"))


def _row(values: dict[str, Any], binary: set[str]) -> dict[str, Any]:
    return {
        name: value if name not in binary or value is None else base64.b85decode(value)
        for name, value in values.items()
    }


def _text(value: bytes | None) -> str | None:
    return None if value is None else base64.b85encode(value).decode()
