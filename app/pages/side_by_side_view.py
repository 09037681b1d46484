"""More than two fits side by side: what the page of them shows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from app.fits.service import Stored
from app.pages.figure_forms import FigureForm, overlaid
from app.pages.fit_page import other_fit
from ident.comparison.side_by_side import Change, SideBySide
from ident.words.error import ErrorOf
from schemas.matrix import MatrixView
from schemas.parameters import ParameterSetView

Row = tuple[str, ...]


@dataclass(frozen=True)
class Cell:
    """The error of a run in a fit, a fraction and as it is read, and its change from the first fit."""

    value: float | None
    error: str
    change: str


@dataclass(frozen=True)
class SideRun:
    """A run in each of the fits."""

    id: str
    use: str
    cells: tuple[Cell, ...]


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
    runs: tuple[SideRun, ...]
    figures: tuple[FigureForm, ...]
    fits: str
    fixed: str

    @property
    def uses(self) -> tuple[str, ...]:
        """The runs by their ids."""
        return tuple(run.id for run in self.runs)

    @property
    def serial(self) -> str:
        """The actuators, for the names of downloads."""
        return "-".join(self.serials)


def side_view(stored: Sequence[Stored], found: SideBySide, matrix: MatrixView) -> SideView:
    """The page of these fits; `matrix` is that of the first."""
    ids = [one.id for one in stored]
    heads = tuple(
        Head(
            one.id,
            one.serial,
            column.title,
            one.found.method,
            one.found.seed,
            one.created_at,
            one.current,
            "/compare?fits=" + ",".join(other for other in ids if other != one.id),
        )
        for one, column in zip(stored, found.columns, strict=True)
    )
    one_actuator = len(found.serials) == 1
    figures = overlaid(matrix.runs, [one.found for one in stored]) if one_actuator else ()
    return SideView(
        id=ids[0],
        serials=found.serials,
        heads=heads,
        letters=tuple(column.name for column in found.columns),
        figures=figures,
        errors=tuple(found.error_rows()),
        parameters=tuple(found.parameter_rows()),
        runs=tuple(SideRun(run, use, tuple(_cells(found, run))) for run, use in found.uses.items()),
        fits=",".join(ids),
        fixed="&".join(f"other={one}" for one in ids[1:]),
    )


def _cells(found: SideBySide, run: str) -> Iterator[Cell]:
    first = found.columns[0].runs.get(run)
    for place, column in enumerate(found.columns):
        error, said = column.runs.get(run), column.run_words.get(run, ErrorOf(None)).in_print()
        yield Cell(error, said, str(Change(first, error)) if place else "")


def further(known: Iterable[ParameterSetView], fits: Sequence[str]) -> tuple[tuple[str, str], ...]:
    """Fits of the actuator that can be added to these, by id and in words."""
    return tuple((one.id, other_fit(one)) for one in known if one.id not in fits)
