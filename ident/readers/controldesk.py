"""dSPACE ControlDesk's recordings exported as text (.csv): lines KEY,VALUE,… above, then a table of the traces.

The key stands in the first field of a line; below ``trace_values`` it is empty. ``trace_names`` has the name of each
port, ``path`` the block of the Simulink model that it belongs to (as exported by ControlDesk 7).
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence

from ident.errors import Unusable
from ident.readers.limits import Limits
from ident.readers.table import Array, Table, filled
from ident.readers.text import as_utf8, columns

TIME, _SECOND = "time", "s"  # the axis, which has neither name nor unit
_VALUES = re.compile(rb'^"?trace_values"?[,;\t]', re.MULTILINE)
_NAMES = re.compile(rb'^"?trace_names"?([,;\t])', re.MULTILINE)
_KEYS = ("trace_names", "path", "trace_units")
_HEAD = 1 << 20  # bytes of what stands above the values
_ROOT = "Model Root/"
_PORT = re.compile(r"(In|Out)\d+")  # what Simulink calls the ports of a block: the block's name says what it is


def is_controldesk(data: bytes) -> bool:
    """Whether a text is such a recording."""
    return _begun(as_utf8(data)) is not None


def _begun(text: bytes) -> tuple[re.Match[bytes], re.Match[bytes]] | None:
    """Where the names and where the values of the traces begin."""
    names, values = _NAMES.search(text, 0, _HEAD), _VALUES.search(text, 0, _HEAD)
    return None if names is None or values is None else (names, values)


def read_controldesk(data: bytes, where: str, limits: Limits) -> Table | None:
    """The traces by their blocks, with their units, and ``time``; of a port that has a name of its own that one too.

    None where the text is no such recording. Raises Unusable: ``broken-controldesk``, and on loading ``not-numeric``,
    ``ragged-row``, ``too-large``.
    """
    text = as_utf8(data)
    begun = _begun(text)
    if begun is None:
        return None
    named, begin = begun
    delimiter = named[1].decode()
    names, paths, units = (_fields(text[: begin.start()], key, delimiter, where) for key in _KEYS)
    called = tuple(map(_called, names, filled(paths, len(names))))
    comma = delimiter == ";" and b"," in text[begin.end() : text.find(b"\n", begin.end()) + 1 or None]

    def load(numbers: Sequence[int]) -> list[Array]:
        behind = [number + 1 for number in numbers]  # the key
        return columns(text, begin.start(), behind, delimiter, comma, where, limits)

    stated = filled(units, len(names))
    return Table(
        called,
        load,
        units=tuple(unit or (_SECOND if name == TIME else "") for name, unit in zip(called, stated, strict=True)),
    )


def _fields(head: bytes, key: str, delimiter: str, where: str) -> list[str]:
    """The fields behind a key; none where there is no such line."""
    found = re.search(rf'^"?{key}"?{delimiter}(.*)$'.encode(), head, re.MULTILINE)
    if found is None or not found[1].strip():
        return []
    try:
        return [one.strip() for one in next(csv.reader([found[1].decode("utf-8", "replace")], delimiter=delimiter))]
    except csv.Error:
        raise Unusable(
            "broken-controldesk",
            f"its line of {key} cannot be read",
            where,
            "export it again from ControlDesk, or save it as a plain table",
        ) from None


def _called(name: str, path: str) -> str:
    """What a trace is called: its block, and its port where that has a name of its own; the axis has neither."""
    path = path.removeprefix(_ROOT)
    parts = [part for part in (path, "" if path and _PORT.fullmatch(name) else name) if part]
    return "/".join(parts) or TIME
