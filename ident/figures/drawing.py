"""A figure by name: what it is of, what draws it, and the options that it takes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from ident.figures.render import Chart
from ident.figures.theme import Look
from ident.fit.result import FitResult
from ident.presets.model import Kind
from ident.run import Specimen

S = TypeVar("S")
Options = Mapping[str, Any]
"""The values that were chosen, by the names of the options."""
Several = str | float | Sequence[str] | Sequence[float] | None
Choices = tuple[tuple[str, str], ...]
"""Values and their words."""


@dataclass(frozen=True)
class OfferedRun:
    """What is known of a run before its samples are read."""

    use: str
    gain: float | None
    amplitude: float | None
    unit: str
    """Of the command."""
    specimen: Specimen | None


@dataclass(frozen=True)
class Offer:
    """What the choices of options hang on: the fit that is drawn, and the runs that there are."""

    fit: FitResult
    runs: tuple[OfferedRun, ...]


@dataclass(frozen=True)
class Option:
    """Something that a reader may choose of a figure."""

    name: str
    label: str = ""
    """Of its field in a form; without one it is offered by name alone."""
    takes: Any = Several
    """Kind of its value; one value or several where nothing is said."""
    choices: Callable[[Offer], Choices] | None = None
    """Values to choose from; without them it is a free number."""
    picked: bool = False
    """Whether it is picked out once for all figures, as a run and a band are."""


@dataclass(frozen=True)
class Drawing(Generic[S]):
    """A figure of a subject. A new one is a file with such a value, and a line in the list of the catalogue.

    Tests ask of each figure of a fit: the serial in its title, model and errors in the first line below
    (`words.verdict`), axes whose names end with a unit in brackets (`words.axis`, "(–)" of a plain number), less than
    300 kB.
    """

    name: str
    """What a reader asks for; no two figures of a subject share one."""
    title: str
    """Of its tab."""
    of: type[S]
    """What it is of, such as a :class:`Study`."""
    draw: Callable[[S, Look, Options], Chart]
    options: tuple[Option, ...] = ()
    kind: Kind = "chain"
    """Of a study: kind of model that has the figure, but for models whose preset names other figures."""
    there: Callable[[S], bool] = lambda _: True
    """Whether a subject has what it shows."""
    share: float = 0.76
    """Of its usual width, as wide as its place on a page."""
