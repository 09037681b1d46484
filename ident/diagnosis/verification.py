"""What runs that no fit saw say of what was named: they may take away the word found, and nothing else.

An effect that helps where it was fitted and harms elsewhere stands for something that the catalogue does not hold, or
that behaves otherwise there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import CRITERIA, TINY
from ident.diagnosis.evidence.free_run import FreeRun, drives_away
from ident.noise.effective_sample_size import independent_samples
from ident.plain import WHERE_KNOWN
from ident.run import Run, over_runs
from ident.unstable import UNSTABLE
from ident.words.message import Message, message

Array = NDArray[np.float64]
Standing = Literal["found", "stand_in", "contradicted", "nothing"]
"""found: the error is at the floor; stand_in: it fell, but is above the floor, or may be, for a strength ended at the
bound of its search; contradicted: it rises on verify runs; nothing: no effect is named."""


@dataclass(frozen=True)
class Contradiction:
    """An effect with which the verify error rises, from and to which, and by how many of its standard errors.

    `after` and `deviations` are None where the model is `unstable` on these verify runs with it, and was not without.
    `instead_of` are the effects that the model has which it rises from, where that has others. Of a `free_run` the
    errors are those with its mean, where windows do not rise. Where the mean counts the errors `with_mean` are what
    rises, from the first to the second; `before` and `after` are those that tables show.
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
        """What speaks against what is `named`."""
        of = message("effect.in_place", named=named, others=self.instead_of) if self.instead_of else named
        if self.after is None:
            return message("contradicted.unstable", named=of, runs=self.unstable, before=self.before)
        if self.free_run:
            return message("contradicted.free_run", named=of, before=self.before, after=self.after)
        if self.with_mean and self.after <= self.before:
            first, last = self.with_mean
            return message(
                "contradicted.mean", named=of, first=first, last=last, deviations=self.deviations, before=self.before,
                after=self.after,
            )  # fmt: skip
        if self.deviations is None:
            return message("contradicted.rises", named=of, before=self.before, after=self.after)
        return message(
            "contradicted.rises_by", named=of, before=self.before, after=self.after, deviations=self.deviations
        )


@dataclass(frozen=True)
class VerifyChange:
    """The error on runs to verify without an effect and with it, and the standard error of the difference.

    Where the mean counts that of the errors `with_mean` is meant, which decide: they are what was fitted. The others
    are those of eq. (17), that tables show.
    `after` is None where the model is `unstable` on these runs with the effect, and was not without. Of a `free_run`
    that is driven away they are the errors with its mean, and that it is more than chance has been asked. `shown` is
    by how much the model differs on these runs with the effect, as an error of the same kind. `tabled_std_error` is
    the standard error of the difference of the errors in tables, where the mean counts.
    """

    effect: str
    before: float
    after: float | None
    std_error: float = 0.0
    unstable: tuple[str, ...] = ()
    free_run: bool = False
    with_mean: tuple[float, float] | None = None
    shown: float = 0.0
    tabled_std_error: float = 0.0

    @property
    def due(self) -> float:
        """By how much the error that was fitted falls if the effect acts as it was fitted.

        The residual with the effect is then uncorrelated with what the effect shows: before² = shown² + after².
        """
        first = self.with_mean[0] if self.with_mean else self.before
        return first - float(np.sqrt(max(first**2 - self.shown**2, 0.0)))

    @property
    def tabled_fall(self) -> float:
        """By how much the error without the mean falls, where the mean counts; 0 where it does not."""
        return 0.0 if self.with_mean is None or self.after is None else self.before - self.after

    @property
    def rise(self) -> float:
        """By how much the error that was fitted rises; infinite where the model is unstable with the effect."""
        first, last = self.with_mean or (self.before, np.inf if self.after is None else self.after)
        return last - first

    def contradiction(self) -> Contradiction:
        """That the runs to verify speak against the effect, with the number of standard errors."""
        told = self.after is not None and not self.free_run
        deviations = self.rise / max(self.std_error, TINY) if told else None
        return Contradiction(
            self.effect, self.before, self.after, deviations, (), self.unstable, self.free_run, self.with_mean or ()
        )


def verify_change(
    effect: str, runs: Sequence[Run], before: Sequence[Array], after: Sequence[Array],
    means: tuple[Array, Array] | None = None,
) -> VerifyChange | None:  # fmt: skip
    """How the error over `runs` changes with an effect; None where the model is unstable without it.

    `before` and `after` are the residuals of each run without the effect and with it, (n,), less their mean or over
    windows; `means` are those that count in what was fitted, (runs,) each: the errors with them then decide. The
    standard error is that of the difference, by a bootstrap over chunks of ten correlation times (Künsch 1989), at
    least four a run.
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
    tabled, tabled_std_error = (_error(runs, before), _error(runs, after)), _error_of_difference(runs, before, after)
    return VerifyChange(effect, *tabled, std_error, with_mean=with_mean, shown=shown, tabled_std_error=tabled_std_error)


def _raised(residuals: Sequence[Array], means: Array) -> list[Array]:
    return [residual + mean for residual, mean in zip(residuals, means, strict=True)]


def _error(runs: Sequence[Run], residuals: Sequence[Array]) -> float:
    """The root mean square of residuals over the deviations of the outputs, averaged over runs."""
    sizes = [float(np.std(run.measured)) for run in runs]
    return float(over_runs([np.sqrt(np.mean(r**2)) / size for r, size in zip(residuals, sizes, strict=True)], runs))


def _error_of_difference(runs: Sequence[Run], before: Sequence[Array], after: Sequence[Array]) -> float:
    """The standard error of the difference of two errors, by a bootstrap over chunks of each run."""
    random, resamples = np.random.default_rng(0), CRITERIA.verification.resamples
    drawn = np.empty((2, len(runs), resamples))
    for i, (run, *residuals) in enumerate(zip(runs, before, after, strict=True)):
        chunks = _chunks(residuals[0])
        picked = random.integers(len(chunks), size=(resamples, len(chunks)))
        for model, residual in enumerate(residuals):
            sums = np.array([np.sum(residual[chunk] ** 2) for chunk in chunks])
            counts = np.array([chunk.stop - chunk.start for chunk in chunks])
            power = sums[picked].sum(axis=1) / counts[picked].sum(axis=1)
            drawn[model, i] = np.sqrt(power) / float(np.std(run.measured))
    return float(np.std(over_runs(drawn[1], runs) - over_runs(drawn[0], runs)))


def with_free_run(over_windows: VerifyChange, before: FreeRun, after: FreeRun) -> VerifyChange:
    """The change over windows; or that of the free run, where it is driven away and no window speaks for the effect.

    An effect that windows confirm may act where the record drifts for another reason.
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


def _chunks(residual: Array) -> list[slice]:
    """Neighbouring samples that tell together about as much as ten that know nothing of each other."""
    n = len(residual)
    length = int(
        np.clip(
            CRITERIA.verification.chunk_length * n / independent_samples(residual),
            1,
            max(n // CRITERIA.verification.least_chunks, 1),
        )
    )
    return [slice(first, min(first + length, n)) for first in range(0, n, length)]
