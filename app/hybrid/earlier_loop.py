"""The loop of a case when it was stable, as a request states it: by which the cause of an instability is found."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from app.hybrid.request_parsing import AskedCase, asked_case
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.coupled_case import CoupledCase
from ident.hybrid.coupled_loop import EarlierParts
from ident.hybrid.hybrid_loop import EarlierCase
from schemas.hybrid import EarlierRequest

Stated = Mapping[str, Any]
"""Fit (as who keeps it calls it), gain and case, each as it is now where it is left out."""


def stated(request: EarlierRequest | None) -> dict[str, Any] | None:
    """What a request states, as plain JSON data; a motion's record is left out. Raises Unusable."""
    if request is None:
        return None
    found = request.model_dump(exclude_none=True)
    return found if request.case is None else {**found, "case": asked_case(request.case).case}


def earlier_case(
    given: Stated | None, fit: FitResult, case: Case, find: Callable[[str], FitResult]
) -> EarlierCase | None:
    """The case that is stated; None where nothing is. Raises Unusable, and what `find` raises for an unknown fit."""
    if given is None:
        return None
    then = find(given["fit"]) if "fit" in given else fit
    was = AskedCase(given["case"], None).read() if "case" in given else case
    return EarlierCase(then, was).with_gain(given.get("gain"))


def earlier_parts(
    given: Stated | None, now: Sequence[FitResult], case: CoupledCase, find: Callable[[str], FitResult]
) -> EarlierParts | None:
    """As :func:`earlier_case`, of several actuators, whose machines are now those of the fits."""
    if given is None:
        return None
    then = find(given["fit"]) if "fit" in given else None
    was = AskedCase(given["case"], None).system() if "case" in given else None
    return EarlierParts.stated(now, case, was, then, find).with_gain(given.get("gain"))
