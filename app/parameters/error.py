"""The error of a parameter set as a reader reads it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, get_args

from ident.words.error import ErrorOf

if TYPE_CHECKING:
    from app.tables import SetRow
    from schemas.parameters import ParameterSetView

Use = Literal["fit", "verify"]
USES: tuple[Use, ...] = get_args(Use)
"""The uses of runs on which a set has an error."""
NAMES = tuple(f"error.{use}" for use in USES)
"""What is judged like a parameter: those errors, which have no unit."""


def error_of(of: ParameterSetView | SetRow | None, use: Use) -> ErrorOf:
    """The error of a set on the runs of a use, with the mean counted and the runs on which the model is unstable."""
    if of is None:
        return ErrorOf(None)
    if use == "fit":
        return ErrorOf(of.error_fit, of.error_with_mean_fit, of.unstable_fit)
    return ErrorOf(of.error_verify, of.error_with_mean_verify, of.unstable_verify)
