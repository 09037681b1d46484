"""Several fits side by side: errors, parameters and runs, a column each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from string import ascii_uppercase
from typing import Any

from ident.comparison.compare import Comparison
from ident.errors import Unusable
from ident.fit.information import same_samples
from ident.fit.result import Estimate, FitResult
from ident.unstable import UNSTABLE
from ident.words.error import ErrorOf
from ident.words.error_change import error_change
from ident.words.number import count, plain
from ident.words.plus_minus import plus_minus
from ident.words.result_tables import Listing, TabularResult
from ident.words.titles import DATA

MOST = 8


@dataclass(frozen=True)
class Column:
    """One fit: its letter, eq. (17) by use and by run, also as a reader reads it, and its actuator's serial number."""

    name: str
    fit: FitResult
    error: Mapping[str, float | None]
    runs: Mapping[str, float]
    words: Mapping[str, ErrorOf]
    run_words: Mapping[str, ErrorOf]
    serial: str = ""

    @property
    def title(self) -> str:
        """Letter, model, and the parameters of the machine that were held."""
        return _title(self.name, self.fit)

    @property
    def title_with_serial(self) -> str:
        """The same with the actuator that it is of."""
        return self.title.replace(": ", f": {self.serial}, ", 1) if self.serial else self.title


@dataclass(frozen=True)
class Change:
    """Two errors, fractions as eq. (17); None where one is not known."""

    first: float | None
    other: float | None

    @property
    def ratio(self) -> float | None:
        """The other over the first; None where one is not known, or the model is unstable."""
        return self.other / self.first if self._known and self.first and self.other is not None else None

    @property
    def points(self) -> float | None:
        """By how many points, per cent of the signal, the other is larger."""
        if not self._known or self.first is None or self.other is None:
            return None
        return 100 * (self.other - self.first)

    @property
    def _known(self) -> bool:
        return all(error is not None and error < UNSTABLE for error in (self.first, self.other))

    def __str__(self) -> str:
        return error_change(self.first, self.other) if self._known else "–"


@dataclass(frozen=True)
class SideBySide(TabularResult):
    """The fits in the order in which they were given; `uses` has the use of each run that one of them has."""

    columns: tuple[Column, ...]
    uses: Mapping[str, str]

    @property
    def serials(self) -> tuple[str, ...]:
        """The serial numbers of the actuators, each once."""
        return tuple(dict.fromkeys(column.serial for column in self.columns if column.serial))

    @property
    def titles(self) -> tuple[str, ...]:
        """What each column is called: with its serial number where the fits are of several actuators."""
        several = len(self.serials) > 1
        return tuple(column.title_with_serial if several else column.title for column in self.columns)

    def listings(self) -> Iterable[Listing | str]:
        """What the letters stand for, errors, parameters, runs."""
        names = [column.name for column in self.columns]
        yield from self.titles
        yield Listing("", ("error (eq. 17)", *names), self.error_rows(), names)
        yield Listing("", ("parameter", *names), self.parameter_rows(), names)
        yield Listing("", ("run", "use", *names), self.run_rows(), names)
        yield Listing(f"Change from {names[0]}", ("run", "use", *names[1:]), self.change_rows(), names)

    def error_rows(self) -> Iterator[tuple[str, ...]]:
        """One row a use of which there are runs."""
        for use, title in DATA.items():
            if any(column.error.get(use) is not None for column in self.columns):
                yield title, *(column.words[use].said() if use in column.words else "–" for column in self.columns)
                changes = self._changes([column.error.get(use) for column in self.columns])
                yield f"change from {self.columns[0].name}, {title}", "", *changes
        for use, title in DATA.items():
            if any(use in column.words and column.words[use].with_mean is not None for column in self.columns):
                known = (column.words.get(use) for column in self.columns)
                yield f"NRMSE fit, {title}", *("–" if of is None else of.fit() for of in known)
        criteria = [column.fit.aic for column in self.columns]
        if all(same_samples(self.columns[0].fit, column.fit) for column in self.columns) and None not in criteria:
            least = min(one for one in criteria if one is not None)
            yield "AIC, above the least", *(plain(one - least) for one in criteria if one is not None)

    def parameter_rows(self) -> Iterator[tuple[str, ...]]:
        """One row a parameter that one of the fits has, with its standard error."""
        for name in dict.fromkeys(name for column in self.columns for name in column.fit.parameters):
            yield name, *(_value(column.fit.parameters.get(name)) for column in self.columns)

    def run_rows(self) -> Iterator[tuple[str, ...]]:
        """One row a run."""
        for run, use in self.uses.items():
            known = (column.run_words.get(run) for column in self.columns)
            yield run, use, *("–" if of is None else of.said() for of in known)

    def change_rows(self) -> Iterator[tuple[str, ...]]:
        """One row a run: how its error differs from that in the first fit, in points and as a factor."""
        for run, use in self.uses.items():
            yield run, use, *self._changes([column.runs.get(run) for column in self.columns])

    def _changes(self, errors: Sequence[float | None]) -> Iterator[str]:
        """How the errors of all columns but the first differ from that of the first, in words."""
        return (str(Change(errors[0], error)) for error in errors[1:])

    def records(self) -> list[dict[str, Any]]:
        """A record a run, for a data frame: its error in each fit, by letter."""
        return [
            {"id": run, "use": use, **{column.name: column.runs.get(run) for column in self.columns}}
            for run, use in self.uses.items()
        ]


