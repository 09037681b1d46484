"""What a reader may choose about each figure of a fit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from ident.figures import words
from ident.fit.result import FitResult
from ident.matrix import Run

Choices = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Field:
    """One option of a figure: a list of (value, text), or a free number where there are no choices."""

    name: str
    label: str
    choices: Choices = ()


@dataclass(frozen=True)
class FigureForm:
    """One figure with its options."""

    name: str
    title: str
    fields: tuple[Field, ...]


def forms(runs: Sequence[Run], fit: FitResult) -> tuple[FigureForm, ...]:
    """The figures that this fit has, in the order of the tabs."""
    run = Field("run", "Run", (("", "a typical one"), *((each.id, each.id) for each in runs)))
    pictures = [
        FigureForm("bode", "Bode plot", _bode(runs)),
        FigureForm("time", "Time record", (run, Field("start", "Start (s)"), Field("seconds", "Length (s)"))),
        FigureForm("sensitivity", "Sensitivity", (run,)),
    ]
    if fit.evolution:
        pictures.insert(2, FigureForm("evolution", "Evolution", _evolution(fit)))
    return tuple(pictures)


def _bode(runs: Sequence[Run]) -> tuple[Field, ...]:
    verify = "verify runs" if any(run.use == "verify" for run in runs) else "fit runs"
    gains = _distinct(runs, lambda run: run.gain, lambda run: f"{run.gain:g}", words.gain)
    amplitudes = _distinct(runs, lambda run: run.amplitude, lambda run: f"{run.amplitude:.6g}", words.amplitude)
    specimens = dict.fromkeys(words.specimen(run.specimen) for run in sorted(runs, key=_by_specimen) if run.specimen)
    offered = (
        Field("use", "Runs", (("", f"a few {verify}"), ("verify", "verify"), ("fit", "fit"), ("all", "all"))),
        Field("kp", "Gain", (("", "any"), *gains)),
        Field("amplitude", "Amplitude, RMS", (("", "any"), *amplitudes)),
        Field("specimen", "Specimen", (("", "any"), *((text, text) for text in specimens))),
        Field("axis", "Frequency axis", (("log", "logarithmic"), ("linear", "linear"))),
    )
    return tuple(field for field in offered if len(field.choices) > 1)


def _distinct(
    runs: Iterable[Run],
    value: Callable[[Run], float | None],
    query: Callable[[Run], str],
    text: Callable[[float | None], str],
) -> Choices:
    """The stated values in numeric order, as query and as words."""
    stated = {number: query(run) for run in runs if (number := value(run)) is not None}
    return tuple((stated[number], text(number)) for number in sorted(stated))


def _by_specimen(run: Run) -> tuple[float, float]:
    return (0.0, 0.0) if run.specimen is None else (run.specimen.mass, run.specimen.stiffness)


def _evolution(fit: FitResult) -> tuple[Field, ...]:
    if len(fit.searched) < 2:
        return ()
    names = (("", "default"), *((name, name) for name in fit.searched))
    return (Field("x", "Across", names), Field("y", "Up", names))
