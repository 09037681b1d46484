"""A backup of a running service, and a service from a backup: in either database, with blobs in either store."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from alembic.script import ScriptDirectory

from app.backup import repository
from app.backup.container import Reader, Writer
from app.blobs import open_storage
from app.database import MIGRATIONS, connect, migrate, reachable, shown
from app.settings import Settings
from ident.errors import Unusable

_NAME = re.compile(rb"(?<![0-9a-f])[0-9a-f]{64}(?![0-9a-f])")


@dataclass(frozen=True)
class Held:
    """What a backup holds."""

    rows: dict[str, int]
    blobs: int


def backup(settings: Settings, file: Path) -> Held:
    """Write all records and the blobs that they name, as they are at one moment; the service may run meanwhile."""
    engine, storage = connect(settings.database), open_storage(settings)
    if not reachable(engine):
        raise Unusable(
            "no-database",
            "it does not answer, or holds nothing yet",
            shown(settings.database),
            "give the --data or the --database of the service",
        )
    stored, named = {blob.sha256 for blob in storage.blobs()}, set[str]()
    with tempfile.TemporaryDirectory(dir=file.parent, prefix=f".{file.name}-") as folder:
        writer = Writer(Path(folder) / "backup")
        with repository.snapshot(engine) as connection:
            revision = repository.revision(connection)
            for table in repository.tables(connection):
                writer.table(table.name, _noting(repository.lines(connection, table), named))
        later = {blob.sha256 for blob in storage.blobs()}  # the records may name what came after the first look
        for sha256 in sorted(named & (stored | later)):
            writer.blob(sha256, storage.path(sha256))
        writer.close(revision=revision, version=version("servoident"))
        writer.file.replace(file)
    engine.dispose()
    return _held(writer.tables, len(writer.blobs))


def restore(settings: Settings, file: Path) -> Held:
    """Make an empty database and store of blobs what a backup holds. Raises Unusable; then no record is written."""
    reader = Reader(file)
    listed = reader.listed
    if listed["revision"] not in {script.revision for script in ScriptDirectory(str(MIGRATIONS)).walk_revisions()}:
        what = f"version {listed['version']} of the program made it, with a schema that this one does not know"
        raise Unusable("newer-backup", what, str(file), "restore it with that version or a later one")
    settings.make_folders()
    engine, storage = connect(settings.database), open_storage(settings)
    migrate(settings.database, listed["revision"])
    with engine.connect() as connection:
        if repository.holds_anything(connection):
            what = "there are records already, and a backup is no addition to them"
            raise Unusable("not-empty", what, shown(settings.database), "restore into an empty database and folder")
    for sha256 in listed["blobs"]:
        with reader.blob(sha256) as content:
            storage.put(content)  # type: ignore[arg-type]
    with engine.begin() as connection:
        for table in repository.tables(connection):
            if table.name in listed["tables"]:
                repository.fill(connection, table, reader.lines(table.name))
        repository.requeue(connection)
    engine.dispose()
    migrate(settings.database)
    return _held(listed["tables"], len(listed["blobs"]))


def named(settings: Settings) -> set[str]:
    """Every name of a blob that stands anywhere in the records, and others that look like one."""
    engine, found = connect(settings.database), set[str]()
    with repository.snapshot(engine) as connection:
        for table in repository.tables(connection):
            for _ in _noting(repository.lines(connection, table), found):
                pass
    engine.dispose()
    return found


def _noting(lines: Iterator[bytes], named: set[str]) -> Iterator[bytes]:
    """The lines, each looked through for names of blobs."""
    for line in lines:
        named.update(name.decode() for name in _NAME.findall(line))
        yield line


def _held(tables: dict[str, Any], blobs: int) -> Held:
    return Held({name: table["rows"] for name, table in tables.items()}, blobs)
