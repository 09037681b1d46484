"""Drafts: raw files that wait in a staged store until they are described, and are a matrix, or are forgotten."""

from __future__ import annotations

import io
import json
import shutil
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import PurePosixPath
from typing import BinaryIO

from app.context import Context
from app.errors import missing
from app.lru import LRU
from app.matrices import service as matrices
from app.matrices.stored import Blobs, Revised
from app.storage import Storage
from ident.checks.check import check
from ident.drafts.answers import Answer, Answers, FileAnswers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import RawFile, read_or_shown
from ident.drafts.separate_tables import may_hold_tables, with_tables_apart
from ident.drafts.signal_files import named_runs, with_runs_joined
from ident.drafts.text import as_yaml, run_files
from ident.errors import Unusable
from ident.readers import read_source
from ident.readers.dialect import Dialect, describe_dialect
from ident.readers.limits import LIMITS, check_size
from ident.readers.source import DESCRIPTION, inside, read_regular
from schemas.draft import (
    AnswersRequest,
    AnswerView,
    ColumnView,
    DialectRequest,
    DialectView,
    DraftView,
    FileAnswersRequest,
    MissingView,
    RawFileView,
)
from schemas.matrix import FindingView, MatrixView

_NAMES = "names.json"
_MOST = 2  # drafts in memory
_FIRST = 4  # samples of a column that are shown
_Read = dict[tuple[str, Dialect], tuple[RawFile, ...]]  # by the name and the dialect of a file
_read: LRU[_Read] = LRU(_MOST)


def check_room(context: Context) -> None:
    """Raise Failure 507 where raw files would go at the reserve of the disk: before they are read."""
    matrices.check_room(context)


def begin(context: Context, files: Mapping[str, BinaryIO]) -> DraftView:
    """Keep raw files for a day and say what they hold. Raises Unusable; then nothing is kept."""
    context.storage.tidy()
    name, store = context.storage.begun()
    try:
        whole = _joined(_apart({inside(path, "upload"): content for path, content in files.items()}))
        plain = {PurePosixPath(path).name: content for path, content in whole.items()}
        if len(plain) < len(whole):
            raise Unusable("duplicate-file", "two files have one name", "upload", "give each its own name")
        names = {one: store.put(content) for one, content in sorted(plain.items())}
        (store.folder / _NAMES).write_text(json.dumps(names), encoding="utf-8")
        return look(context, name, AnswersRequest())
    except BaseException:
        shutil.rmtree(store.folder, ignore_errors=True)
        raise


def _apart(files: Mapping[str, BinaryIO]) -> Mapping[str, BinaryIO]:
    """The files, each text that holds several tables as a file of each. Raises Unusable."""
    found: dict[str, BinaryIO] = {}
    for name, file in files.items():
        data = file.read(LIMITS.file + 1) if may_hold_tables(name) else b""
        check_size(len(data), LIMITS.file, "the file", name)
        file.seek(0)
        parts = with_tables_apart([(name, data)])
        found |= {name: file} if len(parts) == 1 else {part: io.BytesIO(content) for part, content in parts}
    return found


def _joined(files: Mapping[str, BinaryIO]) -> Mapping[str, BinaryIO]:
    """The files, those of one signal each as the runs that they are. Raises Unusable."""
    contents: dict[str, bytes] = {}
    parts = {one for run in named_runs(list(files)).values() for one in run}
    for name in sorted(parts):
        contents[name] = files[name].read(LIMITS.file + 1)
        check_size(len(contents[name]), LIMITS.file, "the file", name)
        files[name].seek(0)
    runs = dict(with_runs_joined(list(contents.items())))
    others = {name: content for name, content in files.items() if name not in contents or name in runs}
    return others | {name: io.BytesIO(data) for name, data in runs.items() if name not in others}


def look(context: Context, draft: str, asked: AnswersRequest) -> DraftView:
    """What is known of the files with these answers, what is missing, and, where nothing is, what the check doubts.

    Raises Unusable for answers that fit no file, and Failure 404.
    """
    said = answers(asked)
    of = Draft(raw_files(context, draft, said), said)
    files, lacks = [_file(of, file) for file in of.files], of.missing
    text, findings = "", []
    if not lacks:
        text = as_yaml(of)
        store, names = _opened(context, draft)
        findings = matrices.in_reader(context, _findings, store, run_files(names), text)
    return DraftView(
        id=draft,
        files=files,
        channels=files[0].channels,
        time=files[0].time,
        rate=files[0].rate,
        missing=[MissingView(**asdict(one)) for one in lacks],
        doubts=list(of.doubts),
        findings=findings,
        description=text,
    )


