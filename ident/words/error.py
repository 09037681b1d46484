"""An error of eq. (17) in words, with what a reader must know beside it: the mean, and where a model is unstable.

Eq. (17) is a standard deviation: it is blind to a difference of means, and of a model that is unstable on a run it is
any number. Each rule stands here once, for terminal, notebook, page, figure and report.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from ident.unstable import UNSTABLE
from ident.words.percent import percent, percent_in_print
from ident.words.run_name import run_name
from ident.words.titles import data

MEAN_COUNTS = 1.5
"""The ratio of the error with the mean counted to that without, 1, beyond which both stand wherever the error does.

From there on the offset is larger than what eq. (17) sees, √(1.5² − 1) = 1.12 times: the error without the mean is the
smaller part of the residual.
"""
_NAMED = 3  # runs that are called by name; of more the first ones, with their number

ERROR = "error."
"""Begins the names of the errors that a production line follows like parameters: error.fit, error.verify."""


@dataclass(frozen=True)
class ErrorOf:
    """An error of eq. (17), 1, over some runs; None where there are none.

    `with_mean` is RMS(x − x_m)/std(x_m) over the same runs, None where it is not known. `unstable` are the ids of the
    runs on which the model is unstable, `rmse` is the root mean square of the residual with its unit, in words; so is
    `offset`, what the transducer reads above the model, which both count out, where a reader must know of it.
    """

    error: float | None
    with_mean: float | None = None
    unstable: Sequence[str] = ()
    rmse: str = ""
    offset: str = ""

    @property
    def is_unstable(self) -> bool:
        """Whether the model is unstable on one of the runs, by name or by the error of one run alone."""
        return bool(self.unstable) or (self.error is not None and not self.error < UNSTABLE)

    @property
    def mean_counts(self) -> bool:
        """Whether the error with the mean counted has to stand beside the error without."""
        if self.error is None or self.with_mean is None or self.is_unstable:
            return False
        return self.with_mean > MEAN_COUNTS * self.error

    def said(self, number: Callable[[float | None], str] = percent) -> str:
        """ "2.82 %", "2.82 % (with the mean 45.0 times)" or "unstable on run k24"."""
        return self._said(number, "")

    def in_print(self) -> str:
        """The same as pages and reports set it."""
        return self.said(percent_in_print)

    def alone(self, number: Callable[[float | None], str] = percent) -> str:
        """Eq. (17) in a table that has the mean beside it."""
        return unstable_on(self.unstable) if self.is_unstable else number(self.error)

    def counted(self, number: Callable[[float | None], str] = percent) -> str:
        """The error with the mean counted, in a table; "–" where it is not known."""
        return unstable_on(self.unstable) if self.is_unstable else number(self.with_mean)

    def fit(self, number: Callable[[float | None], str] = percent) -> str:
        """The fit to the data, 1 − RMS(x − x_m)/std(x_m) of the free simulation, its mean counted: "87.9 %"."""
        if self.is_unstable:
            return unstable_on(self.unstable)
        return number(None if self.with_mean is None else 1.0 - self.with_mean)

    def headline(self, number: Callable[[float | None], str] = percent) -> str:
        """The same for a first line: "2.82 % (with the mean 45.0 times, RMSE 830.0 m)"."""
        return self._said(number, f", RMSE {self.rmse}" if self.rmse else "")

    def _said(self, number: Callable[[float | None], str], size: str) -> str:
        if self.is_unstable:
            return unstable_on(self.unstable)
        told = [f"after an offset of {self.offset}"] if self.offset and self.error is not None else []
        told += [f"with the mean {number(self.with_mean)}{size}"] if self.mean_counts else []
        return number(self.error) + (f" ({', '.join(told)})" if told else "")


def first_line(name: str, errors: Mapping[str, ErrorOf], number: Callable[[float | None], str] = percent) -> str:
    """The first line of a result: what it is of, and the error on each use of runs of which there are some.

    Without a name there was no time to fit a model.
    """
    return f"{name}: error {errors_line(errors, number)}" if name else "No model was fitted."


def errors_line(errors: Mapping[str, ErrorOf], number: Callable[[float | None], str] = percent) -> str:
    """ "on estimation data 2.82 % (with the mean 45.0 times, RMSE 830.0 m), on validation data unstable on run k24"."""
    known = {use: of for use, of in errors.items() if of.error is not None or of.is_unstable}
    return ", ".join(f"on {data(use)} {of.headline(number)}" for use, of in known.items()) or "unknown"


def unstable_on(runs: Sequence[str]) -> str:
    """ "unstable on run k24", of many runs with their number and the first names; "unstable" where none is named."""
    if not runs:
        return "unstable"
    if len(runs) == 1:
        return f"unstable on {run_name(runs[0])}"
    if len(runs) <= _NAMED:
        return f"unstable on runs {', '.join(runs)}"
    return f"unstable on {len(runs)} runs ({', '.join(runs[:_NAMED])}, …)"


def error_said(error: float | None, unstable: Sequence[str] = ()) -> str:
    """An error of which nothing but the number and the unstable runs is known, for a terminal or a sentence."""
    return ErrorOf(error, unstable=unstable).said()


def error_in_print(error: float | None, unstable: Sequence[str] = ()) -> str:
    """The same as pages and reports set it."""
    return ErrorOf(error, unstable=unstable).in_print()
