"""Files that end in .dat, which half a dozen programs write, told apart by their first bytes.

Those of MTS's station manager (793) are some lines about the test, names, units, then numbers, apart by tabs.
"""

from __future__ import annotations

from ident.errors import Unusable
from ident.readers.diadem import HEADS, read_diadem
from ident.readers.dialect import Dialect
from ident.readers.layout import line_start
from ident.readers.limits import Limits
from ident.readers.sandboxed_parser import read_sandboxed
from ident.readers.source import Beside
from ident.readers.table import Table
from ident.readers.text import as_utf8, is_number, read_text

MDF = (b"MDF     ", b"UnFinMF ")
MTS = b"MTS793|"
_LINES = 200  # of MTS, looked through for the first line of numbers


def read_dat(data: bytes, where: str, limits: Limits, beside: Beside) -> Table:
    """The columns of MDF, of MTS's station manager, of DIAdem, or of a plain table of text.

    Raises Unusable: what the readers of these raise.
    """
    if data.startswith(MDF):
        return read_sandboxed("mdf", data, where, limits)
    if data.startswith(MTS):
        return read_mts(data, where, limits)
    if data.startswith(HEADS):
        return read_diadem(data, where, limits, beside)
    return read_text(data, where, limits)


def read_mts(data: bytes, where: str, limits: Limits) -> Table:
    """The columns of the first block; one more block is refused, with its line, when a column is loaded.

    Raises Unusable: ``broken-mts``, and what :func:`read_text` raises.
    """
    text = as_utf8(data)
    start = 0
    for line in range(_LINES):
        if start >= len(text):
            break
        end = line_start(text, 1, start)
        fields = text[start:end].decode("utf-8", "replace").split("\t") if text[start:end].strip() else []
        if line > 1 and fields and all(is_number(field.strip(), "\t") for field in fields if field.strip()):
            return read_text(data, where, limits, Dialect(skip_rows=line - 2))
        start = end
    raise Unusable("broken-mts", "no line of numbers was found", where, "export the record again, as text")
