"""An identified machine in, files for other programs out: C, state space, a functional mock-up unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ident.errors import Unusable
from ident.export.blocks import as_blocks
from ident.export.fmu import as_fmu
from ident.export.header import as_header
from ident.export.identification import as_identification
from ident.export.machine import USUAL_RATE, ExportedMachine, exported
from ident.export.state_space import LinearPart, as_control, as_mat, linear_part
from ident.words.nearest import did_you_mean


@dataclass(frozen=True)
class Format:
    """A form of an exported machine: how its file's name ends, its media type, what it is, and who writes it."""

    ending: str
    media: str
    title: str
    write: Callable[[ExportedMachine], bytes]


FORMATS = {
    "c": Format("h", "text/x-c", "C header", lambda machine: as_header(machine).encode()),
    "mat": Format(
        "mat", "application/x-matlab-data", "Linear state space, or the blocks of a bench, MATLAB", as_blocks
    ),
    "fmu": Format("fmu", "application/octet-stream", "FMU, FMI 2", as_fmu),
}


def as_file(machine: ExportedMachine, name: str) -> bytes:
    """The machine in one of the :data:`FORMATS`, by its name or its ending. Raises Unusable: ``unknown-format``."""
    for known, form in FORMATS.items():
        if name in (known, form.ending):
            return form.write(machine)
    raise Unusable("unknown-format", f"no export as {name!r}", "format", did_you_mean(name, FORMATS))


__all__ = [
    "FORMATS", "USUAL_RATE", "ExportedMachine", "LinearPart", "as_blocks", "as_control", "as_file", "as_fmu",
    "as_header", "as_identification", "as_mat", "exported", "linear_part",
]  # fmt: skip
