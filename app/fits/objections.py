"""What speaks against approving a fit: an error far above its noise floor, or runs to verify that contradict it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from sqlalchemy.orm import Session

from app.fits.repository import verdicts
from app.parameters.error import USES, Use, error_of
from app.tables import FitRow
from ident.words.error import ErrorOf
from ident.words.number import plain
from ident.words.percent import percent_in_print
from ident.words.titles import title

FAR = 1.5
"""Times the noise floor, unit 1: an error above it is no sound fit's.

A fit with the right model ends within 1.1 of its floor, and the floor of a few repeated runs is known within 20 %. Held
by tests/app/test_objections.py.
"""

Errors = Mapping[Use, ErrorOf]
Floors = Mapping[str, float | None]


def of_fit(session: Session, row: FitRow) -> tuple[str, ...]:
    """What speaks against approving a fit, each a clause: its errors, and what was found on the fit before it."""
    found = row.result
    verdict = verdicts(session, [row.parent]).get(row.parent) if row.parent else None
    contradicted = (verdict or {}).get("contradicted_by", ())
    error = {use: error_of(row.set, use) for use in USES}
    return objections(error, found.get("noise_floor") or {}, found.get("effects", ()), contradicted)


def objections(
    error: Errors, noise_floor: Floors, effects: Sequence[str], contradicted: Sequence[str]
) -> tuple[str, ...]:
    """The reasons why a fit should not be approved without a word, each a clause; none for a sound fit.

    `error` and `noise_floor` are fractions of eq. (17) of the `fit` and the `verify` runs, None where there is none;
    `contradicted` are the effects with which a diagnosis saw the error rise on verify runs.
    """
    return tuple(_objections(error, noise_floor, effects, contradicted))


def _objections(
    error: Errors, noise_floor: Floors, effects: Sequence[str], contradicted: Sequence[str]
) -> Iterator[str]:
    fit, verify = error["fit"], error["verify"]
    if _is_far(fit, noise_floor.get("fit")):
        yield _said("the error", fit, noise_floor.get("fit"), "the noise floor")
    if noise_floor.get("verify") is not None:
        if _is_far(verify, noise_floor.get("verify")):
            yield _said("the error on validation data", verify, noise_floor.get("verify"), "their noise floor")
    elif _is_far(verify, fit.error):
        yield _said("the error on validation data", verify, fit.error, "the error on estimation data")
    for name in effects:
        if name in contradicted:
            yield f"with {title(name)} the error on validation data rises"


def _is_far(said: ErrorOf, yardstick: float | None) -> bool:
    return said.error is not None and bool(yardstick) and not said.error <= FAR * (yardstick or 0.0)


def _said(what: str, said: ErrorOf, yardstick: float | None, of: str) -> str:
    if said.is_unstable:
        return f"{what} is unknown: the model is {said.in_print()}"
    ratio = plain((said.error or 0.0) / (yardstick or 1.0), 2)
    return f"{what} is {said.in_print()}, {ratio} times {of} of {percent_in_print(yardstick)}"