def _value(entry: Estimate | None) -> str:
    return "–" if entry is None else plus_minus(entry.value, entry.std_error, entry.unit)


def titles(fits: Sequence[FitResult]) -> tuple[str, ...]:
    """What each of some fits is called: its letter, its model, and the parameters that were held."""
    return tuple(_title(name, fit) for name, fit in zip(ascii_uppercase, fits, strict=False))


def _title(letter: str, fit: FitResult) -> str:
    held = ", ".join(name for name, entry in fit.parameters.items() if entry.fixed and "." not in name)
    model = " + ".join((fit.model, *fit.effects))
    return f"{letter}: {model}{f', {held} held' if held else ''}"


def of_fits(fits: Sequence[FitResult], serials: Sequence[str] = ()) -> SideBySide:
    """Fits with the errors that they were stored with; `serials` are those of their actuators, where others know them.

    Raises Unusable for fewer than two, or more than eight.
    """
    _check(len(fits))
    of = serials or [_serial(fit) for fit in fits]
    columns = tuple(
        Column(
            name,
            fit,
            fit.error,
            {run.id: run.error for run in fit.runs},
            {use: fit.error_of(use) for use in DATA},
            {run.id: run.words for run in fit.runs},
            serial,
        )
        for name, fit, serial in zip(ascii_uppercase, fits, of, strict=False)
    )
    return SideBySide(columns, {run.id: run.use for fit in fits for run in fit.runs})


def of_comparisons(comparisons: Sequence[Comparison]) -> SideBySide:
    """Fits against the same runs, whatever each was fitted to. Raises Unusable as :func:`of_fits`."""
    _check(len(comparisons))
    columns = tuple(
        Column(
            name,
            comparison.fit,
            comparison.error,
            {one.run.id: one.error for one in comparison.runs},
            {use: comparison.error_of(use) for use in comparison.error},
            {one.run.id: one.words for one in comparison.runs},
            _serial(comparison.fit),
        )
        for name, comparison in zip(ascii_uppercase, comparisons, strict=False)
    )
    return SideBySide(columns, {one.run.id: one.run.use for comparison in comparisons for one in comparison.runs})


def _serial(fit: FitResult) -> str:
    """The serial number of the actuator that a fit is of; "" where an earlier version did not keep it."""
    return fit.actuator.serial if fit.actuator else ""


def _check(number: int) -> None:
    if not 2 <= number <= MOST:
        raise Unusable("bad-option", f"{count(number, 'fit')} to compare", "fits", f"give 2 to {MOST}")
