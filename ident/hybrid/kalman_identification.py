"""A first-order loop fitted by its tracking filter: the method ``ekf``.

The runs to fit pass through the filter one after the other. The first pass, with the fictitious noise of the usual
rule, finds where the parameters lie; the second, without any, holds them constant: its covariance is that of the fit.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.identification import Identification
from ident.fit.result import FitResult, Undetermined
from ident.fit.settings import Settings
from ident.hybrid import kalman
from ident.hybrid.tracked_run import Track, track
from ident.hybrid.tracking import Noise, Tracker
from ident.matrix import Matrix
from ident.progress import Progress, Report, silent
from ident.run import Run
from ident.words.run_name import run_name

NAME = "ekf"
_MOST = 0.2  # of the output's deviation: as noise is taken what a loop that does not hold leaves
_NAMES = ("tau", "gain")
_DOES_NOT_HOLD = "a first-order loop with constant parameters does not hold, so that its filter knows no standard error"
_KNOWN = (kalman.DP, kalman.UPG, kalman.DG)
_OPEN = 0.5  # relative standard deviation with which the second pass starts


@dataclass(frozen=True)
class Found:
    """τ and k (SI), their covariance (2, 2), the first pass over each run, and whether constants held in the second."""

    tau: float
    gain: float
    covariance: NDArray[np.float64]
    tracks: tuple[Track, ...]
    constant: bool


class KalmanIdentification(Identification):
    """One fit of a first-order loop. Raises Unusable with effects, bounds or held values, which a filter knows not."""

    def __init__(self, matrix: Matrix, settings: Settings, report: Report = silent) -> None:
        for what, given in (("effects", settings.effects), ("bounds", settings.bounds), ("values", settings.fixed)):
            if given:
                raise Unusable("method-does-not-fit", f"{NAME} takes no {what}", "method", "leave them out, or use ga")
        runs = matrix.of_use("fit")
        if not runs:
            raise Unusable(
                "no-fit-runs",
                "every run is validation data, and none is estimation data",
                "runs",
                "mark at least one run use: fit",
            )
        started = time.monotonic()
        self.found = filtered(runs, report)
        values = {"tau": self.found.tau, "gain": self.found.gain}
        super().__init__(matrix, replace(settings, method="ga", fixed=values), report)
        self._started = started

    def finish(self, state: dict[str, Any]) -> FitResult:
        """The fit, with the filter's standard errors, and what it says of the model."""
        found = super().finish(state)
        errors = np.sqrt(np.diag(self.found.covariance))
        linked = float(self.found.covariance[0, 1] / (errors[0] * errors[1]))
        holds = self.found.constant and all(passed.verdict.holds for passed in self.found.tracks)
        parameters = {
            name: replace(found.parameters[name], std_error=float(error) if holds else None, fixed=False)
            for name, error in zip(_NAMES, errors, strict=True)
        }
        said = tuple(f"{run_name(passed.run.id)}: {passed.verdict.reason}" for passed in self.found.tracks)
        return replace(
            found,
            method=NAME,
            parameters={**found.parameters, **parameters},
            notes=(*found.notes, *said),
            correlation={a: {b: 1.0 if a == b else linked for b in _NAMES} for a in _NAMES} if holds else {},
            undetermined=found.undetermined if holds else tuple(Undetermined(name, _DOES_NOT_HOLD) for name in _NAMES),
            settings={**found.settings, "method": NAME, "fixed": {}},
        )


def filtered(runs: Sequence[Run], report: Report = silent) -> Found:
    """Both passes over some runs. Raises Unusable where one has no command or does not move."""
    tracks = []
    for place, run in enumerate(runs):
        report(Progress("filter", place, 2 * len(runs)))
        tracks.append(track(run))
    first = [(t.tau[len(t.tau) // 2 :], t.gain[len(t.gain) // 2 :]) for t in tracks]
    tau, gain = (float(np.median(np.concatenate(part))) for part in zip(*first, strict=True))
    known, constant = ((_OPEN / tau) ** 2, 0.0, (_OPEN * gain / tau) ** 2), True
    for place, passed in enumerate(tracks):
        report(Progress("filter", len(runs) + place, 2 * len(runs)))
        tracker = _constant(passed, tau, gain, known)
        said = tracker.verdict
        constant = constant and said.holds and (said.nis_mean or 0.0) <= kalman.MOST_NIS
        (tau, gain), known = tracker.estimate, tuple(tracker.state[list(_KNOWN)])
    report(Progress("filter", 2 * len(runs), 2 * len(runs)))
    return Found(tau, gain, tracker.covariance[1:, 1:], tuple(tracks), constant)


def _constant(passed: Track, tau: float, gain: float, known: tuple[float, ...]) -> Tracker:
    """The filter after a run without fictitious noise, from τ and k, and what was `known` of 1/τ and k/τ, before it."""
    run, size = passed.run, passed.noise.measurement
    if not passed.verdict.holds:
        most = _MOST * float(np.std(run.measured))
        size = min(max(size, size * math.sqrt(passed.verdict.nis_mean or 1.0)), max(most, size))
    tracker = Tracker(run.sample_rate, run.hold, tau, gain, Noise(size, 0.0, 0.0), reopens=False)
    tracker.state[list(_KNOWN)] = known
    tracker.block(run.command, run.measured)
    return tracker
