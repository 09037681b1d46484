"""More than two fits side by side: what the page of them shows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from app.fits.service import Stored
from app.pages.fit_page import other_fit
from ident.comparison.side_by_side import SideBySide
from ident.words.error import ErrorOf
from schemas.parameters import ParameterSetView

Row = tuple[str, ...]


@dataclass(frozen=True)
class Head:
    """One of the fits, and the address of this page without it."""

    id: str
    serial: str
    title: str
    method: str
    seed: int
    made: str
    current: bool
    without: str


@dataclass(frozen=True, kw_only=True)
class SideView:
    """The fits and their tables; `fixed` are the others in the query of the figure, which is the first one's."""

    id: str
    serials: tuple[str, ...]
    heads: tuple[Head, ...]
    letters: tuple[str, ...]
    errors: tuple[Row, ...]
    parameters: tuple[Row, ...]
    runs: tuple[Row, ...]
    fits: str
    fixed: str

    @property
    def serial(self) -> str:
        """The actuators, for the names of downloads."""
        return "-".join(self.serials)


def side_view(stored: Sequence[Stored], found: SideBySide) -> SideView:
    """The page of these fits."""
    ids = [one.id for one in stored]
    heads = tuple(
        Head(one.id, one.serial, column.title, one.found.method, one.found.seed, one.created_at, one.current,
             "/compare?fits=" + ",".join(other for other in ids if other != one.id))
        for one, column in zip(stored, found.columns, strict=True)
    )  # fmt: skip
    columns = found.columns
    absent = ErrorOf(None)
    runs = (
        (run, use, *(one.run_words.get(run, absent).in_print() for one in columns)) for run, use in found.uses.items()
    )
    return SideView(
        id=ids[0],
        serials=found.serials,
        heads=heads,
        letters=tuple(column.name for column in found.columns),
        errors=tuple(found.error_rows()),
        parameters=tuple(found.parameter_rows()),
        runs=tuple(runs),
        fits=",".join(ids),
        fixed="&".join(f"other={one}" for one in ids[1:]),
    )


def further(known: Iterable[ParameterSetView], fits: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """Fits of the actuator that can be added to these, by id and in words."""
    return tuple((one.id, other_fit(one)) for one in known if one.id not in fits)