def _findings(store: Storage, files: dict[str, str], text: str) -> list[FindingView]:
    """What the check doubts of files under a description."""
    source = Revised(Blobs(store, files), text.encode())
    return [FindingView(**asdict(finding)) for finding in check(read_source(source))]


def _file(draft: Draft, file: RawFile) -> RawFileView:
    known = draft.known(file)
    by_column = {
        number: name for name, answer in known.channels.items() for number in file.table.numbers(answer.column, "")
    }
    if known.time.column != "":
        by_column[file.table.number(known.time.column, "")] = "time"
    samples = {c.number: file.samples(c.number) for c in file.columns}
    columns = [
        ColumnView(
            number=c.number,
            name=c.name,
            unit=c.unit,
            role=by_column.get(c.number, ""),
            first=samples[c.number][:_FIRST].tolist(),
        )
        for c in file.columns
    ]
    return RawFileView(
        name=file.name,
        samples=max(map(len, samples.values()), default=0),
        columns=columns,
        dialect=DialectView(**asdict(file.head.dialect)),
        lines=list(file.head.lines),
        problem=file.problem,
        channels={name: AnswerView(**asdict(answer)) for name, answer in known.channels.items()},
        time=AnswerView(**asdict(known.time)),
        rate=known.rate,
    )


def make(context: Context, draft: str, asked: AnswersRequest) -> tuple[MatrixView, bool]:
    """The matrix that a draft is with these answers, stored as an upload is; True where it is new.

    Raises Unusable where something is missing or the matrix cannot be, and Failure 404.
    """
    said = answers(asked)
    text = as_yaml(Draft(raw_files(context, draft, said), said))
    store, names = _opened(context, draft)
    described = {DESCRIPTION: store.put(io.BytesIO(text.encode()))}
    found = matrices.record(context, store, {"files": described | run_files(names)}, None)
    shutil.rmtree(store.folder, ignore_errors=True)
    return found


def answers(asked: AnswersRequest) -> Answers:
    """The library's answers. Raises Unusable for a channel that is none."""
    common = {"gain": asked.gain, "hold": asked.hold}
    of_all = _of_file(asked)
    return Answers(
        serial=asked.serial.strip(),
        channels=of_all.channels,
        time=of_all.time,
        rate=of_all.rate,
        dialect=of_all.dialect,
        output=asked.output,
        verify=tuple(asked.verify),
        validation=asked.validation,
        actuator={"piston_area": asked.area} if asked.area else {},
        common={name: text for name, text in common.items() if text},
        files={name: _of_file(of_one) for name, of_one in asked.files.items()},
    )


def _of_file(asked: AnswersRequest | FileAnswersRequest) -> FileAnswers:
    """What is said of a file, or of all. Raises Unusable for a channel that is none."""
    channels = {name: Answer(answer.column, answer.unit) for name, answer in asked.channels.items()}
    time = Answer(asked.time.column, asked.time.unit)
    return FileAnswers(channels, time, asked.rate.strip(), _dialect(asked.dialect))


def _dialect(asked: DialectRequest) -> Dialect:
    stated = asked.model_dump(exclude={"skip_rows"}, exclude_defaults=True)
    return describe_dialect(stated, "dialect", asked.skip_rows)


def raw_files(context: Context, draft: str, said: Answers) -> tuple[RawFile, ...]:
    """The files of a draft in the dialects that were said, from memory where they were read lately so.

    Raises Failure 404, Unusable.
    """
    store, names = _opened(context, draft)
    sizes = [store.path(sha256).stat().st_size for sha256 in names.values()]
    check_size(sum(sizes), LIMITS.total, "all files together", "upload")
    before: _Read = _read.get((str(context.storage.folder), draft), dict)
    now: _Read = {}
    for name, sha256 in names.items():
        dialect = said.of(name).dialect
        now[name, dialect] = before.get((name, dialect)) or read_or_shown(
            read_regular(store.path(sha256), name, LIMITS.file), name, dialect
        )
    before.clear()  # of a file that is read otherwise now nothing is kept
    before.update(now)
    return tuple(one for parts in now.values() for one in parts)


def _opened(context: Context, draft: str) -> tuple[Storage, dict[str, str]]:
    """The staged store of a draft, and its blobs by name. Raises Failure 404."""
    store = context.storage.resumed(draft)
    if store is None or not (store.folder / _NAMES).is_file():
        raise missing("draft", draft)
    names: dict[str, str] = json.loads((store.folder / _NAMES).read_text(encoding="utf-8"))
    return store, names
