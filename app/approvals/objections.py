"""What speaks against approving a fit: an error far above its noise floor, or runs to verify that contradict it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ident.words.error import ErrorOf
from ident.words.number import plain
from ident.words.percent import percent_in_print
from ident.words.titles import title

FAR = 1.5
"""Times the noise floor, unit 1: an error above it is no sound fit's.

A fit with the right model ends within 1.1 of its floor, and the floor of a few repeated runs is known within 20 %. Held
by tests/app/test_objections.py.
"""

Errors = Mapping[str, float | None]


def objections(
    error: Errors, noise_floor: Errors, effects: Sequence[str], contradicted: Sequence[str]
) -> tuple[str, ...]:
    """The reasons why a fit should not be approved without a word, each a clause; none for a sound fit.

    `error` and `noise_floor` are fractions of eq. (17) of the `fit` and the `verify` runs, None where there is none;
    `contradicted` are the effects with which a diagnosis saw the error rise on verify runs.
    """
    return tuple(_objections(error, noise_floor, effects, contradicted))


def _objections(
    error: Errors, noise_floor: Errors, effects: Sequence[str], contradicted: Sequence[str]
) -> Iterator[str]:
    fit, verify = error.get("fit"), error.get("verify")
    if _is_far(fit, noise_floor.get("fit")):
        yield _said("the error", fit, noise_floor.get("fit"), "the noise floor")
    if noise_floor.get("verify") is not None:
        if _is_far(verify, noise_floor.get("verify")):
            yield _said("the error on the verify runs", verify, noise_floor.get("verify"), "their noise floor")
    elif _is_far(verify, fit):
        yield _said("the error on the verify runs", verify, fit, "the error on the runs of the fit")
    for name in effects:
        if name in contradicted:
            yield f"with {title(name)} the error rises on the verify runs"


def _is_far(error: float | None, yardstick: float | None) -> bool:
    return error is not None and bool(yardstick) and not error <= FAR * (yardstick or 0.0)


def _said(what: str, error: float | None, yardstick: float | None, of: str) -> str:
    if ErrorOf(error).is_unstable:
        return f"{what} is that of a model that is unstable on a run"
    ratio = plain((error or 0.0) / (yardstick or 1.0), 2)
    return f"{what} is {percent_in_print(error)}, {ratio} times {of} of {percent_in_print(yardstick)}"
