"""The mean of a correlated series with its error, from blocks of ten correlation times, or from whole runs.

    mean of the blocks ± t s / √k       s their standard deviation, t Student's of k − 1 degrees of freedom

The blocks of a short record are shorter, so that there are enough of them to tell their scatter. Whether a mean is
above a value is one question with one answer: t is the point that chance passes on that side.

With a fixed number of blocks Student's t is the limit of the studentised mean of any stationary series, whatever its
spectrum (Kiefer and Vogelsang 2005; Ibragimov and Müller 2010). The mean difference of the losses of two models is
judged by it. The models may be nested or not, and both may be wrong (Vuong 1989).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.evidence import BlockMean

Array = NDArray[np.float64]


def block_mean(series: Sequence[Array], criteria: EvidenceCriteria) -> BlockMean:
    """The mean over runs of the means of their series (n,): runs are the blocks where there are several."""
    return _of(*_means(series, _blocks(series, criteria)))


def block_ratio(part: Sequence[Array], whole: Sequence[Array], criteria: EvidenceCriteria) -> BlockMean:
    """The mean of one series over the mean of another, with the error of a ratio (Cochran 1977, 6.4).

    The error of the ratio is the error of the mean of part − ratio × whole, over the mean of the whole: blocks of
    another size, in which the same share is taken, add nothing to it. It is infinite where the whole has no mean above
    zero.
    """
    blocks = _blocks(part, criteria)
    (parts, weights), (wholes, _) = _means(part, blocks), _means(whole, blocks)
    scale = float(weights @ wholes)
    if not scale > 0:
        return BlockMean(0.0, float("inf"), len(parts))
    ratio = float(weights @ parts) / scale
    return BlockMean(ratio, _of(parts - ratio * wholes, weights).error / scale, len(parts))


def correlation_time(series: Array) -> float:
    """1 + 2 Σ ρ_k in samples, at least 1: the sum ends at `correlation_window` times itself (Sokal 1997).

    A power of two scales the series, since the squares of a run that nearly left all numbers are none.
    """
    n, centred = len(series), series - np.mean(series)
    centred = np.ldexp(centred, -np.frexp(np.max(np.abs(centred)))[1])
    length = 1 << (2 * n - 1).bit_length()
    correlation = np.fft.irfft(np.abs(np.fft.rfft(centred, length)) ** 2, length)[: max(n // 2, 1)]
    if not correlation[0] > 0:
        return 1.0
    summed = 2.0 * np.cumsum(correlation / correlation[0]) - 1.0
    ends = np.flatnonzero(np.arange(len(summed)) >= EVIDENCE_CRITERIA.correlation_window * summed)
    return max(float(summed[ends[0]] if len(ends) else summed.max()), 1.0)


def _blocks(series: Sequence[Array], criteria: EvidenceCriteria) -> list[int]:
    """The number of blocks of the series of each run."""
    if len(series) >= criteria.whole_runs:
        return [1] * len(series)
    least, most = max(2, -(-criteria.least_blocks // len(series))), criteria.most_blocks
    lengths = [_length_of_a_block(run, criteria) for run in series]
    counts = [int(np.clip(len(run) / length, least, most)) for run, length in zip(series, lengths, strict=True)]
    return [min(count, len(run)) for count, run in zip(counts, series, strict=True)]


def _length_of_a_block(series: Array, criteria: EvidenceCriteria) -> float:
    """The length of a block in samples."""
    time = correlation_time(series)
    shortest, longest = criteria.least_correlation_times * time, criteria.correlation_times * time
    return float(np.clip(len(series) / criteria.enough_blocks, shortest, longest))


def _means(series: Sequence[Array], blocks: Sequence[int]) -> tuple[Array, Array]:
    """The mean of each block, and its weight: all runs have the same weight."""
    parts = [np.array_split(run, n) if n > 1 else [run] for run, n in zip(series, blocks, strict=True)]
    means = [float(np.mean(part)) for of_run in parts for part in of_run]
    weights = [len(part) / len(run) / len(series) for run, of_run in zip(series, parts, strict=True) for part in of_run]
    return np.array(means), np.array(weights)


def _of(values: Array, weights: Array) -> BlockMean:
    mean, k, parts = float(weights @ values), len(values), tuple((weights * values).tolist())
    if k < 2:
        return BlockMean(mean, float("inf"), k, parts)
    error = float(np.sqrt(np.sum((weights * (values - mean)) ** 2) * k / (k - 1)))
    return BlockMean(mean, error, k, parts)
