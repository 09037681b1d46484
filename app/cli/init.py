"""`servoident init`: raw files of a bench, described: a matrix folder."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Mapping
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.arguments import split
from app.cli.check import description, line
from app.cli.output import write_bytes
from ident.errors import Unusable
from ident.words.message import message
from ident.words.nearest import did_you_mean
from ident.words.number import count
from ident.words.severity import levels

if TYPE_CHECKING:
    from ident.drafts.answers import Answer, Answers, FileAnswers
    from ident.drafts.draft import Draft, Missing
    from ident.drafts.raw_file import RawFile
    from ident.drafts.text import Gathered
    from ident.readers.dialect import Dialect

_SHOWN = 5  # names of files in a remedy
_LONGEST = 400  # signs of what was given, in a remedy: of more the files are left out
_FORM = "NAME=COLUMN:UNIT"
_OF_FILE = "@"
"""Before the name of a file, or a pattern of names, that an answer is about."""
_Texts = list[str] | None


def init(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILES…", help="Raw files of one actuator, or their folder: one run or one signal per file."
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(metavar="MATRIX", help="Folder to write, with matrix.yaml and runs/. Default: the serial number."),
    ] = None,
    serial: Annotated[str, typer.Option(metavar="SERIAL", help="Serial number of the actuator.")] = "",
    channel: Annotated[
        _Texts,
        typer.Option(
            metavar=_FORM,
            help="Column of a channel, by name or number from 0, and its unit. NAME=:UNIT: the "
            "unit alone. NAME=-: not recorded. NAME@FILE=COLUMN:UNIT: in some files only (b.csv, b*). "
            "May be repeated.",
        ),
    ] = None,
    time: Annotated[
        _Texts,
        typer.Option(
            metavar="COLUMN:UNIT",
            help="Time column and its unit; @FILE=COLUMN:UNIT: in some files only. May be repeated.",
        ),
    ] = None,
    rate: Annotated[
        _Texts,
        typer.Option(
            metavar="HZ",
            help="Sample rate, such as '4096 Hz', if there is no time column; with --time the rate "
            "to which the record is brought; @FILE=HZ: in some files only. May be repeated.",
        ),
    ] = None,
    dialect: Annotated[
        _Texts,
        typer.Option(
            metavar="KEY=VALUE",
            help="Layout of a text file: delimiter, decimal, header_rows, skip_rows or "
            "encoding, if it is not detected. @FILE=KEY=VALUE: in some files only. May be repeated.",
        ),
    ] = None,
    output: Annotated[str, typer.Option(metavar="NAME", help="Output channel of the model.")] = "",
    verify: Annotated[
        _Texts,
        typer.Option(
            metavar="FILE",
            help="A validation run: one of FILES, with or without its suffix, or another file; may be repeated.",
        ),
    ] = None,
    validation: Annotated[
        float,
        typer.Option(
            metavar="SHARE",
            help="Share of each run, at its end, for validation, such as 0.3; a gap as long "
            "as the response stays before it.",
        ),
    ] = 0.0,
    area: Annotated[str, typer.Option(metavar="AREA", help="Piston area, such as '497 mm^2'.")] = "",
    gain: Annotated[str, typer.Option(metavar="KP", help="Loop gain of all runs.")] = "",
    hold: Annotated[str, typer.Option(metavar="NAME", help="Command between samples: linear, zoh, band-limited.")] = "",
) -> None:
    """Describe raw files and write matrix.yaml.

    It detects columns, units, time and sample rate. Files of one signal each are joined to runs by their names, such as
    pos_A.txt and vel_A.txt. On a terminal it asks for what is missing; elsewhere it lists what
    is missing and stops. It checks the data set and prints all errors, warnings and notes.
    """
    from ident.drafts.answers import NONE, Answers
    from ident.drafts.draft import Draft
    from ident.drafts.separate_tables import with_tables_apart
    from ident.drafts.signal_files import with_runs_joined
    from ident.drafts.text import gathered

    if out is not None:
        _free(out)
    given_files, files = files, _with_validation([file for one in files for file in _records(one)], verify or [])
    tables = with_tables_apart([(str(one), _content(one)) for one in files])
    whole = [(Path(name).name, data) for name, data in with_runs_joined(tables)]
    given = {"gain": gain, "hold": hold}
    names = [name for name, _ in whole]
    of_all, of_some = _said(names, channel or [], time or [], rate or [], dialect or [])
    dialects = {name: of_some[name].over(of_all).dialect if name in of_some else of_all.dialect for name in names}
    of_files = [(one, data) for name, data in whole for one in _parts(data, name, files, dialects[name])]
    found, contents = [one for one, _ in of_files], [data for _, data in of_files]
    answers = Answers(
        serial=serial,
        channels=of_all.channels,
        time=of_all.time,
        rate=of_all.rate,
        dialect=of_all.dialect,
        files=of_some,
        output=output,
        verify=tuple(_among(names, name, "--verify") for name in verify or []),
        validation=validation,
        actuator={"piston_area": area} if area else {},
        common={name: text for name, text in given.items() if text},
    )
    draft = Draft(found, answers)
    while draft.missing and sys.stdin.isatty():
        draft = _asked(draft, NONE)
    if draft.missing:
        said = {"--out": out, "--serial": serial, "--channel": channel, "--time": time, "--rate": rate,
                "--dialect": dialect, "--output": output, "--verify": verify,
                "--validation": validation, "--area": area, "--gain": gain, "--hold": hold}  # fmt: skip
        raise _with_command(draft, given_files, said)
    made = gathered(draft, contents)
    _made(draft, made, _free(out or _of_serial(draft.answers.serial)))


def _records(given: Path) -> list[Path]:
    """A file, or the records of a folder by name. Raises Unusable where it has none."""
    from ident.readers import ENDINGS, ending_of

    if not given.is_dir():
        return [given]
    found = sorted(file for file in given.iterdir() if file.is_file() and ending_of(file.name) in ENDINGS)
    if not found:
        what, remedy = "the folder holds no records", f"name a folder with files of {', '.join(ENDINGS)}"
        raise Unusable("missing-file", what, str(given), remedy)
    return found


def _with_validation(files: list[Path], verify: list[str]) -> list[Path]:
    """The files, and those that are there and are named as validation runs alone."""
    names = {name for file in files for name in (file.name, file.stem)}
    return [*files, *(Path(one) for one in verify if Path(one).name not in names and Path(one).is_file())]


def _with_command(draft: Draft, files: list[Path], said: Mapping[str, object]) -> Unusable:
    """That something is missing, with the whole command that says it: what was given, and every option that lacks."""
    given = [str(file) for file in files]
    for option, value in said.items():
        for one in value if isinstance(value, list) else [value] if value else []:
            given += [option, str(one)]
    named = shlex.join(given) if len(shlex.join(given)) <= _LONGEST else f"FILES… {shlex.join(given[len(files) :])}"
    what = str(message("draft.missing", questions=[one.question for one in draft.missing]))
    command = f"servoident init {' '.join((named.strip(), *draft.options))}"
    remedy = str(message("draft.command_whole" if draft.is_whole else "draft.command", command=command))
    if draft.is_parted:
        remedy = str(message("draft.parted"))
    return Unusable("not-stated", what, "init", remedy)


def _free(out: Path) -> Path:
    """A folder that holds no matrix yet. Raises Unusable."""
    if (out / "matrix.yaml").exists():
        raise Unusable("there-already", "there is a matrix.yaml", str(out), "name another folder with --out")
    return out


def _of_serial(serial: str) -> Path:
    """The folder that is named as a serial number. Raises Unusable where none can be."""
    if Path(serial).name != serial or serial.startswith("."):
        raise Unusable("bad-name", f"no folder can be named {serial!r}", "--serial", "name one with --out")
    return Path(serial)


def _among(names: list[str], name: str, where: str) -> str:
    """The name of one of the files, given with its suffixes or without. Raises Unusable."""
    wanted = Path(name).name
    found = [wanted] if wanted in names else [one for one in names if one.startswith(f"{wanted}.")]
    if len(found) != 1:
        what = str(message("draft.no_file" if not found else "draft.several_files", name=name))
        remedy = f"name one of {', '.join(names[:_SHOWN])}"
        known = (*names, *(Path(one).stem for one in names))
        raise Unusable("missing-file", what, where, remedy if found else did_you_mean(wanted, known, remedy))
    return found[0]


def _made(draft: Draft, files: Gathered, out: Path) -> None:
    """Check the matrix, write it, and say what was taken and what is doubted."""
    from ident.checks.check import check
    from ident.drafts.text import drafted
    from ident.preprocessing import screen

    matrix = screen(drafted(files))
    _write(files, out)
    findings = check(matrix)
    noticed = {notice.replace("runs/", "", 1) for notice in matrix.notices}  # which the description shows
    taken = [f"taken: {doubt}" for doubt in draft.doubts if doubt not in noticed]
    print("\n".join([*taken, *description(matrix)]))
    for finding in findings:
        print(line(finding))
    print(levels([finding.severity for finding in findings], all_of=True))
    print(f"wrote {out / 'matrix.yaml'} and {count(len(files.files) - 1, 'file')}; next: servoident fit {out}")


def _parts(content: bytes, name: str, files: list[Path], dialect: Dialect) -> tuple[RawFile, ...]:
    """The runs of a file. Raises Unusable; for one signal alone with the command that joins the files given."""
    from ident.drafts.raw_file import read_parts

    try:
        return read_parts(content, name, stated=dialect)
    except Unusable as refused:
        if refused.code != "one-signal" or len(files) == 1:
            raise
        named = " ".join(map(str, files[:_SHOWN])) + (" …" if len(files) > _SHOWN else "")
        remedy = f"where these are one run, join them: servoident join {named} --out run.csv"
        raise Unusable(refused.code, refused.what, refused.where, remedy) from None


def _content(file: Path) -> bytes:
    from ident.readers.limits import LIMITS
    from ident.readers.source import read_regular

    return read_regular(file, file.name, LIMITS.file)


def _said(
    names: list[str], channels: list[str], times: list[str], rates: list[str], dialects: list[str]
) -> tuple[FileAnswers, dict[str, FileAnswers]]:
    """What the options say of all files, and of some of them by name. Raises Unusable."""
    from ident.drafts.answers import FileAnswers

    given: list[tuple[str, FileAnswers]] = []
    for text in channels:
        name, value = split(text, "--channel", _FORM)
        channel, _, pattern = name.partition(_OF_FILE)
        given.append((pattern, FileAnswers({channel: _answer(value)})))
    for text in times:
        pattern, value = _at(text, "--time")
        given.append((pattern, FileAnswers(time=_answer(value))))
    for text in rates:
        pattern, value = _at(text, "--rate")
        given.append((pattern, FileAnswers(rate=value)))
    for text in dialects:
        pattern, value = _at(text, "--dialect")
        given.append((pattern, FileAnswers(dialect=_dialect(value))))
    of_all, of_some = FileAnswers(), dict[str, FileAnswers]()
    for pattern, one in given:
        if not pattern:
            of_all = one.over(of_all)
        for name in _matching(names, pattern) if pattern else ():
            of_some[name] = one.over(of_some.get(name, FileAnswers()))
    return of_all, of_some


def _dialect(text: str) -> Dialect:
    """`KEY=VALUE` of a dialect. Raises Unusable."""
    from ident.readers.dialect import KEYS, describe_dialect

    key, value = split(text, "--dialect", "KEY=VALUE")
    known = int(value) if value.isdigit() else value
    if key == "skip_rows" and isinstance(known, int):
        return describe_dialect({}, "--dialect", known)
    if key not in KEYS:
        remedy = did_you_mean(key, (*KEYS, "skip_rows"))
        raise Unusable("bad-option", f"a dialect has no {key!r}", "--dialect", remedy)
    return describe_dialect({key: known}, "--dialect")


def _at(text: str, option: str) -> tuple[str, str]:
    """`@FILE=VALUE` or `VALUE`: the file, or nothing, and the value. Raises Unusable."""
    if not text.startswith(_OF_FILE):
        return "", text
    pattern, value = split(text, option, f"{_OF_FILE}FILE=VALUE")
    return pattern.removeprefix(_OF_FILE), value


def _matching(names: list[str], pattern: str) -> list[str]:
    """The files that a pattern such as `b*` names, or one file with its suffixes or without. Raises Unusable."""
    return [name for name in names if fnmatchcase(name, pattern)] or [_among(names, pattern, f"{_OF_FILE}{pattern}")]


def _answer(text: str) -> Answer:
    """`COLUMN:UNIT`, either of them left out; a column of digits is its number."""
    from ident.drafts.answers import Answer

    column, colon, unit = (part.strip() for part in text.rpartition(":"))
    if not colon:
        column, unit = unit, ""
    return Answer(int(column) if column.isdigit() else column, unit)


def _asked(draft: Draft, none: str) -> Draft:
    """The draft with the next thing that is missing answered on the terminal; as it is where that cannot be."""
    from ident.drafts.draft import Draft

    missing = draft.missing[0]
    hint = f" (COLUMN or COLUMN:UNIT, {none} for none)" if missing.key.startswith("channel") else ""
    text = str(typer.prompt(f"{missing.question}{hint}")).strip()
    try:
        answered = Draft(draft.files, _with(draft, missing, text))
        _ = answered.missing  # names the column that is not there
    except Unusable as refused:
        print(str(refused), file=sys.stderr)
        return draft
    return answered


def _with(draft: Draft, missing: Missing, text: str) -> Answers:
    """The answers with one more, about the files that it was asked of."""
    answers = draft.answers
    if missing.key == "serial":
        return replace(answers, serial=text)
    one = _one(missing.key, text)
    if draft.of_all(missing):
        said = one.over(answers.of_all)
        return replace(answers, channels=said.channels, time=said.time, rate=said.rate)
    for name in missing.files:
        answers = answers.with_file(name, one)
    return answers


def _one(key: str, text: str) -> FileAnswers:
    """What was typed, as an answer about a file."""
    from ident.drafts.answers import Answer, FileAnswers

    kind, _, name = key.partition(" ")
    if kind == "rate":
        known = any(sign.isdigit() for sign in text[:1])
        return FileAnswers(rate=text) if known else FileAnswers(time=_answer(text))
    answer = Answer(unit=text) if kind == "unit" else _answer(text)
    return FileAnswers(time=answer) if name == "time" else FileAnswers({name: answer})


def _write(files: Gathered, out: Path) -> None:
    """The files of the matrix, its description last: a folder that has one is whole."""
    (out / "runs").mkdir(parents=True, exist_ok=True)
    for name, content in reversed(list(files.files.items())):
        write_bytes(content, out / name)
