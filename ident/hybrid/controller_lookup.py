"""The controller of a hybrid simulation by its name, or from the file that `servoident control` wrote."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.compensation import Compensation
from ident.hybrid.controller import Controller, SampledController, no_controller
from ident.hybrid.feedforward import FeedforwardController
from ident.hybrid.feedforward_tracking import plant_in
from ident.hybrid.shaking_table import ahead_of
from ident.hybrid.substructure import reference
from ident.units.quantity import shown
from ident.words.nearest import did_you_mean

Array = NDArray[np.float64]
FEEDFORWARD = "feedforward"
_LARGEST = 50_000_000  # bytes of a controller's file


def _none(_fit: FitResult, case: Case, _wanted: Array | None) -> Controller:
    """u = d."""
    return no_controller(case.sample_rate)


def _kalman(_fit: FitResult, case: Case, _wanted: Array | None) -> Controller:
    """u = (d + τ d′)/k from live estimates, which start from what a filter takes that knows nothing of the fit."""
    return Compensation(case.sample_rate)


def _feedforward(fit: FitResult, case: Case, wanted: Array | None) -> Controller:
    """d with the voltage beside it that the inverse of the model needs to follow the reference solution.

    The motion of the whole structure is known ahead, as the ground is.
    """
    if case.table is not None:
        return ahead_of(fit, case)
    ahead = reference(case, case.ground.samples(case.sample_rate)) if wanted is None else wanted
    return FeedforwardController(plant_in(fit, case), ahead, case.sample_rate)


NAMED: Mapping[str, Callable[[FitResult, Case, Array | None], Controller]] = {
    "none": _none,
    "kalman": _kalman,
    FEEDFORWARD: _feedforward,
}
"""Controllers by name, each made for one simulation."""


def controller_called(given: str, fit: FitResult, case: Case, wanted: Array | None = None) -> Controller:
    """The controller of that name or file, by what is known: the fit and the case as stated.

    `wanted` (m) is the reference solution that is known ahead, (n,), that of the case where it is None. Raises Unusable
    where it is neither, or made for another sample rate.
    """
    if given in NAMED:
        return NAMED[given](fit, case, wanted)
    path = Path(given)
    if not path.is_file() or path.stat().st_size > _LARGEST:
        raise Unusable(
            "unknown-controller",
            f"{shown(given)!r} is not a controller",
            "controller",
            did_you_mean(given, NAMED, f"give {', '.join(NAMED)}, or the controller.json of `servoident control`"),
        )
    try:
        data = json.loads(path.read_bytes())
    except (ValueError, RecursionError):
        data = None
    return for_rate(SampledController.from_json(data), case)


def linear(controller: Controller, what: str) -> SampledController:
    """The controller, where machines can run under it side by side for a map or a spread. Raises Unusable."""
    if not isinstance(controller, SampledController):
        raise Unusable("bad-option", f"a {what} needs a linear controller", what, "leave it out, or give another")
    return controller


def for_rate(controller: SampledController, case: Case) -> SampledController:
    """The controller, where it was made for the sample rate of the case. Raises Unusable."""
    if abs(controller.sample_rate / case.sample_rate - 1) > 1e-9:
        made, asked = f"{controller.sample_rate:g} Hz", f"{case.sample_rate:g} Hz"
        raise Unusable(
            "bad-controller",
            f"it was made for {made}, the case samples at {asked}",
            "controller",
            "design it for this case",
        )
    return controller
