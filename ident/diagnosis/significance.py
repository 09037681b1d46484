"""When one refit is better than another beyond chance.

Two models are compared on the same held-out chunks, pair by pair, so that what both cannot explain falls out. By how
much the held-out data become more likely is, with n the number of samples that tell something new,

    G = n log(error before / error after)   in nats

and the mean gain of a chunk over its standard error says how steadily. Either may be beyond chance: G counts where the
residual is noise and a few chunks gain much, the other where the residual is a slow pattern, of which few samples tell
something new. A parameter that is of no use lowers both. What helps has to help without the run that gains most, too,
or without that chunk, where there are few runs: what only one run asks for is a doubt about that run, not physics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.cross_validation import CrossValidation

Array = NDArray[np.float64]
BEYOND_CHANCE = 10.0  # nats: one in 20,000 by chance, if only the best of a large number could tell
WORTHWHILE = 1e-2  # relative fall of the error: less is not worth a parameter, however certain
ALIKE = 3.0  # standard deviations below which two refits differ by chance
_OFFSET_ALIKE = 4.5  # nats: three deviations
_ALIKE_NATS = 2 * ALIKE**2  # where white noise of σ separates outputs f, g by ALIKE deviations: |f − g|² = 36 σ²
VISIBLE = 3e-4  # of the standard deviation: offsets below are nobody's concern
_SINGLE = 5.0  # nats that are to be left without the run that gains most
_STEADY = 3.0  # deviations of the mean gain of the chunks that are beyond chance by themselves
_SINGLE_STEADY = 2.5  # deviations that are to be left without the run that gains most
_UNSTEADY = 1.5  # deviations below which few chunks gain
_LOST = 0.1  # of what these few gain that the rest may lose: more, and it is they against the rest


@dataclass(frozen=True)
class Improvement:
    """How much better one refit is than another on data that neither saw.

    `share` is the relative fall of the error, `nats` by how much the data become more likely, `deviations` the mean
    gain of a chunk over its standard error, both also without the run that gains most; `lost` what the chunks that get
    worse lose of that which the others gain, without that run. `offset` are the nats of the runs' offsets, `visible`
    whether these are large enough to matter.
    """

    share: float
    nats: float
    nats_without: float
    deviations: float
    deviations_without: float
    lost: float
    offset: float
    visible: bool

    @property
    def beyond_chance(self) -> bool:
        """Whether the better one would be chosen again with other noise."""
        few = self.deviations > _UNSTEADY or self.lost < _LOST
        likely = self.nats > BEYOND_CHANCE and self.nats_without > _SINGLE and few
        steady = self.deviations > _STEADY and self.deviations_without > _SINGLE_STEADY
        of_error = self.share > WORTHWHILE and (likely or steady)
        return of_error or (self.visible and self.offset > BEYOND_CHANCE and self.nats > -_SINGLE)

    @property
    def within_chance(self) -> bool:
        """Whether the two cannot be told apart."""
        same_errors = self.deviations < ALIKE and self.nats < _ALIKE_NATS
        return same_errors and (self.offset < _OFFSET_ALIKE or not self.visible)


def improvement(before: CrossValidation, after: CrossValidation) -> Improvement:
    """What `after` gains over `before`."""
    weights = 1.0 / (np.maximum(np.minimum(before.errors, after.errors), 1e-12) * before.totals)
    difference = (before.squares - after.squares) * weights[:, None]
    best = np.zeros(difference.shape, dtype=bool)
    if len(difference) > 2:
        best[int(np.argmax(difference.sum(axis=1)))] = True
    else:
        best.flat[int(np.argmax(difference))] = True
    n = len(before.means)
    offset = n * float(np.log(max(before.offset, 1e-12) / max(after.offset, 1e-12))) if n > 2 else 0.0
    share = 1.0 - after.error / before.error if before.error > 0 else 0.0
    visible = max(before.offset, after.offset) > VISIBLE
    everything = np.zeros(difference.shape, dtype=bool)
    return Improvement(
        share,
        _nats(before, after, everything),
        _nats(before, after, best),
        _deviations(difference),
        _deviations(difference[~best]),
        _lost(difference[~best]),
        offset,
        visible,
    )


def _nats(before: CrossValidation, after: CrossValidation, but: NDArray[np.bool_]) -> float:
    """By how much the held-out data, without some chunks, become more likely."""
    errors = [
        float(np.mean(np.sqrt(np.where(but, 0.0, side.squares).sum(axis=1) / side.totals))) for side in (before, after)
    ]
    return before.independent * float(np.log(max(errors[0], 1e-12) / max(errors[1], 1e-12)))


def _lost(differences: Array) -> float:
    """The losses over the gains."""
    gains = float(np.maximum(differences, 0.0).sum())
    return float(np.maximum(-differences, 0.0).sum()) / gains if gains > 0 else np.inf


def _deviations(values: Array) -> float:
    """The mean over its standard error."""
    spread = float(np.std(values, ddof=1)) if values.size > 1 else 0.0
    return float(values.mean() * np.sqrt(values.size) / spread) if spread > 0 else 0.0
