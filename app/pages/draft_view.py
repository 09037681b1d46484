"""What the page shows that describes raw files: a row a column, with what it may be and in which unit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from app.context import Context
from app.drafts import service
from app.errors import missing
from app.pages.thumbnails import curve
from ident.drafts.draft import OUTPUTS
from ident.matrix import CHANNELS
from schemas.draft import AnswersRequest, ColumnView, DraftView

PICTURED = 4
"""Files whose columns are drawn."""
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
    """A column by its name: the unit that is stated, what it is taken for, its number in each file that is drawn."""

    name: str
    unit: str
    role: str
    places: tuple[int | None, ...]


def draft_page(context: Context, draft: str) -> dict[str, Any]:
    """What the template of a draft needs. Raises Failure 404."""
    found = service.look(context, draft, AnswersRequest())
    return {
        "draft": found, "columns": tuple(_columns(found)), "pictured": PICTURED, "units": UNITS,
        "known_units": {name for _, names in UNITS for name in names},
        "roles": (("time", "time"), *((name, name.replace("_", " ")) for name in CHANNELS)),
        "outputs": tuple((name, name.replace("_", " ")) for name in OUTPUTS),
    }  # fmt: skip


def _columns(draft: DraftView) -> Iterator[DraftColumn]:
    """Every column of any file, in the order of the files."""
    by_name: dict[str, ColumnView] = {}
    for file in draft.files:
        for column in file.columns:
            by_name.setdefault(column.name, column)
    numbers = [{column.name: column.number for column in file.columns} for file in draft.files[:PICTURED]]
    units = {"time": draft.time.unit, **{name: answer.unit for name, answer in draft.channels.items()}}
    for name, column in by_name.items():
        unit = column.unit or units.get(column.role, "")
        yield DraftColumn(name, unit, column.role, tuple(of.get(name) for of in numbers))


def column_picture(context: Context, draft: str, file: int, column: int) -> str:
    """A column over its file, small. Raises Failure 404."""
    files = service.raw_files(context, draft)
    if not (0 <= file < len(files) and any(one.number == column for one in files[file].columns)):
        raise missing("column", f"{file}/{column}")
    return curve(files[file].samples(column))
