"""A parser from elsewhere at work in a process of its own, with a limit of memory and of time.

What it does to a file that was made to harm stays there: memory that it eats, time that it takes, a crash.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ident.errors import Unusable
from ident.readers.limits import Limits, check_size
from ident.readers.table import Array, Table
from ident.units.quantity import shown

_ALONE, _TIMES = 1 << 30, 16  # bytes that such a process takes by itself, and of memory for each byte of the file
_NUMBER = 8  # bytes
_TOO_LONG = -getattr(signal, "SIGXCPU", 0)
"""The end of a process that took its seconds of a processor; 0 where the system does not count them."""
_WHOLE = "install servoident whole, or save it as .csv"
_REMEDIES = {"mdf": "install servoident[mdf], or save it as .csv"}  # where a parser is an extra


def read_sandboxed(format_: str, data: bytes, where: str, limits: Limits) -> Table:
    """The columns, with their units, that ``ident.foreign.FORMAT`` finds.

    Raises Unusable: ``broken-FORMAT``, ``not-installed``, ``too-large``, ``too-slow``, and on loading ``not-numeric``.
    """
    line, _, numbers = _output(format_, data, where, limits).partition(b"\n")
    said = _said(line, format_, where)
    if "refused" in said:
        raise _refusal(said, format_, where)
    columns: list[dict[str, Any]] = said["columns"]
    lengths = [column["length"] for column in columns]
    for column in columns:
        check_size(_NUMBER * (column["length"] or 0), limits.channel, f"column {shown(column['name'])!r}", where)
    if len(numbers) != _NUMBER * sum(length or 0 for length in lengths):
        raise broken(format_, "the answer of its parser is cut short", where)
    starts = np.concatenate([[0], np.cumsum([length or 0 for length in lengths])])
    names = tuple(str(column["name"]) for column in columns)

    def load(wanted: Sequence[int]) -> list[Array]:
        for number in wanted:
            if lengths[number] is None:
                what = f"column {shown(names[number])!r} holds no numbers"
                raise Unusable("not-numeric", what, where, "save real numbers")
        return [np.frombuffer(numbers, "<f8", lengths[n], _NUMBER * int(starts[n])) for n in wanted]

    units = tuple(str(column["unit"]) for column in columns)
    notices = tuple(f"{where}: {notice}" for notice in said.get("notices", ()))
    aliases = (tuple(said["aliases"]),) if said.get("aliases") else ()
    return Table(names, load, notices, units, aliases, rate=float(said.get("rate") or 0.0))


def _output(format_: str, data: bytes, where: str, limits: Limits) -> bytes:
    """What the process writes; its errors are nobody's to read."""
    memory = min(limits.parser_memory, _ALONE + _TIMES * len(data))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "file"
        file.write_bytes(data)
        seconds = limits.parser_seconds
        command = [sys.executable, "-m", "ident.foreign", format_, str(file), str(memory), str(seconds)]
        few = {
            "OPENBLAS_NUM_THREADS": "1",
            "OMP_NUM_THREADS": "1",
            "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
        }
        kept = {name: os.environ[name] for name in ("PATH", "SYSTEMROOT", "LD_LIBRARY_PATH") if name in os.environ}
        try:
            done = subprocess.run(
                command,
                cwd=folder,
                env=kept | few,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                timeout=limits.parser_wait if _TOO_LONG else seconds,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise _too_slow(limits.parser_wait if _TOO_LONG else seconds, where) from None
    if done.returncode and done.returncode == _TOO_LONG:
        raise _too_slow(seconds, where)
    return done.stdout


def _too_slow(seconds: float, where: str) -> Unusable:
    what = f"reading it takes longer than {seconds:g} s"
    return Unusable("too-slow", what, where, "split the record, or save it as .parquet or .csv")


def _said(line: bytes, format_: str, where: str) -> dict[str, Any]:
    try:
        found: dict[str, Any] = json.loads(line)
    except ValueError:  # it ended before it could speak
        raise broken(format_, "its parser ended on it", where) from None
    return found


def _refusal(said: dict[str, Any], format_: str, where: str) -> Unusable:
    if said["refused"] == "not-installed":
        what = f"files of this type need {said['what']}, which is not installed"
        return Unusable("not-installed", what, where, _REMEDIES.get(format_, _WHOLE))
    if said["refused"] == "memory":
        return Unusable("too-large", "reading it takes more memory than is allowed", where, "split the record")
    return broken(format_, shown(" ".join(str(said["what"]).split())), where)


def broken(format_: str, what: str, where: str) -> Unusable:
    """The error for a file that its parser cannot read."""
    return Unusable(f"broken-{format_}", f"this cannot be read: {what}", where, "save it again, or as .csv")
