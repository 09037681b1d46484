"""A database as a production line has it after years: many sets of many actuators, with values drawn at random.

Numbers are drawn independently, so that a range between two quantiles matches the share of sets that lies between.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from typing import Any, cast

import numpy as np
from sqlalchemy import Engine, Table

from app.backup.repository import number_on
from app.database import connect, migrate
from app.tables import ActuatorRow, ApprovalRow, Base, FitRow, MatrixRow, SetRow, ValueRow

PARAMETERS = {
    "Z0": (2.6e-6, 5e-8, "m^4/s"),
    "tau": (2.6e-3, 1e-4, "s"),
    "Cl": (1.5e-11, 2e-12, "m^3/(s*Pa)"),
    "c0": (580.0, 40.0, "N*s/m"),
    "m0": (4.25, 0.1, "kg"),
    "Ka": (1.2e-13, 1e-14, "m^3/Pa"),
}
"""Mean, standard deviation and unit of each."""
RESULT = {"notes": ["x" * 1960]}
_AT_A_TIME = 20_000


def moment(number: int) -> str:
    """When the set of a number was made: a second after the one before."""
    return (datetime(2026, 1, 1, tzinfo=UTC) + timedelta(seconds=number)).isoformat(timespec="microseconds")


def fill(url: str, sets: int, batches: int = 1000, per_serial: float = 10 / 3, seed: int = 1) -> Engine:
    """Migrate an empty database and fill it: every third set is in force for its serial, one in ten was."""
    migrate(url)
    engine = connect(url)
    serials = max(1, round(sets / per_serial))
    tables = (ActuatorRow, MatrixRow, FitRow, SetRow, ValueRow, ApprovalRow)
    indexes = [index for table in tables for index in table.__table__.indexes]  # made at the end, by sorting
    with engine.begin() as connection:
        for index in indexes:
            index.drop(connection)
        raw: Any = connection.connection.driver_connection
        copy = _copied if engine.dialect.name == "postgresql" else _inserted
        batch = [f"B{number % batches:04}" for number in range(serials)]
        copy(raw, ActuatorRow, ((_serial(n), "", batch[n], None, moment(0)) for n in range(serials)))
        source = json.dumps({})
        copy(
            raw,
            MatrixRow,
            ((f"m{n}", _serial(n), None, batch[n], None, moment(0), source, source, None) for n in range(serials)),
        )
        result = json.dumps(RESULT)
        copy(raw, FitRow, ((f"{n:032x}", f"m{n % serials}", _serial(n % serials), None, "qian2014", moment(n), result)
                           for n in range(1, sets + 1)))  # fmt: skip
        copy(raw, SetRow, ((n, f"{n:032x}", _serial(n % serials), batch[n % serials], "qian2014", moment(n), 0.01, 0.02,
                            0.01, 0.02, "[]", "[]", "[]", "d" * 64, 0, "1.0", "e" * 64, "lab")
                           for n in range(1, sets + 1)))  # fmt: skip
        copy(raw, ValueRow, _values(sets, seed))
        copy(raw, ApprovalRow, _approvals(sets, serials))
        for table in (SetRow, ApprovalRow):
            number_on(connection, cast(Table, table.__table__))
        for index in indexes:
            index.create(connection)
    with engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        connection.exec_driver_sql("VACUUM ANALYZE" if engine.dialect.name == "postgresql" else "PRAGMA optimize")
    return engine


def _serial(number: int) -> str:
    return f"SW-{number:06}"


def _values(sets: int, seed: int) -> Iterator[tuple[Any, ...]]:
    draw = np.random.default_rng(seed)
    for first in range(1, sets + 1, _AT_A_TIME):
        numbers = range(first, min(first + _AT_A_TIME, sets + 1))
        drawn = {name: draw.normal(mean, std, len(numbers)).tolist() for name, (mean, std, _) in PARAMETERS.items()}
        for row, number in enumerate(numbers):
            for place, (name, (_, std, unit)) in enumerate(PARAMETERS.items()):
                yield number, name, place, drawn[name][row], unit, 0.1 * std


def _approvals(sets: int, serials: int) -> Iterator[tuple[Any, ...]]:
    """The newest set of each serial number is in force, after one in ten of those before."""
    for identity, number in enumerate(n for n in range(1, sets + 1) if n > sets - serials or n % 10 == 0):
        until = None if number > sets - serials else moment(number + 1)
        yield identity + 1, _serial(number % serials), number, moment(number), until, "lab", "as drawn"


def _inserted(raw: Any, table: type[Base], rows: Iterator[tuple[Any, ...]]) -> None:
    columns = table.__table__.columns.keys()
    places = ", ".join("?" for _ in columns)
    raw.executemany(f"INSERT INTO {table.__tablename__} ({', '.join(columns)}) VALUES ({places})", rows)


def _copied(raw: Any, table: type[Base], rows: Iterator[tuple[Any, ...]]) -> None:
    columns = ", ".join(table.__table__.columns.keys())
    with raw.cursor().copy(f"COPY {table.__tablename__} ({columns}) FROM STDIN") as copy:
        for row in rows:
            copy.write_row(row)
