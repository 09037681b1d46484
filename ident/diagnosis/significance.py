"""When one refit is better than another beyond chance.

Two models are compared on the same held-out chunks, pair by pair, so that what both cannot explain falls out. By how
much the held-out data become more likely is, with n the number of samples that tell something new,

    G = n log(error before / error after)   in nats

and the mean gain of a chunk over its standard error says how steadily. Either may be beyond chance: G counts where the
residual is noise and a few chunks gain much, the other where the residual is a slow pattern, of which few samples tell
something new. A parameter that is of no use lowers both. Such a pattern may be a sensor's drift, or what disturbances
added up to, which half a dozen effects meet halfway: what helps steadily has to leave less of what the residual's own
past does not foretell, too,

    L = ½ n log(ν² before / ν² after)   in nats, with ν of :mod:`ident.noise.autoregression`

and so has all that helps over windows, which begin anew where they were measured and hide what adds up: there much
less of that is enough by itself. What helps has to help without the run that gains most, too,
or without that chunk, where there are few runs: what only one run asks for is a doubt about that run, not physics.

Whether the error falls by what is worth a parameter is told by the records that were fitted, as long as half of it is
seen on held-out chunks too: a fit that ends in a kink is moved by next to nothing, the fits without a fold that begin
there end now behind it and now before it, and their errors scatter by as much as is asked for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA, EPSILON, TINY
from ident.diagnosis.cross_validation import CrossValidation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Improvement:
    """How much better one refit is than another on data that neither saw.

    `share` is the relative fall of the error, `nats` by how much the data become more likely, `deviations` the mean
    gain of a chunk over its standard error, both also without the run that gains most; `lost` what the chunks that get
    worse lose of that which the others gain, and `of_runs` the mean gain of a run over its standard error, both without
    that run; of few runs the mean gain of a chunk. `offset` are the nats of the runs' offsets, `visible`
    whether these are large enough to matter. `likelier` are the nats of what the residuals' own past does not foretell,
    also without the run or chunk that gains most, None where that is not known, and `new` the share of what is left
    that it does not foretell. `in_windows` as of what is compared. `fitted` is the share by which the error falls on
    the data of the fit, None where they are not those that are compared.
    """

    reduction: float
    log_likelihood_gain: float
    log_likelihood_gain_without_best: float
    deviations: float
    deviations_without_best: float
    run_deviations: float
    loss_ratio: float
    offset_likelihood_gain: float
    offset_matters: bool
    innovation_likelihood_gain: float | None = None
    innovation_likelihood_gain_without_best: float | None = None
    innovation_share: float = 0.0
    in_windows: bool = False
    fitted_reduction: float | None = None

    @property
    def beyond_chance(self) -> bool:
        """Whether the better one would be chosen again with other noise."""
        of_error = self._likelihood_gain_worthwhile or self._gain_consistent
        of_offset = (
            self.offset_matters
            and self.offset_likelihood_gain > CRITERIA.significance.log_likelihood_gain
            and self.log_likelihood_gain > -CRITERIA.significance.gain_without_best
        )
        return (of_error and not self.tracks_drift) or of_offset or self.innovation_gain_significant

    @property
    def tracks_drift(self) -> bool:
        """Whether the error falls, but as much as before is left that its own past does not foretell.

        Not where the data become more likely by themselves, nor where next to nothing of a whole run's residual is new:
        it is a pattern far above the noise, whose steps a model that is better all over may foretell less well.
        """
        asked = self.in_windows or (
            not self._likelihood_gain_worthwhile and self.innovation_share > CRITERIA.significance.innovation_share
        )
        falls = self._likelihood_gain_worthwhile or self._gain_consistent
        return (
            falls
            and asked
            and self.innovation_likelihood_gain is not None
            and not self.innovation_likelihood_gain > CRITERIA.significance.gain_without_best
        )

    @property
    def likelihood_gain_significant(self) -> bool:
        """Whether the data become more likely beyond chance, by however little the error falls: enough for a swap."""
        steadily = (
            self.run_deviations > CRITERIA.significance.run_consistency
            or self.loss_ratio < CRITERIA.significance.loss_ratio
        )
        return (
            self.log_likelihood_gain > CRITERIA.significance.log_likelihood_gain
            and self.log_likelihood_gain_without_best > CRITERIA.significance.gain_without_best
            and steadily
        )

    @property
    def _likelihood_gain_worthwhile(self) -> bool:
        return self.worthwhile and self.likelihood_gain_significant

    @property
    def _gain_consistent(self) -> bool:
        sure = (
            self.deviations > CRITERIA.significance.consistent
            and self.deviations_without_best > CRITERIA.significance.consistent_without_best
        )
        return self.worthwhile and sure

    @property
    def worthwhile(self) -> bool:
        """Whether the error falls by what is worth a parameter."""
        if self.fitted_reduction is None:
            return self.reduction > CRITERIA.significance.worthwhile
        return (
            self.fitted_reduction > CRITERIA.significance.worthwhile
            and self.reduction > CRITERIA.significance.worthwhile_held_out * CRITERIA.significance.worthwhile
        )

    @property
    def innovation_gain_significant(self) -> bool:
        """Whether of windows less is unforetold than by chance."""
        if (
            not self.in_windows
            or self.innovation_likelihood_gain is None
            or self.innovation_likelihood_gain_without_best is None
        ):
            return False
        return (
            self.innovation_likelihood_gain > CRITERIA.significance.innovation_gain
            and self.innovation_likelihood_gain_without_best > CRITERIA.significance.gain_without_best
        )

    @property
    def within_chance(self) -> bool:
        """Whether the two cannot be told apart."""
        same_errors = (
            self.deviations < CRITERIA.significance.indistinguishable
            and self.log_likelihood_gain < CRITERIA.significance.indistinguishable_gain
        )
        return same_errors and (
            self.offset_likelihood_gain < CRITERIA.significance.indistinguishable_offsets or not self.offset_matters
        )


def improvement(before: CrossValidation, after: CrossValidation) -> Improvement:
    """What `after` gains over `before`."""
    weights = 1.0 / (np.maximum(np.minimum(before.errors, after.errors), EPSILON) * before.totals)
    difference = (before.squares - after.squares) * weights[:, None]
    best = _largest_gain(difference)
    n = len(before.means)
    offset = n * float(np.log(max(before.offset, EPSILON) / max(after.offset, EPSILON))) if n > 2 else 0.0
    share = 1.0 - after.error / before.error if before.error > 0 else 0.0
    visible = max(before.offset, after.offset) > CRITERIA.significance.offset
    everything = np.zeros(difference.shape, dtype=bool)
    return Improvement(
        share,
        _log_likelihood_gain(before, after, everything),
        _log_likelihood_gain(before, after, best),
        _deviations(difference),
        _deviations(difference[~best]),
        _deviations(
            difference.sum(axis=1)[~best.any(axis=1)]
            if len(difference) >= CRITERIA.significance.several_runs
            else difference
        ),
        _loss_ratio(difference[~best]),
        offset,
        visible,
        *_innovation_likelihood_gain(before, after),
        _innovation_share(after),
        before.in_windows,
        _relative_reduction(before.fitted_error, after.fitted_error),
    )


def _relative_reduction(before: float | None, after: float | None) -> float | None:
    """The relative fall of an error, where both are known."""
    return None if before is None or after is None or not before > 0 else 1.0 - after / before


def _innovation_share(after: CrossValidation) -> float:
    """The share of what is left that its own past does not foretell, averaged over the runs."""
    if after.innovations is None:
        return 0.0
    return float(np.mean(after.innovations.sum(axis=1) / np.maximum(after.squares.sum(axis=1), TINY)))


def _innovation_likelihood_gain(before: CrossValidation, after: CrossValidation) -> tuple[float | None, float | None]:
    """The nats of what is unforetold, ½ Σ n ln(ν² before / ν² after) over runs; without the chunk that gains most.

    Of three runs or more without the run.
    """
    known = [side.innovations for side in (before, after) if side.innovations is not None]
    if len(known) < 2:
        return None, None
    length = before.samples / known[0].size
    sums = [np.maximum(one, TINY) for one in known]
    power = np.minimum(*(side.mean(axis=1, keepdims=True) for side in sums))
    best = _largest_gain((sums[0] - sums[1]) / power)

    def nats(but: NDArray[np.bool_]) -> float:
        left = [np.maximum(np.where(but, 0.0, side).sum(axis=1), TINY) for side in sums]
        return 0.5 * length * float((~but).sum(axis=1) @ np.log(left[0] / left[1]))

    return nats(np.zeros_like(best)), nats(best)


def _largest_gain(gains: Array) -> NDArray[np.bool_]:
    """Of the gains (runs, chunks) those of the run that gains most; of two runs or one those of the chunk."""
    best = np.zeros(gains.shape, dtype=bool)
    if len(gains) > 2:
        best[int(np.argmax(gains.sum(axis=1)))] = True
    else:
        best.flat[int(np.argmax(gains))] = True
    return best


def _log_likelihood_gain(before: CrossValidation, after: CrossValidation, but: NDArray[np.bool_]) -> float:
    """By how much the held-out data, without some chunks, become more likely."""
    errors = [
        float(np.mean(np.sqrt(np.where(but, 0.0, side.squares).sum(axis=1) / side.totals))) for side in (before, after)
    ]
    return before.independent * float(np.log(max(errors[0], EPSILON) / max(errors[1], EPSILON)))


def _loss_ratio(differences: Array) -> float:
    """The losses over the gains."""
    gains = float(np.maximum(differences, 0.0).sum())
    return float(np.maximum(-differences, 0.0).sum()) / gains if gains > 0 else np.inf


def _deviations(values: Array) -> float:
    """The mean over its standard error."""
    spread = float(np.std(values, ddof=1)) if values.size > 1 else 0.0
    return float(values.mean() * np.sqrt(values.size) / spread) if spread > 0 else 0.0
