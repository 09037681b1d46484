"""What the page shows that describes raw files: a table a layout, a row a column, with what it is and its unit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from app.context import Context
from app.drafts import service
from app.errors import missing
from app.pages.thumbnails import curve
from ident.drafts.draft import OUTPUTS
from ident.run import CHANNELS
from schemas.draft import AnswersRequest, DraftView, RawFileView

PICTURED = 4
"""Files of a layout whose columns are drawn."""
UNITS = (
    ("length", ("mm", "cm", "m", "um", "in", "mil")), ("force", ("N", "kN", "kgf", "tf", "lbf", "kip")),
    ("pressure", ("bar", "MPa", "kPa", "Pa", "psi")),
    ("velocity", ("mm/s", "cm/s", "m/s", "in/s", "rpm", "rad/s", "deg/s")),
    ("angle", ("deg", "rad", "rev")), ("torque", ("N*m", "kN*m")), ("electrical", ("V", "mV", "A", "mA")),
    ("time", ("s", "ms", "us", "min")), ("temperature", ("degC", "K", "degF")), ("other", ("%", "1")),
)  # fmt: skip
"""Units of the menu, by what they measure."""


@dataclass(frozen=True)
class DraftColumn:
    """A column: what an answer calls it, the name that is shown, its unit as far as known, what it is taken for."""

    column: str | int
    name: str
    number: int
    unit: str
    role: str


@dataclass(frozen=True)
class Layout:
    """Files whose columns are called alike, in the same units, and taken for the same: they are described once.

    `pictured` are the first of them with their places in the draft; `label` names them where there are others.
    """

    names: tuple[str, ...]
    label: str
    rate: str
    columns: tuple[DraftColumn, ...]
    pictured: tuple[tuple[int, RawFileView], ...]


def draft_page(context: Context, draft: str, apart: bool = False) -> dict[str, Any]:
    """What the template of a draft needs; with `apart` each file is described by itself. Raises Failure 404."""
    found = service.look(context, draft, AnswersRequest())
    layouts = tuple(_layouts(found, apart))
    return {
        "draft": found, "layouts": layouts, "pictured": PICTURED, "units": UNITS, "apart": apart,
        "shared": len(layouts) < len(found.files),
        "known_units": {name for _, names in UNITS for name in names},
        "roles": (("time", "time"), *((name, name.replace("_", " ")) for name in CHANNELS)),
        "outputs": tuple((name, name.replace("_", " ")) for name in OUTPUTS),
    }  # fmt: skip


def _layouts(draft: DraftView, apart: bool) -> Iterator[Layout]:
    """The layouts of the files, in the order in which they come."""
    found: dict[object, list[int]] = {}
    for place, file in enumerate(draft.files):
        columns = tuple(_columns(file))
        found.setdefault((columns, file.rate, place if apart else 0), []).append(place)
    for places in found.values():
        files = [draft.files[place] for place in places]
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        yield Layout(
            tuple(file.name for file in files), f"{files[0].name}{more}" if len(found) > 1 else "", files[0].rate,
            tuple(_columns(files[0])), tuple((place, draft.files[place]) for place in places[:PICTURED]),
        )  # fmt: skip


def _columns(file: RawFileView) -> Iterator[DraftColumn]:
    """The columns of a file; one whose name another bears, too, is called by its number."""
    names = [column.name for column in file.columns]
    units = {"time": file.time.unit, **{name: answer.unit for name, answer in file.channels.items()}}
    for one in file.columns:
        column = one.name if names.count(one.name) == 1 else one.number
        yield DraftColumn(column, one.name, one.number, one.unit or units.get(one.role, ""), one.role)


def column_picture(context: Context, draft: str, file: int, column: int) -> str:
    """A column over its file, small. Raises Failure 404."""
    files = service.raw_files(context, draft)
    if not (0 <= file < len(files) and any(one.number == column for one in files[file].columns)):
        raise missing("column", f"{file}/{column}")
    return curve(files[file].samples(column))
