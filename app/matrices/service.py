"""Uploads: checked before anything is recorded, kept byte for byte, mended by revisions."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any, BinaryIO, TypeVar

import yaml
from sqlalchemy.exc import IntegrityError

from app.access.audited_changes import about
from app.context import Context
from app.errors import missing
from app.matrices import levels, repository
from app.matrices.removed import check_there
from app.matrices.stored import load_row, opened, read_stored
from app.paging import cursor, keys_of
from app.reserve import check_reserve
from app.storage import Storage
from app.tables import MatrixRow
from ident.checks.check import check
from ident.decimation.levels import Levels
from ident.errors import Unusable
from ident.matrix import Actuator, Matrix
from ident.preprocessing import screen
from ident.readers.limits import LIMITS
from ident.readers.source import DESCRIPTION, inside
from ident.readers.split import validation_id
from ident.readers.strict_yaml import read_yaml
from ident.run import Run, output_id
from ident.words.nearest import did_you_mean
from schemas.matrix import FindingView, MatrixPage, MatrixView, Revision, RunView

Made = TypeVar("Made")
LONGEST = 200  # characters of a serial number or batch


def upload(context: Context, files: Mapping[str, BinaryIO]) -> tuple[MatrixView, bool]:
    """Store a matrix from one .zip, or from matrix.yaml and its files by name; True where it is new.

    Raises Unusable; then nothing is kept.
    """
    with context.storage.staged() as staged:
        if len(files) == 1 and DESCRIPTION not in files:
            source: dict[str, Any] = {"zip": staged.put(next(iter(files.values())))}
        else:
            source = {"files": {inside(name, "upload"): staged.put(content) for name, content in files.items()}}
        return record(context, staged, source, None)


def check_room(context: Context) -> None:
    """Raise Failure 507 where an upload would go at the reserve of the disk: before it is read."""
    check_reserve(context)


def record(context: Context, staged: Storage, source: dict[str, Any], parent: str | None) -> tuple[MatrixView, bool]:
    """Read and check a source; keep its blobs and record it where it is new."""
    actuator, shown, source = in_reader(context, _read, staged, source)
    identity = shown["data_hash"][:32]
    with context.sessions() as session:
        known = repository.find(session, identity)
        if known is not None and known.removed_at is None:
            return view(known), False
        about(f"matrices/{identity}")
        if known is not None:  # its raw runs are back
            known.source, known.removed_at = source, None
            staged.keep()
            session.commit()
            return view(known), False
    with context.sessions() as session:
        try:
            row = repository.add(session, identity, actuator, source, shown, parent)
            staged.keep()
            session.commit()
        except IntegrityError:  # the same upload twice at the same moment
            session.rollback()
            return get(context, identity), False
    return view(row), True


def in_reader(context: Context, act: Callable[..., Made], *given: Any) -> Made:
    """What a function makes of an upload, where those are read. Raises Unusable where there is no memory for it."""
    try:
        return context.readers.call(act, *given)
    except MemoryError:
        what = "it needs more memory than there is"
        raise Unusable("out-of-memory", what, "upload", "upload fewer or shorter runs at a time") from None


def _read(staged: Storage, source: dict[str, Any]) -> tuple[Actuator, dict[str, Any], dict[str, Any]]:
    """The actuator of an upload, what is shown of it, and its source, with levels if large. Raises Unusable."""
    matrix = read_stored(staged, source)
    for name in ("serial", "batch"):
        length = len(getattr(matrix.actuator, name))
        if length > LONGEST:
            raise Unusable("too-long", f"{length} characters where {LONGEST} fit", f"actuator {name}", "shorten it")
    shown = summary(matrix)
    own = {key: value for key, value in source.items() if key != levels.KEY}  # not those of what a revision is of
    if levels.is_large(shown["runs"]):
        own[levels.KEY] = levels.stored_levels(matrix, staged)
    return matrix.actuator, shown, own


def revise(context: Context, matrix: str, revision: Revision) -> tuple[MatrixView, bool]:
    """A new matrix with other labels, units or signs and the same raw bytes."""
    row = find(context, matrix)
    description = _described(context, row)
    _merge(description["actuator"], revision.actuator)
    runs = {str(run["id"]): run for run in description["runs"]}
    for given, changes in revision.runs.items():
        name = _record_of(given, runs)
        if name not in runs:
            remedy = did_you_mean(name, runs, f"choose from {', '.join(list(runs)[:20])}")
            raise Unusable("unknown-run", f"there is no run {name!r}", "runs", remedy)
        _merge(runs[name], changes)
    with context.storage.staged() as staged:
        sha256 = staged.put(io.BytesIO(_yaml(description)))
        return record(context, staged, {**row.source, "description": sha256}, matrix)


def _record_of(run: str, records: Mapping[str, Mapping[str, Any]]) -> str:
    """The record that a run is an output or the validation data of; the run itself where it is a record."""
    found: dict[str, str] = {}
    for name, record in records.items():
        outputs = record["output"] if isinstance(record.get("output"), list) else ()
        for part in (name, validation_id(name)) if "split" in record else (name,):
            found |= {part: name} | {output_id(part, str(output)): name for output in outputs}
    return run if run in records else found.get(run, run)


def description(context: Context, matrix: str) -> dict[str, Any]:
    """What a revision changes: matrix.yaml as it stands; raises Failure 404."""
    return _described(context, find(context, matrix))


def _described(context: Context, row: MatrixRow) -> dict[str, Any]:
    """The description of a recorded matrix. Raises Removed."""
    check_there(row)
    with opened(context.storage, row.source) as files:
        found: dict[str, Any] = read_yaml(files.read(DESCRIPTION, LIMITS.description), DESCRIPTION)
    return found


def _yaml(description: dict[str, Any]) -> bytes:
    try:
        return yaml.safe_dump(description, sort_keys=False, allow_unicode=True).encode()
    except (RecursionError, UnicodeEncodeError):
        raise Unusable(
            "bad-revision", "the changes cannot be written as YAML", "runs", "keep to the matrix format"
        ) from None


def _merge(target: dict[str, Any], changes: Mapping[str, Any]) -> None:
    """JSON merge patch (RFC 7396)."""
    for name, value in changes.items():
        if value is None:
            target.pop(name, None)
        elif isinstance(value, dict) and isinstance(target.get(name), dict):
            _merge(target[name], value)
        else:
            target[name] = value


def find(context: Context, matrix: str) -> MatrixRow:
    """The record of a matrix, also of one whose raw runs are gone; raises Failure 404."""
    with context.sessions() as session:
        row = repository.find(session, matrix)
    if row is None:
        raise missing("matrix", matrix)
    return row


def get(context: Context, matrix: str) -> MatrixView:
    """A matrix and its findings."""
    return view(find(context, matrix))


def listed(context: Context, serial: str | None, after: str | None, limit: int) -> MatrixPage:
    """A page of matrices."""
    with context.sessions() as session:
        rows = repository.page(session, serial, keys_of(after, 2), limit)
    following = cursor(rows[-1].created_at, rows[-1].id) if len(rows) == limit else None
    return MatrixPage(items=[view(row) for row in rows], next=following)


def newer(context: Context, matrix: str) -> str | None:
    """The newest revision that comes from a matrix; None where it is the newest itself."""
    with context.sessions() as session:
        found = repository.newest(session, matrix)
    return found if found != matrix else None


def drawn_from(context: Context, matrix: str) -> tuple[Sequence[Run], Levels | None]:
    """The runs of a matrix as they are drawn before any fit, those of a large one from stored levels.

    Raises Failure 404, Removed, Unusable.
    """
    row = find(context, matrix)
    return levels.levelled(context, row, in_reader) or (load_row(context.storage, row).runs, None)


def load(context: Context, matrix: str) -> Matrix:
    """The samples of a matrix, from memory where it was used lately."""
    return load_row(context.storage, find(context, matrix))


def summary(matrix: Matrix) -> dict[str, Any]:
    """What is shown of a matrix without its samples, with the runs that a fit takes out of it."""
    matrix = screen(matrix)
    return {
        "data_hash": matrix.data_hash,
        "runs": [_run(run) for run in matrix.runs],
        "findings": [asdict(finding) for finding in check(matrix)],
        "notices": list(matrix.notices),
        "machine": matrix.machine,
        "states_oil": matrix.actuator.states_oil,
    }


def _run(run: Run) -> dict[str, Any]:
    specimen = run.specimen
    return {
        "id": run.id,
        "use": run.use,
        "kind": run.kind,
        "hold": run.hold,
        "output": run.output,
        "samples": run.length,
        "sample_rate": run.sample_rate,
        "duration": run.duration,
        "gain": run.gain,
        "amplitude": run.amplitude,
        "mass": specimen.mass if specimen else None,
        "stiffness": specimen.stiffness if specimen else None,
        "damping": specimen.damping if specimen else None,
        "channels": list(run.channels),
        "units": dict(run.units),
        "time_unit": run.time_unit,
    }


def view(row: MatrixRow) -> MatrixView:
    """A matrix as it is sent."""
    shown = row.summary
    return MatrixView(
        id=row.id,
        serial=row.serial,
        parent=row.parent,
        created_at=row.created_at,
        data_hash=shown["data_hash"],
        batch=row.batch,
        piston_area=row.piston_area,
        runs=[RunView(**run) for run in shown["runs"]],
        findings=[FindingView(**f) for f in shown["findings"]],
        notices=shown["notices"],
        machine=shown.get("machine", ""),
        removed_at=row.removed_at,
        states_oil=shown.get("states_oil", row.piston_area is not None),
    )
