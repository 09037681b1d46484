"""What the page shows that describes raw files: a panel a layout, with its dialect, first lines, and a row a column."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from pydantic import TypeAdapter, ValidationError

from app.context import Context
from app.drafts import service
from app.errors import missing
from app.pages.thumbnails import curve
from ident.drafts.draft import OUTPUTS
from ident.errors import Unusable
from ident.readers.dialect import DECIMALS, DELIMITERS, ENCODINGS
from ident.run import CHANNELS
from schemas.draft import AnswersRequest, DialectRequest, DialectView, DraftView, FileAnswersRequest, RawFileView

PICTURED = 4
"""Files of a layout whose columns are drawn."""
UNITS = (
    ("length", ("mm", "cm", "m", "um", "in", "mil")),
    ("force", ("N", "kN", "kgf", "tf", "lbf", "kip")),
    ("pressure", ("bar", "MPa", "kPa", "Pa", "psi")),
    ("velocity", ("mm/s", "cm/s", "m/s", "in/s", "rpm", "rad/s", "deg/s")),
    ("acceleration", ("m/s^2", "g", "mm/s^2")),
    ("angle", ("deg", "rad", "rev")),
    ("torque", ("N*m", "kN*m")),
    ("electrical", ("V", "mV", "A", "mA")),
    ("time", ("s", "ms", "us", "min")),
    ("temperature", ("degC", "K", "degF")),
    ("other", ("%", "counts", "1")),
)
"""Units of the menu, by what they measure."""
_DIALECTS = TypeAdapter(dict[str, DialectRequest])


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
    `stated` is the dialect that was stated of them.
    """

    names: tuple[str, ...]
    label: str
    rate: str
    columns: tuple[DraftColumn, ...]
    pictured: tuple[tuple[int, RawFileView], ...]
    stated: DialectRequest

    @property
    def first(self) -> RawFileView:
        """The file that stands for all."""
        return self.pictured[0][1]

    @property
    def above(self) -> int:
        """Lines of its text above the samples."""
        return self.first.dialect.header_rows or 0

    def samples(self, number: int) -> str:
        """The first samples of a column, as they are read."""
        return ", ".join(f"{value:.6g}" for one in self.first.columns if one.number == number for value in one.first)


def draft_page(context: Context, draft: str, apart: bool = False, dialects: str = "") -> dict[str, Any]:
    """What the template of a draft needs; with `apart` a panel a file; `dialects` as the address has them.

    Raises Failure 404, Unusable.
    """
    stated = _stated(dialects)
    found = service.look(context, draft, _asked(stated))
    layouts = tuple(_layouts(found, apart, stated))
    return {
        "draft": found,
        "layouts": layouts,
        "pictured": PICTURED,
        "units": UNITS,
        "apart": apart,
        "dialects": dialects,
        "shared": len(layouts) < len(found.files),
        "known_units": {name for _, names in UNITS for name in names},
        "roles": (("time", "time"), *((name, name.replace("_", " ")) for name in CHANNELS)),
        "outputs": tuple((name, name.replace("_", " ")) for name in OUTPUTS),
        "menus": (
            ("delimiter", "Delimiter", tuple(DELIMITERS)),
            ("decimal", "Decimal sign", tuple(DECIMALS)),
            ("encoding", "Encoding", tuple(ENCODINGS)),
        ),
        "lines_above": (("header_rows", "Lines above the samples"), ("skip_rows", "Lines above the column names")),
    }


def _stated(dialects: str) -> dict[str, DialectRequest]:
    """The dialects that the address of the page states, by the names of files. Raises Unusable ``bad-dialect``."""
    try:
        return _DIALECTS.validate_json(dialects) if dialects else {}
    except ValidationError:
        remedy = "open the page without them, and choose them there"
        raise Unusable("bad-dialect", "the dialects in the address cannot be read", "dialects", remedy) from None


def _asked(stated: dict[str, DialectRequest]) -> AnswersRequest:
    return AnswersRequest(files={name: FileAnswersRequest(dialect=dialect) for name, dialect in stated.items()})


def _layouts(draft: DraftView, apart: bool, stated: dict[str, DialectRequest]) -> Iterator[Layout]:
    """The layouts of the files, in the order in which they come."""
    found: dict[object, list[int]] = {}
    for place, file in enumerate(draft.files):
        alone = place if apart or file.problem else -1
        key = (tuple(_columns(file)), file.rate, _said_of(file.dialect), alone)
        found.setdefault(key, []).append(place)
    for places in found.values():
        files = [draft.files[place] for place in places]
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        yield Layout(
            tuple(file.name for file in files),
            f"{files[0].name}{more}" if len(found) > 1 else "",
            files[0].rate,
            tuple(_columns(files[0])),
            tuple((place, draft.files[place]) for place in places[:PICTURED]),
            stated.get(files[0].name, DialectRequest()),
        )


def _said_of(dialect: DialectView) -> tuple[object, ...]:
    """What of a dialect one menu can say of several files."""
    return tuple(dialect.model_dump().values())


def _columns(file: RawFileView) -> Iterator[DraftColumn]:
    """The columns of a file; one whose name another bears, too, is called by its number."""
    names = [column.name for column in file.columns]
    units = {"time": file.time.unit, **{name: answer.unit for name, answer in file.channels.items()}}
    for one in file.columns:
        column = one.name if names.count(one.name) == 1 else one.number
        yield DraftColumn(column, one.name, one.number, one.unit or units.get(one.role, ""), one.role)


def column_picture(context: Context, draft: str, file: int, column: int, dialects: str = "") -> str:
    """A column over its file, small. Raises Failure 404, Unusable."""
    files = service.raw_files(context, draft, service.answers(_asked(_stated(dialects))))
    if not (0 <= file < len(files) and any(one.number == column for one in files[file].columns)):
        raise missing("column", f"{file}/{column}")
    return curve(files[file].samples(column))
