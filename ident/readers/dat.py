"""Files that end in .dat, which half a dozen programs write, told apart by their first bytes."""

from __future__ import annotations

from ident.readers.diadem import HEADS, read_diadem
from ident.readers.limits import Limits
from ident.readers.mdf import read_mdf
from ident.readers.mts import read_mts
from ident.readers.source import Beside
from ident.readers.table import Table
from ident.readers.text import read_text

MDF = (b"MDF     ", b"UnFinMF ")
MTS = b"MTS793|"


def read_dat(data: bytes, where: str, limits: Limits, beside: Beside) -> Table:
    """The columns of MDF, of MTS's station manager, of DIAdem, or of a plain table of text.

    Raises Unusable: what the readers of these raise.
    """
    if data.startswith(MDF):
        return read_mdf(data, where, limits)
    if data.startswith(MTS):
        return read_mts(data, where, limits)
    if data.startswith(HEADS):
        return read_diadem(data, where, limits, beside)
    return read_text(data, where, limits)
