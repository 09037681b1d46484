"""Files of one signal each, as oscilloscopes and some loggers write them, as one table: a run is one file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import PurePosixPath

import numpy as np

from ident.drafts.raw import Column, RawFile, read_whole
from ident.errors import Unusable
from ident.readers.column_names import is_time
from ident.readers.limits import LIMITS, Limits
from ident.run import Samples


def joined(contents: Mapping[str, bytes], limits: Limits = LIMITS) -> str:
    """The signals of some files, given by name, side by side as a text with commas; a time that all have stands once.

    A column without a name, or with one that two files have, is called after its file; its unit stands in brackets.

    Raises Unusable: ``unequal-lengths`` where the files have not as many samples, ``unequal-times`` where their times
    differ, and what reading raises.
    """
    files = [read_whole(data, name, limits) for name, data in contents.items()]
    _check_lengths(files)
    columns: dict[str, Samples] = {}
    for file in files:
        for column in file.columns:
            name, samples = _called(column, file, files), file.samples(column.number)
            if name not in columns:
                columns[name] = samples
            elif not _is_time(column, file) or not np.array_equal(columns[name], samples):
                what, remedy = f"its {name!r} differs from that of {files[0].name}", "join files of one recording"
                raise Unusable("unequal-times", what, file.name, remedy)
    rows = zip(*(samples.tolist() for samples in columns.values()), strict=True)
    quoted = ",".join(f'"{name}"' for name in columns)
    return "\n".join([quoted, *(",".join(map(repr, row)) for row in rows), ""])


def _check_lengths(files: list[RawFile]) -> None:
    lengths = {file.name: len(file.samples(file.columns[0].number)) for file in files}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise Unusable("unequal-lengths", f"the files differ in length: {listed}", "join", "cut them to one length")


def _is_time(column: Column, file: RawFile) -> bool:
    return is_time(column.name) or column.number in file.table.stamps


def _called(column: Column, file: RawFile, files: list[RawFile]) -> str:
    """What a column is called in the whole: by its name where that is its own, else by its file's."""
    name = column.name.replace('"', "")
    if not _is_time(column, file):
        others = sum(one.name == column.name for other in files for one in other.columns)
        stem = PurePosixPath(file.name).name.partition(".")[0]
        alone = sum(not _is_time(one, file) for one in file.columns) == 1
        if name.isdigit() or not name or others > 1:
            name = stem if alone else f"{stem} {name}"
    return f"{name} [{column.unit}]" if column.unit and column.unit not in name else name
