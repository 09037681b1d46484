"""Options for a loop as it was when it was stable, by which the cause of an instability is found."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.cli.arguments import number
from app.cli.input_files import read_fit

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ident.fit.result import FitResult
    from ident.hybrid.case import Case
    from ident.hybrid.coupled_case import CoupledCase
    from ident.hybrid.coupled_loop import EarlierParts
    from ident.hybrid.hybrid_loop import EarlierCase

EarlierFit = Annotated[
    Path | None,
    typer.Option(
        "--before",
        metavar="FIT.json",
        help="Fit of the machine when its loop was stable, to find the cause. Default: this fit.",
    ),
]
EarlierGain = Annotated[
    str | None, typer.Option("--before-gain", metavar="KP", help="Gain Kp with which the loop was stable.")
]
CaseBefore = Annotated[
    str | None,
    typer.Option("--before-case", metavar="CASE", help="Case when its loop was stable. Default: this case."),
]


@dataclass(frozen=True)
class Before:
    """The three options as they were given."""

    fit: Path | None
    gain: str | None
    case: str | None


def earlier_parts(fits: Sequence[FitResult], of: CoupledCase, given: Before) -> EarlierParts | None:
    """As :func:`earlier_case`, of several actuators, whose machines are now those of `fits`. Raises Unusable."""
    from ident.hybrid.coupled_loop import EarlierParts
    from ident.hybrid.coupled_reading import read_system

    if given == Before(None, None, None):
        return None
    then = None if given.case is None else read_system(given.case)
    folder = Path(given.case or "").parent
    fit = None if given.fit is None else read_fit(given.fit)
    stated = EarlierParts.stated(fits, of, then, fit, lambda name: read_fit(folder / name))
    return stated.with_gain(gain_of(given.gain))


def gain_of(text: str | None) -> float | None:
    """The gain that is stated; None where none is. Raises Unusable."""
    return None if text is None else number(text, "--before-gain", "KP")


def earlier_case(
    fit: FitResult, case: Case, before: Path | None, gain: str | None, before_case: str | None
) -> EarlierCase | None:
    """The case when its loop was stable; None where nothing is said of it. Raises Unusable."""
    from ident.hybrid.case import read_case
    from ident.hybrid.hybrid_loop import EarlierCase

    if before is None and gain is None and before_case is None:
        return None
    then = EarlierCase(
        fit if before is None else read_fit(before), case if before_case is None else read_case(before_case)
    )
    return then.with_gain(gain_of(gain))
