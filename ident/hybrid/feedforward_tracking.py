"""Effect of the feedforward in a case: the machine of a fit, and draws of it, follow the reference solution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.feedforward import Plant, Tracked, plant_of, tracked
from ident.hybrid.machine import actuator
from ident.hybrid.parameter_samples import Covariance, Spread, drawn_parameters
from ident.hybrid.substructure import reference
from ident.plain import read, written
from ident.run import Specimen
from ident.words.engineering import quantity
from ident.words.message import Message, message
from ident.words.result_tables import TabularResult

Array = NDArray[np.float64]
_SHOWN = 600  # points of a curve that are kept
_RATE = 1000.0  # Hz: no structure moves so fast that more samples would show more


@dataclass(frozen=True, kw_only=True)
class FeedforwardTracking(TabularResult):
    """Errors (m) of a machine that follows a reference with the feedback alone and with feedforward beside it.

    `gain` and `limit`, from which the loop is unstable (None where it is stable at any gain), in V/m. `feedback_rms`
    and `both_rms` are of the machine, `drawn_feedback_rms` and `drawn_both_rms` the medians of the `draws` machines
    drawn from the `spread` in words, `drawn_ratio` the median of feedback over both; these three are None without
    standard errors. Curves over `t` (s): `reference`, both errors, and between what 90 % of the draws lie with the
    feedforward, `low` and `high`.
    """

    gain: float
    limit: float | None
    draws: int
    feedback_rms: float
    both_rms: float
    drawn_feedback_rms: float | None
    drawn_both_rms: float | None
    drawn_ratio: float | None
    t: tuple[float, ...]
    reference: tuple[float, ...]
    feedback: tuple[float, ...]
    both: tuple[float, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    spread: str = str(Covariance())

    @property
    def gain_said(self) -> Message:
        """The gain, and by how much it could rise before the loop is unstable."""
        if self.limit is None:
            return message("feedforward.no_limit", gain=self.gain)
        margin = 20.0 * np.log10(self.limit / self.gain)
        return message("feedforward.gain", gain=self.gain, margin=float(margin), limit=self.limit)

    @property
    def said(self) -> list[str]:
        """In words: the gain below its limit, the errors of the fitted machine, those of the drawn ones."""
        alone = quantity(self.feedback_rms, "m")
        lines = [
            str(self.gain_said),
            f"error {quantity(self.both_rms, 'm')} RMS, with the feedback alone {alone}",
        ]
        if self.drawn_both_rms is None or self.drawn_ratio is None:
            return [*lines, "the fit states no standard errors: nothing is known of other machines that it allows"]
        drawn = f"median of {self.draws} machines drawn from {self.spread} {quantity(self.drawn_both_rms, 'm')}"
        return [*lines, f"{drawn}, 1/{rounded(self.drawn_ratio)} of the feedback's"]

    def listings(self) -> list[str]:
        """Effect of the feedforward, a line each."""
        return [f"feedforward: {line}" for line in self.said]

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        data: dict[str, Any] = written(self)
        return data

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> FeedforwardTracking:
        """What :meth:`to_json` gave."""
        return read(cls, data)

    @classmethod
    def of(cls, found: Tracked, draws: int, spread: str = str(Covariance())) -> FeedforwardTracking:
        """Of what was tracked: at most 600 points of each curve."""
        places = np.unique(np.linspace(0, len(found.reference) - 1, _SHOWN).astype(np.intp))
        low, high = found.band()
        curves = {
            "reference": found.reference,
            "feedback": found.feedback,
            "both": found.both,
            "low": low,
            "high": high,
        }
        rms = found.rms()
        told = {name: float(np.median(rms[name])) if draws else None for name in ("drawn_feedback", "drawn_both")}
        return cls(
            gain=found.gain,
            limit=found.limit if np.isfinite(found.limit) else None,
            draws=draws,
            spread=spread,
            feedback_rms=float(rms["feedback"]),
            both_rms=float(rms["both"]),
            drawn_feedback_rms=told["drawn_feedback"],
            drawn_both_rms=told["drawn_both"],
            drawn_ratio=float(np.median(rms["drawn_feedback"] / np.maximum(rms["drawn_both"], 1e-300)))
            if draws
            else None,
            t=tuple((places / found.sample_rate).tolist()),
            **{name: tuple(curve[places].tolist()) for name, curve in curves.items()},
        )


def rounded(ratio: float) -> str:
    """Three digits, as one would say them."""
    return f"{float(f'{ratio:.3g}'):,.10g}"


def plant_in(fit: FitResult, case: Case) -> Plant:
    """The machine of a fit of `strano` with the gain and the specimen of a case. Raises Unusable."""
    return replace(plant_of(fit, actuator(case), case.gain), specimen=case.physical)


def followed_in(
    fit: FitResult, case: Case, seed: int = 0, spread: Spread | None = None, isolator: Specimen | None = None
) -> FeedforwardTracking:
    """How the machine of a fit follows the reference solution of a case, and so do 100 drawn machines.

    They are drawn from a `spread`, without one from the covariance of the fit. The feedforward is that of the fitted
    machine for all of them, and knows nothing of an `isolator` that they move. Raises Unusable as :func:`plant_in`.
    """
    every = max(1, int(case.sample_rate // _RATE))
    moved = case if isolator is None else case.with_isolator(isolator)
    wanted = reference(moved, case.ground.samples(case.sample_rate))[::every]
    plant, drawn = plant_in(fit, case), drawn_parameters(fit, seed=seed, spread=spread)
    found = tracked(plant, plant_in(fit, moved), wanted, case.sample_rate / every, drawn)
    return FeedforwardTracking.of(found, len(next(iter(drawn.values()), ())), str(spread or Covariance()))
