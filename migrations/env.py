"""Alembic's entry: runs migrations on the URL it is given."""

from alembic import context
from sqlalchemy import func, select

from app.database import connect
from app.tables import Base

LOCK = 0x5E780  # of PostgreSQL's advisory locks; any number of this program's own

engine = connect(context.config.attributes["url"])
with engine.connect() as connection:
    # Batch mode rebuilds tables in SQLite, and with foreign keys enforced that would delete the rows of children.
    if connection.dialect.name == "sqlite":
        connection.exec_driver_sql("PRAGMA foreign_keys=OFF")
        connection.commit()
    context.configure(connection=connection, target_metadata=Base.metadata, render_as_batch=True)
    with context.begin_transaction():
        if connection.dialect.name == "postgresql":  # processes that start together wait for the first one's tables
            connection.execute(select(func.pg_advisory_xact_lock(LOCK)))
        context.run_migrations()
    if connection.dialect.name == "sqlite":
        broken = connection.exec_driver_sql("PRAGMA foreign_key_check").fetchall()
        if broken:
            raise RuntimeError(f"{len(broken)} rows lost their parent in a migration")
    connection.commit()
engine.dispose()
