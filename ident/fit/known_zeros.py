"""Zeros that rest tells: where a fit leaves out a mean that the records tell, it is made again with it.

Eq. (17) does not see the mean of a run, so that an offset, a constant force and a weak spring may stand for each other
without end. A run that begins at rest, or sets out from zero, tells what its transducer reads there: an observation of
the offset b with its standard error, b₀ ± σ (:func:`ident.beginning.zero_at_rest`). A fit of eq. (17) whose offset
agrees with it, or is small, stays as it is. One whose offset is large and another contradicts the record: then the mean
counts in what is fitted, with the observation as the prior of b (:mod:`ident.fit.transducer`), and a run that sets out
begins at rest.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from ident.fit.criteria import FIT_CRITERIA
from ident.fit.transducer import Optimal, is_large, offsets, rest_of
from ident.matrix import Matrix
from ident.run import Run


def with_known_zeros(matrix: Matrix, channels: Collection[str]) -> Matrix:
    """The matrix with means that count in the runs of these transducers; those that were zeroed by hand stay so."""
    if not channels:
        return matrix

    def known(run: Run) -> Run:
        if run.output not in channels or run.output in run.zeroed:
            return run
        begins = run.assumed_beginning if run.zero_at_rest is None else "at rest"
        return replace(run, zeroed={**run.zeroed, run.output: False}, assumed_beginning=begins)

    return replace(matrix, runs=tuple(known(run) for run in matrix.runs))


def contradicted_zeros(here: Optimal, runs: Sequence[Run]) -> tuple[str, ...]:
    """The transducers of whose runs a large mean is left at an optimum, where rest tells that there is none.

    It is left as an offset that is three standard errors from what rest tells, or by first states that stand for any.
    """
    zeros: dict[str, tuple[float, float]] = {}
    for name in sorted({run.output for run in runs}):
        numbers = [i for i, run in enumerate(runs) if run.output == name and run.zeroed.get(name) is None]
        rest = rest_of(runs[i].zero_at_rest for i in numbers)
        if rest is not None and is_large([here.runs[i] for i in numbers]):
            zeros[name] = rest
    fitted = offsets(here) if zeros else {}
    return tuple(
        name
        for name, (zero, error) in zeros.items()
        if name not in fitted or abs(fitted[name].value - zero) > FIT_CRITERIA.offsets.recognised * error
    )
