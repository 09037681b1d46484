"""A draft as the text of matrix.yaml, with what was assumed and what may be added as comments; and as a matrix."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any, TypeVar

import yaml

from ident.drafts.draft import Draft
from ident.errors import Unusable
from ident.matrix import Matrix
from ident.readers import read_source
from ident.readers.limits import LIMITS, Limits, check_size
from ident.readers.source import DESCRIPTION

T = TypeVar("T")
_WIDE = 10_000  # signs: a run's entries stay on their lines
_OPTIONAL = """\
# A run may also say: specimen: {mass: 0.87 kg, stiffness: 36.3 kN/m, damping: 0 N*s/m}, gain: 7 (Kp of its loop),
# amplitude: 0.05 in (RMS of the command), kind: blwn, use: verify,
# hold: zoh (the command is held between its samples; or linear, band-limited).
# A measured channel may say: zeroed: true (its zero was set by hand for the run), zeroed: false (its mean counts).
"""


def as_yaml(draft: Draft) -> str:
    """The text of matrix.yaml. Raises Unusable ``not-stated`` where something is missing."""
    described = draft.description()
    taken = "".join(f"# * {line}\n" for line in map(_line, draft.doubts))
    head = f"# Taken from names and heads of the files; correct it where it is wrong:\n{taken}" if taken else ""
    actuator = yaml.safe_dump({"actuator": described["actuator"]}, sort_keys=False, allow_unicode=True, width=_WIDE)
    return "".join((head, actuator, "runs:\n", _OPTIONAL, *map(_entry, described["runs"])))


def _line(text: str) -> str:
    return " ".join("".join(sign if sign.isprintable() else " " for sign in text).split())


def _entry(run: Mapping[str, Any]) -> str:
    """A run: its fields in lines of their own, each channel in one."""
    return "".join(_lines(run))


def _lines(run: Mapping[str, Any]) -> Iterator[str]:
    for place, (name, value) in enumerate(run.items()):
        before = "  - " if place == 0 else "    "
        if name != "channels":
            yield f"{before}{name}: {_flow(value)}\n"
            continue
        yield f"{before}channels:\n"
        for channel, entry in value.items():
            yield f"      {channel}: {_flow(entry)}\n"


def _flow(value: Any) -> str:
    dumped = yaml.safe_dump(value, default_flow_style=True, sort_keys=False, allow_unicode=True, width=_WIDE)
    return dumped.removesuffix("\n").removesuffix("\n...")


@dataclass(frozen=True)
class Gathered:
    """Files of a matrix in memory, by their names."""

    files: Mapping[str, bytes]

    def read(self, name: str, limit: int) -> bytes:
        """The bytes of a file. Raises Unusable: ``missing-file``, ``too-large``."""
        if name not in self.files:
            raise Unusable("missing-file", "there is no such file", name, "add it or correct the name")
        check_size(len(self.files[name]), limit, "the file", name)
        return self.files[name]


def gathered(draft: Draft, contents: Sequence[bytes]) -> Gathered:
    """matrix.yaml and the files as they came, below runs/. Raises Unusable where two have one name."""
    files = run_files({PurePosixPath(file.name).name: data for file, data in zip(draft.files, contents, strict=True)})
    whole = [file.name for file in draft.files if not file.part]
    if len(files) < len(whole) + len({file.name for file in draft.files if file.part}):
        raise Unusable("duplicate-file", "two files have one name", "files", "give each its own name")
    return Gathered({DESCRIPTION: as_yaml(draft).encode(), **files})


def run_files(files: Mapping[str, T]) -> dict[str, T]:
    """Files of runs by where they are in the matrix."""
    return {f"runs/{name}": content for name, content in files.items()}


def drafted(files: Gathered, limits: Limits = LIMITS) -> Matrix:
    """The matrix that the files are. Raises Unusable."""
    return read_source(files, limits)
