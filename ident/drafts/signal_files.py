"""Files of one signal each: which of them are one run, by what their names have in common."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath

from ident.drafts.joined_files import holds_one_signal, joined
from ident.drafts.raw_file import RawFile, read_whole
from ident.errors import Unusable
from ident.readers import ENDINGS, ending_of
from ident.readers.column_names import PAIRS, channel_of, is_time, said
from ident.readers.limits import LIMITS, Limits

_PARTS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[^\W\d_A-Z]+|\d+")
"""Words and numbers of a name: pos1_runA is pos, 1, run, A."""
_INPUT = re.compile(r"(?:ch|chan|channel|kanal|canal|voie|trace) ?\d+")
"""An input of an oscilloscope or a logger."""
_MOST_PARTS = 4  # of a name that are a signal: measured position in mm
_LONGEST = 200  # signs of a name that is looked through


@dataclass(frozen=True)
class Named:
    """A file's name around the part that says the signal: `before` and `after` are those of its run."""

    before: str
    signal: str
    after: str

    @property
    def run(self) -> tuple[str, str]:
        """What the files of a run share."""
        return self.before, self.after


def with_runs_joined(files: Sequence[tuple[str, bytes]], limits: Limits = LIMITS) -> list[tuple[str, bytes]]:
    """The files by name, those of one signal each replaced by the runs that they are, each where its first file was.

    A run is the files of one folder whose names differ by the part that says the signal: pos1_A.txt, vel1_A.txt and
    tau1_A.txt are run 1_A. Its text says what it was joined from. Files of several signals stay as they are.

    Raises Unusable as :func:`ident.drafts.joined_files.joined` does, and as reading a file of such a name does.
    """
    contents = dict(files)
    if len(contents) < len(files):
        raise Unusable("duplicate-file", "two files have one name", "files", "give each its own name")
    made: dict[str, tuple[str, bytes]] = {}  # by the first file of the run
    gone: set[str] = set()
    for run, signals in named_runs(list(contents)).items():
        read = {name: read_whole(contents[name], name, limits) for name in signals}
        parts: dict[str, RawFile] = {name: file for name, file in read.items() if holds_one_signal(file)}
        if len(parts) < 2:
            continue
        name = f"{run}.csv" if f"{run}.csv" not in contents else f"{run}-joined.csv"
        made[next(iter(parts))] = name, joined(parts, {one: signals[one] for one in parts}).encode()
        gone |= parts.keys()
    return [made.get(name, (name, data)) for name, data in files if name in made or name not in gone]


def named_runs(names: Sequence[str]) -> dict[str, Mapping[str, str]]:
    """The runs that names tell: of each its name, and the part that says the signal by file; two files at least.

    Of several parts that may say the signal it is the one in which most files differ.
    """
    ways = {name: list(_ways(_stem(name))) for name in names if ending_of(name) in ENDINGS}
    signals: dict[tuple[str, str, str], set[str]] = {}
    for name, found in ways.items():
        for one in found:
            signals.setdefault((_folder(name), *one.run), set()).add(one.signal)
    chosen: dict[str, tuple[str, str, str]] = {}
    taken: dict[str, str] = {}
    for name, found in ways.items():
        if found:
            best = max(found, key=lambda one: (len(signals[_folder(name), *one.run]), len(one.signal)))
            chosen[name], taken[name] = (_folder(name), *best.run), best.signal
    for name in ways.keys() - chosen.keys():  # a word that nobody knows, where the rest of the name is that of a run
        runs = [run for run in set(chosen.values()) if run[0] == _folder(name) and _fits(_stem(name), *run[1:])]
        if runs:
            chosen[name] = max(runs, key=lambda run: len(run[1]) + len(run[2]))
            taken[name] = _stem(name)[len(chosen[name][1]) : len(_stem(name)) - len(chosen[name][2])].strip("_-. ")
    found_runs: dict[tuple[str, str, str], dict[str, str]] = {}
    for name in ways:
        if name in chosen:
            found_runs.setdefault(chosen[name], {})[name] = taken[name]
    several = {run: of for run, of in found_runs.items() if len(of) > 1 and len(set(of.values())) == len(of)}
    return dict(zip(_run_names(list(several)), several.values(), strict=True))


def _ways(stem: str) -> Iterator[Named]:
    """Every part of a name that says a signal, with what stands before and behind it."""
    parts = list(_PARTS.finditer(stem[:_LONGEST]))
    for first in range(len(parts)):
        for last in range(first, min(first + _MOST_PARTS, len(parts))):
            signal = stem[parts[first].start() : parts[last].end()]
            if _says_signal(signal):
                yield Named(stem[: parts[first].start()], signal, stem[parts[last].end() :])


def _says_signal(text: str) -> bool:
    plain = said(text)
    in_pair = any(plain in pair for pair in PAIRS)
    return bool(channel_of(text)) or is_time(text) or in_pair or bool(_INPUT.fullmatch(plain))


def _fits(stem: str, before: str, after: str) -> bool:
    return len(stem) > len(before) + len(after) and stem.startswith(before) and stem.endswith(after)


def _folder(name: str) -> str:
    return str(PurePosixPath(name).parent)


def _stem(name: str) -> str:
    return PurePosixPath(name).name.partition(".")[0]


def _run_names(runs: Sequence[tuple[str, str, str]]) -> list[str]:
    """A name for each run: what its files' names share, behind the folder's where that alone is not its own."""
    plain = [(before + after).strip("_-. ") for _, before, after in runs]
    folders = [PurePosixPath(folder).name for folder, *_ in runs]
    found = [
        one if plain.count(one) == 1 else "-".join(filter(None, (of, one)))
        for of, one in zip(folders, plain, strict=True)
    ]
    return [one or of or "run" for one, of in zip(found, folders, strict=True)]
