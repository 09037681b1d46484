"""A text that holds several tables of the same columns, one below the other, as a file of each.

Testing machines store some cycles of a test so, and a logger that is started again writes its heading once more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import PurePosixPath

from ident.drafts.raw_file import CUT
from ident.errors import Unusable
from ident.readers import TEXT, ending_of
from ident.readers.layout import HEAD_LINES, Layout, line_start, recognise
from ident.readers.numeral import is_numeral
from ident.readers.text import as_utf8
from ident.readers.time_stamp import is_stamp

_ENDINGS = (*TEXT, ".dat")
_LOOKED_AT = 4096  # bytes in which a zero tells that it is no text
_MOST = 500
"""Tables of a file that are runs; what repeats its heading more often is left as it is."""


def with_tables_apart(files: Sequence[tuple[str, bytes]]) -> list[tuple[str, bytes]]:
    """The files by name, each text that holds several tables replaced by them, as ``name-1.txt`` and on."""
    return [part for name, data in files for part in _parts(name, data)]


def may_hold_tables(name: str) -> bool:
    """Whether a file of this name may be a text with several tables."""
    return ending_of(name) in _ENDINGS


def _parts(name: str, data: bytes) -> list[tuple[str, bytes]]:
    if not may_hold_tables(name) or b"\0" in data[:_LOOKED_AT]:
        return [(name, data)]
    text = as_utf8(data)
    try:
        layout = recognise(text, name)
    except Unusable:  # reading says why
        return [(name, data)]
    starts = _starts(text, layout)
    if not 1 < len(starts) <= _MOST:
        return [(name, data)]
    path = PurePosixPath(name)
    told = "{}from {}, table {} of {}\n".format
    return [
        (
            str(path.with_name(f"{path.stem}-{number}.txt")),
            told(CUT, path.name, number, len(starts)).encode() + text[start:end],
        )
        for number, (start, end) in enumerate(zip(starts, [*starts[1:], len(text)], strict=True), 1)
    ]


def _starts(text: bytes, layout: Layout) -> list[int]:
    """Where each table begins, with the lines above its names: behind the last row of the table before."""
    first = line_start(text, layout.skip_rows)
    heading = text[first : line_start(text, 1, first)].strip()
    if not layout.heading.names or not any(sign.isalpha() for sign in heading.decode("utf-8", "replace")):
        return [0]
    starts, at = [0], text.find(heading, first + len(heading))
    while at >= 0 and len(starts) <= _MOST:
        begin = text.rfind(b"\n", 0, at) + 1
        if text[begin : line_start(text, 1, begin)].strip() == heading:
            starts.append(_behind_rows(text, begin, _is_row(layout)))
        at = text.find(heading, at + len(heading))
    return starts


def _behind_rows(text: bytes, at: int, is_row: Callable[[str], bool]) -> int:
    """Where the lines above a heading begin, the last row of the table before being above them."""
    for _ in range(HEAD_LINES):
        above = text.rfind(b"\n", 0, at - 1) + 1
        if at <= 0 or is_row(text[above : at - 1].decode("utf-8", "replace").rstrip("\r")):
            break
        at = above
    return at


def _is_row(layout: Layout) -> Callable[[str], bool]:
    """Whether a line has a number or a time stamp in each column that holds such."""

    def is_row(line: str) -> bool:
        fields = layout.form.fields(line)
        return (
            len(fields) > max((*layout.numbers, *layout.stamps))
            and all(is_numeral(fields[n], bool(layout.form.comma)) for n in layout.numbers)
            and all(is_stamp(fields[n]) for n in layout.stamps)
        )

    return is_row
