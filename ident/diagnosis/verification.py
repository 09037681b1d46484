"""The comparison of the named effects with validation data, which no fit used: it may take away the word found.

An effect that improves the model on estimation data and harms it on validation data imitates an effect that the
catalogue does not have, or that behaves otherwise there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.evidence.blocks import block_mean
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA
from ident.diagnosis.evidence.free_run import FreeRun, drives_away
from ident.plain import WHERE_KNOWN
from ident.rounding import TINY
from ident.run import Run, over_runs
from ident.unstable import UNSTABLE
from ident.words.message import Message, message

Array = NDArray[np.float64]
Standing = Literal["found", "stand_in", "contradicted", "nothing"]
"""found: the error is at the floor; stand_in: it fell, but is above the floor, or may be, because a strength ended at
the bound of its search, or because validation data contradict an effect that proposed terms made dispensable;
contradicted: it rises on validation data; nothing: no effect is named."""
Reason = Literal["untested", "unexplained", "at_bound", "dispensable_contradicted"]
"""Why the standing is stand_in. untested: there was no time to test whether the residual is noise; unexplained: the
residual is not noise, by the numbers of the verdict's `noise_test`; at_bound: no noise floor is known, and a strength
ended at the bound of its search; dispensable_contradicted: validation data contradict an effect that proposed terms
made dispensable."""


@dataclass(frozen=True)
class Contradiction:
    """An effect with which the validation error rises: the error before and after, and the rise in standard errors.

    `after` and `deviations` are None where the model is `unstable` on these validation runs with the effect, and was
    not without it. `instead_of` are the effects of the model with the error `before`, where it has others. With
    `free_run` the errors are the errors of the free run with its mean, where the error over windows does not rise.
    Where the mean counts, the errors `with_mean` rise, from the first to the second; `before` and `after` are the
    errors that tables show.
    """

    effect: str
    before: float
    after: float | None
    deviations: float | None
    instead_of: tuple[str, ...] = ()
    unstable: tuple[str, ...] = field(default=(), metadata=WHERE_KNOWN)
    free_run: bool = field(default=False, metadata=WHERE_KNOWN)
    with_mean: tuple[float, ...] = field(default=(), metadata=WHERE_KNOWN)

    def message(self, named: str) -> Message:
        """The sentence that contradicts the `named` effect."""
        of = message("effect.in_place", named=named, others=self.instead_of) if self.instead_of else named
        if self.after is None:
            return message("contradicted.unstable", named=of, runs=self.unstable, before=self.before)
        if self.free_run:
            return message("contradicted.free_run", named=of, before=self.before, after=self.after)
        if self.with_mean and self.after <= self.before:
            first, last = self.with_mean
            return message(
                "contradicted.mean",
                named=of,
                first=first,
                last=last,
                deviations=self.deviations,
                before=self.before,
                after=self.after,
            )
        if self.deviations is None:
            return message("contradicted.rises", named=of, before=self.before, after=self.after)
        return message(
            "contradicted.rises_by", named=of, before=self.before, after=self.after, deviations=self.deviations
        )


@dataclass(frozen=True)
class VerifyChange:
    """The error on validation data without an effect and with it, and the standard error of the difference.

    Where the mean counts, the errors `with_mean` decide, because they were fitted, and the standard error is of their
    difference. `before` and `after` are the errors of eq. (17) that tables show, and `std_error_without_mean` is the
    standard error of their difference. `after` is None where the model is `unstable` on these runs with the effect, and
    was not without it.
    With `free_run` they are the errors of a free run with its mean, which rise beyond chance. `shown` is the size of
    the change of the model's output by the effect on these runs, as an error of the same kind.
    """

    effect: str
    before: float
    after: float | None
    std_error: float = 0.0
    unstable: tuple[str, ...] = ()
    free_run: bool = False
    with_mean: tuple[float, float] | None = None
    shown: float = 0.0
    std_error_without_mean: float = 0.0

    @property
    def due(self) -> float:
        """The fall of the error that was fitted if the effect acts as it was fitted.

        The residual with the effect is then uncorrelated with the change of the output by the effect: before² = shown²
        + after².
        """
        first = self.with_mean[0] if self.with_mean else self.before
        return first - float(np.sqrt(max(first**2 - self.shown**2, 0.0)))

    @property
    def fall_without_mean(self) -> float:
        """By how much the error without the mean falls, where the mean counts; 0 where it does not."""
        return 0.0 if self.with_mean is None or self.after is None else self.before - self.after

    @property
    def rise(self) -> float:
        """The rise of the error that was fitted; infinite where the model is unstable with the effect."""
        first, last = self.with_mean or (self.before, np.inf if self.after is None else self.after)
        return last - first

    def contradiction(self) -> Contradiction:
        """The contradiction of the effect by validation data, with the number of standard errors."""
        told = self.after is not None and not self.free_run
        deviations = self.rise / max(self.std_error, TINY) if told else None
        return Contradiction(
            self.effect, self.before, self.after, deviations, (), self.unstable, self.free_run, self.with_mean or ()
        )


def verify_change(
    effect: str,
    runs: Sequence[Run],
    before: Sequence[Array],
    after: Sequence[Array],
    means: tuple[Array, Array] | None = None,
) -> VerifyChange | None:
    """How the error over `runs` changes with an effect; None where the model is unstable without it.

    `before` and `after` are the residuals of each run without the effect and with it, (n,), less their mean or over
    windows; `means` are the means that the fit counts, (runs,) each: the errors with them then decide. The standard
    error of the difference comes from the blocks of each run (:mod:`ident.diagnosis.evidence.blocks`).
    """
    if _unstable(runs, before):
        return None
    if unstable := _unstable(runs, after):
        sizes = [float(np.std(r) / np.std(run.measured)) for run, r in zip(runs, before, strict=True)]
        return VerifyChange(effect, float(over_runs(sizes, runs)), None, unstable=unstable)
    counted = before, after
    if means is not None:
        counted = _raised(before, means[0]), _raised(after, means[1])
    with_mean = _error(runs, counted[0]), _error(runs, counted[1])
    std_error = _error_of_difference(runs, *counted)
    shown = _error(runs, [first - last for first, last in zip(*counted, strict=True)])
    if means is None:
        return VerifyChange(effect, *with_mean, std_error, shown=shown)
    return VerifyChange(
        effect,
        _error(runs, before),
        _error(runs, after),
        std_error,
        with_mean=with_mean,
        shown=shown,
        std_error_without_mean=_error_of_difference(runs, before, after),
    )


def _raised(residuals: Sequence[Array], means: Array) -> list[Array]:
    return [residual + mean for residual, mean in zip(residuals, means, strict=True)]


def _error(runs: Sequence[Run], residuals: Sequence[Array]) -> float:
    """The root mean square of residuals over the deviations of the outputs, averaged over runs."""
    sizes = [float(np.std(run.measured)) for run in runs]
    return float(over_runs([_rms(r) / size for r, size in zip(residuals, sizes, strict=True)], runs))


def _error_of_difference(runs: Sequence[Run], before: Sequence[Array], after: Sequence[Array]) -> float:
    """The standard error of the difference of two errors: to first order √(mean r²) is linear in the mean of r²."""
    errors = []
    for run, *residuals in zip(runs, before, after, strict=True):
        first, last = (r**2 / max(2.0 * _rms(r) * float(np.std(run.measured)), TINY) for r in residuals)
        errors.append(block_mean([last - first], EVIDENCE_CRITERIA).error)
    shares = np.array([run.share for run in runs])
    return float(np.linalg.norm(shares / shares.sum() * errors))


def with_free_run(over_windows: VerifyChange, before: FreeRun, after: FreeRun) -> VerifyChange:
    """The change over windows; or that of the free run, where it is driven away and windows do not confirm the effect.

    Where windows confirm the effect the record may drift for another reason.
    """
    confirmed = -over_windows.rise > CRITERIA.verification.deviations * over_windows.std_error
    if confirmed or not drives_away(before, after):
        return over_windows
    power = before.power, after.power
    return VerifyChange(over_windows.effect, float(np.sqrt(power[0])), float(np.sqrt(power[1])), free_run=True)


def _unstable(runs: Sequence[Run], left: Sequence[Array]) -> tuple[str, ...]:
    """The ids of the runs on which a model is unstable, by its residual on each."""
    with np.errstate(over="ignore", invalid="ignore"):
        errors = [float(np.sqrt(np.mean(r**2)) / np.std(run.measured)) for run, r in zip(runs, left, strict=True)]
    return tuple(run.id for run, error in zip(runs, errors, strict=True) if not error < UNSTABLE)


def noise_on_validation_data(errors: Mapping[str, float | None], floors: Mapping[str, float | None]) -> float | None:
    """The error that noise makes on validation data where the model has twice as much of it there as on estimation
    data; None where it has not, or a floor is not known."""
    fit, there, floor, floor_there = errors.get("fit"), errors.get("verify"), floors.get("fit"), floors.get("verify")
    if fit is None or there is None or not floor or not floor_there:
        return None
    excess = there / (max(fit / floor, 1.0) * floor_there)
    return floor_there if excess > CRITERIA.noise.colour else None


def _rms(residual: Array) -> float:
    return float(np.sqrt(np.mean(residual**2)))
