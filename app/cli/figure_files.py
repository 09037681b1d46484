"""Figures as files: every figure of a result in every format, in a folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from app.cli.output import write_bytes
from ident.errors import Unusable
from ident.words.nearest import did_you_mean

if TYPE_CHECKING:
    from ident.figures import Study
    from ident.fit.result import FitResult
    from ident.matrix import Matrix

_CANNOT = ("unstable-model", "cannot-draw")
"""Codes of what one figure cannot show, and others can."""
FORMATS = ("svg", "png", "pdf", "json")
OF_ALL = ("theme", "share")
"""Options that every figure takes."""


def given_options(texts: Sequence[str]) -> dict[str, Any]:
    """Options of figures as they were typed, NAME=VALUE; one that is given several times has a list of values.

    Raises Unusable for what has no name or no value.
    """
    given: dict[str, list[str]] = {}
    for text in texts:
        name, is_given, value = text.partition("=")
        if not (name and is_given and value):
            raise Unusable("bad-option", f"{text!r} is not NAME=VALUE", "--option", "write for example theme=dark")
        given.setdefault(name.strip(), []).append(value.strip())
    found: dict[str, Any] = {name: values[0] if len(values) == 1 else values for name, values in given.items()}
    if "share" in found:
        found["share"] = _share(found["share"])
    return found


def _share(value: object) -> float:
    """The width of a figure over its usual width. Raises Unusable where it is no number from 0.2 to 4."""
    try:
        share = float(str(value))
    except ValueError:
        share = 0.0
    if not 0.2 <= share <= 4:
        raise Unusable("out-of-range", f"share is {value}", "--option share", "give one number from 0.2 to 4")
    return share


def with_options(subject: object, names: Sequence[str], options: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The figures of these names, or all that there are of a subject, each with those of the options that it takes.

    Raises Unusable for a figure that is not there, and for an option that none of the figures takes.
    """
    from ident.figures import drawings

    there = drawings(subject)
    for name in names:
        if name not in there:
            raise Unusable("unknown-figure", f"no figure {name!r}", "--figure", did_you_mean(name, there))
    takes = {name: {*OF_ALL, *(option.name for option in there[name].options)} for name in names or there}
    taken = sorted(set().union(*takes.values()))
    for name in options:
        if name not in taken:
            raise Unusable("unknown-option", f"no figure has an option {name!r}", "--option", did_you_mean(name, taken))
    return {figure: {name: options[name] for name in options if name in known} for figure, known in takes.items()}


def write_figures(subject: object, out: Path) -> None:
    """Write the figures that there are of a subject, and say which."""
    from ident.figures import drawings

    names = tuple(drawings(subject))
    for name in names:
        write_figure(subject, name, out)
    print(f"wrote {', '.join(names)} to {out}")


def study_figures(
    matrix: Matrix,
    fit: FitResult,
    names: Sequence[str] = (),
    options: Mapping[str, Any] = MappingProxyType({}),
    others: Sequence[FitResult] = (),
) -> tuple[Study, dict[str, dict[str, Any]]]:
    """A fit beside its data, and its figures, all or those of these names, each with the options that it takes.

    With `others` they are those in which several fits are drawn. Nothing is worked out yet. Raises Unusable for a
    figure that the fit does not have, and for an option that none of the figures takes.
    """
    from ident.figures import drawings
    from ident.workflows import study

    studied = study(matrix, fit)
    if others:
        options = {**options, "other": list(others)}
        several = [
            name for name, one in drawings(studied).items() if "other" in {option.name for option in one.options}
        ]
        names = names or several
    return studied, with_options(studied, names, options)


def draw_study(studied: Study, figures: Mapping[str, Mapping[str, Any]], out: Path) -> None:
    """Write figures of a fit, each with its options, to the folder `out`, and say which."""
    drawn = []
    for name, taken in figures.items():
        try:
            write_figure(studied, name, out, **taken)
        except Unusable as error:
            if error.code not in _CANNOT:
                raise
            print(f"{name} cannot be drawn: {error.what}")
            continue
        drawn.append(name)
    print(f"wrote {', '.join(drawn)} to {out}")


def write_figure(subject: object, name: str, out: Path, stem: str = "", **options: Any) -> None:
    """Write one figure to `out`, as files of its name, or of that in `stem`."""
    from ident.figures import figure, renders

    out.mkdir(parents=True, exist_ok=True)
    chart = figure(name, subject, **options)
    for format_, drawn in renders(chart, FORMATS).items():
        write_bytes(drawn, out / f"{stem or name}.{format_}")
