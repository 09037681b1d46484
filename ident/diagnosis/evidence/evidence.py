"""The evidence of a comparison of two fitted models: every statement on them follows from it.

:mod:`ident.diagnosis.evidence.comparison` works it out, :mod:`ident.diagnosis.evidence.rule` decides by it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass

from scipy.special import stdtrit  # the quantile of Student's t, without scipy.stats, which takes half a second to load

from ident.cached import cached_property
from ident.diagnosis.evidence.criteria import EvidenceCriteria
from ident.diagnosis.evidence.free_run import FreeRun

SPANS = {"first half": (0.0, 0.5), "second half": (0.5, 1.0)}
"""The spans of the records, as shares of each, on none of which an effect may lose; a user reads their names."""


@dataclass(frozen=True)
class BlockMean:
    """A mean, its standard error, and the number of blocks. The error of one block is infinite.

    `parts` are the contributions of the blocks, which sum to the mean and may be negative, for a rule that asks each
    block; a ratio has none. Of four runs or more a block is a run; of fewer, each has at least two blocks. Of the means
    of the runs each block is a run, also of two.
    """

    mean: float
    error: float
    blocks: int
    parts: tuple[float, ...] = ()

    def bound(self, criteria: EvidenceCriteria) -> float:
        """How far chance may carry the mean to one side."""
        if self.blocks < 2:
            return float("inf")
        return self.error * float(stdtrit(self.blocks - 1, 1.0 - criteria.chance))

    def above(self, value: float, criteria: EvidenceCriteria) -> bool:
        """Whether the mean is above a value beyond its error."""
        return self.mean - self.bound(criteria) > value

    def below(self, value: float, criteria: EvidenceCriteria) -> bool:
        """Whether the mean is below a value beyond its error."""
        return self.mean + self.bound(criteria) < value


NO_DIFFERENCE = BlockMean(0.0, 0.0, 1)
"""The difference of the means of one run: its error is not known."""


@dataclass(frozen=True)
class Evidence:
    """The evidence for the model `after` against the model `before`, on data that neither was fitted to.

    `gain` is G (nats), `without` is G without the run that gains most, `most` is the gain of a model whose residual is
    the noise, `distinct` is ν. `before`, `after` and `noise` are powers of the error over the power of the output,
    averaged over runs; `difference` is before − after and `share` ρ, with their errors, and `weighted_share` is the
    same share of the loss, in which each band is weighted by the disturbance there; `by_part` works out `parts`, the
    differences on each condition and each span. `apart` is the power of the difference of the two outputs,
    `resolved` the power of the least difference that the noise does not hide.

    The means of the runs, less their common mean, are judged by themselves. `level` is their root mean square before,
    and `levels_apart` is the root mean square of the difference of the two models' means, both over the outputs'
    deviations; `level_difference` and `level_share` are of their squares, a run a block.

    `by_free_run` works out the free runs of both models for a machine that is fitted over windows; it is None for
    others.
    """

    gain: float
    without: float
    most: float
    distinct: float
    before: float
    after: float
    noise: float
    difference: BlockMean
    share: BlockMean
    by_part: Callable[[], Mapping[Hashable, BlockMean]]
    apart: float
    resolved: float
    level: float = 0.0
    levels_apart: float = 0.0
    weighted_share: BlockMean = NO_DIFFERENCE
    level_difference: BlockMean = NO_DIFFERENCE
    level_share: BlockMean = NO_DIFFERENCE
    by_free_run: Callable[[], tuple[FreeRun, FreeRun]] | None = None

    @cached_property
    def parts(self) -> Mapping[Hashable, BlockMean]:
        """The differences on each condition and each span, worked out where they decide."""
        return self.by_part()

    @cached_property
    def free_runs(self) -> tuple[FreeRun, FreeRun] | None:
        """The free runs without and with the effect, worked out where they decide."""
        return self.by_free_run() if self.by_free_run else None

    @property
    def explainable(self) -> float:
        """The residual power of the first model above the noise."""
        return max(self.before - self.noise, 0.0)
