"""A command that a controller made of the output: plain output error is biased by it.

An open-loop command cannot know what disturbed the output. Its own past foretells it as well as its own past with that
of the output does (Granger 1969); what both leave are its innovations. A controller's command is foretold better by
both, for the output brings disturbances and noise round the loop.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ident.checks.finding import Finding
from ident.run import Run, Samples
from ident.statistics.robust import robust_deviation
from ident.words.message import message

CODE = "closed-loop"
OWN, OTHER = 40, 12  # lags of the command's past, and of the output's beside as many more of the command's
LONGEST = 8192  # samples that are looked at, from the middle of the record
LEAST = 6  # samples a regressor
FLOOR = 1e-4  # innovations, of the command's deviation: below it is foretold to rounding, as a band-limited one is
ORDINARY = 6.0  # robust deviations of the innovations: jumps of a reference lie beyond
FOLDS = 8  # parts of the record, every second of which is foretold from the others
PAST = 0.05  # of the innovations' power, foretold by the output's past; in open loop 0.02
PRESENT = 0.3  # foretold where the output's present is added: a quick controller has it
RIDGE = 1e-12  # of the regressors' power: least squares of what is nearly collinear
STILL = 0.5  # of the samples, in rests longer than the output's past that is looked at: what noise moves has no such
ROUNDS = 5  # in which jumps are told from the rest


def feedback(run: Run) -> Iterator[Finding]:
    """A doubt where the command is a controller's output."""
    found = shares(run) if run.closed_loop is None else None
    if found and _fed_back(*found):
        text = message("check.closed_loop", run=run.id, share=max(found))
        yield Finding.of(run.id, "doubt", CODE, text)


def closed_loop(run: Run) -> bool:
    """Whether a controller made the command, as stated or else as the record shows."""
    if run.closed_loop is not None:
        return run.closed_loop
    found = shares(run)
    return found is not None and _fed_back(*found)


def _fed_back(past: float, present: float) -> bool:
    return past > PAST or present > PRESENT


def shares(run: Run) -> tuple[float, float] | None:
    """The share of the command's innovations that the output's past foretells, and with it the output's present.

    Each is the lesser of two halves of the record, foretold from the other. None where the command does not counteract
    what the output does, and where nothing can be told: a command that its own past foretells to rounding but for
    jumps or that moves between levels, too short a record, or one of an uneven clock, between whose samples nobody
    knows the command.
    """
    if "command" not in run.channels or run.stepped or run.evened or run.kind in ("sine", "frequency"):
        return None
    first, lags = max(0, (run.length - LONGEST) // 2), OWN + OTHER
    u, y = (_scaled(signal[first : first + LONGEST]) for signal in (run.command, run.measured))
    if len(u) - lags < LEAST * (lags + OTHER) or _still(u) > STILL:
        return None
    # What is foretold, the mean and the command's past; then the output's past; then its present.
    table = np.column_stack(
        [
            _lagged(u, 0, 1, lags),
            np.ones(len(u) - lags),
            _lagged(u, 1, lags, lags),
            _lagged(y, 1, OTHER, lags),
            _lagged(y, 0, 1, lags),
        ]
    )
    rows = _ordinary(table[:, : lags + 2])
    if rows is None:
        return None
    half = np.arange(len(table)) * FOLDS // len(table) % 2
    halves = [_products(table[rows & (half == side)]) for side in (0, 1)]
    alone, past, present = (_left(halves, count) for count in (lags + 2, lags + OTHER + 2, lags + OTHER + 3))
    # A controller counteracts; a clock that strays, or noise on the command's record, makes both move alike.
    if _weights(halves[0] + halves[1])[-1] * float(u[:-1] @ np.diff(y)) >= 0:
        return None
    return float(np.min(1.0 - past / alone)), float(np.min(1.0 - present / alone))


def _still(signal: Samples) -> float:
    """The share of the samples at which a signal has stood still for longer than OTHER samples.

    A controller moves with each sample of a noisy output. Ramps between levels begin where an output that settles
    is always alike, so that it foretells them: no controller made them.
    """
    moves = np.flatnonzero(np.diff(signal))
    rests = np.diff(np.concatenate([[-1], moves, [len(signal) - 1]]))
    return float(rests[rests > OTHER].sum()) / len(signal)


def _scaled(signal: Samples) -> Samples:
    scaled: Samples = (signal - signal.mean()) / (float(np.std(signal)) or 1.0)
    return scaled


def _lagged(signal: Samples, first: int, count: int, after: int) -> Samples:
    """The signal at `count` lags from the first on, for every sample behind `after`, (n, count)."""
    return np.column_stack([signal[after - lag : len(signal) - lag] for lag in range(first, first + count)])


def _products(table: Samples) -> Samples:
    """Mean products of the columns, (k, k)."""
    return np.asarray(table.T @ table / max(len(table), 1))


def _weights(products: Samples) -> Samples:
    """The least squares by which the first column is foretold from the others, (k − 1,)."""
    normal = products[1:, 1:]
    ridge = RIDGE * np.trace(normal) * np.eye(len(normal))
    return np.asarray(np.linalg.solve(normal + ridge, products[1:, 0]), np.float64)


def _ordinary(table: Samples) -> NDArray[np.bool_] | None:
    """The rows without jumps of the command; None where the rest of the command there is rounding, or hardly a row
    remains."""
    rows = np.ones(len(table), bool)
    for _ in range(ROUNDS):
        left = table[:, 0] - table[:, 1:] @ _weights(_products(table[rows]))
        size = robust_deviation(left[rows])
        rows = np.abs(left) <= ORDINARY * size
        if size < FLOOR or rows.sum() < LEAST * table.shape[1]:
            return None
    return rows


def _left(halves: Sequence[Samples], count: int) -> Samples:
    """The mean square of the prediction error on each half by a regression on the other with `count` columns, (2,)."""
    found = []
    for known, asked in (halves, halves[::-1]):
        error = np.concatenate([[-1.0], _weights(known[:count, :count])])
        found.append(error @ asked[:count, :count] @ error)
    return np.array(found)
