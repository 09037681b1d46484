"""The peer: eq. (17) of the matrix the way one writes it with SciPy, `cont2discrete` and `lfilter`, on every core."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from itertools import groupby

import numpy as np
from scipy.signal import cont2discrete, lfilter
from threadpoolctl import threadpool_limits

from ident.run import Run

AREA = 497e-6
_METHOD = {"linear": "foh", "zoh": "zoh"}
_shared: list[list[tuple[Run, float]]] = []


def share(runs: tuple[Run, ...]) -> None:
    """Put the runs that differ in amplitude only side by side, so that each filter is designed once."""
    groups = groupby(runs, key=lambda run: (run.specimen, run.Kp))
    _shared[:] = [[(run, float(run.measured.std())) for run in group] for _, group in groups]


def transfer_function(vector: np.ndarray, run: Run) -> tuple[list[float], list[float]]:
    """Eqs. (10)-(15)."""
    Z0, tau, Cl, c0, m0, Ka = vector
    assert run.specimen is not None
    m, c, k = m0 + run.specimen.mass, c0 + run.specimen.damping, run.specimen.stiffness
    return [Z0 * run.Kp], [
        Ka * tau * m,
        Ka * tau * c + tau * Cl * m + Ka * m,
        Ka * tau * k + tau * Cl * c + Ka * c + AREA**2 * tau + m * Cl,
        tau * Cl * k + Ka * k + AREA**2 + Cl * c,
        Z0 * run.Kp + Cl * k,
    ]


def error(vector: np.ndarray) -> float:
    """Eq. (17) averaged over the shared runs, one parameter vector, one core; a run at a time stays in the cache."""
    errors: list[float] = []
    for group in _shared:
        first = group[0][0]
        b, a, _ = cont2discrete(transfer_function(vector, first), 1 / first.sample_rate, method=_METHOD[first.hold])
        for run, spread in group:
            difference = lfilter(b.ravel(), a, run.command)
            np.subtract(run.measured, difference, out=difference)
            errors.append(float(difference.std()) / spread)
    return float(np.mean(errors))


@contextmanager
def on_all_cores(kind: str) -> Iterator[Callable[[np.ndarray], list[float]]]:
    """A function that takes vectors to errors, a vector a task, over "threads" or "processes"."""
    cores = os.cpu_count() or 1
    pool: Executor = (
        ThreadPoolExecutor(cores)
        if kind == "threads"
        else ProcessPoolExecutor(cores, mp_context=multiprocessing.get_context("fork"))
    )
    # Small matrices on many threads of a BLAS would only wait for each other: one thread makes this side twice as fast.
    with threadpool_limits(1), pool:
        yield lambda vectors: list(pool.map(error, vectors))
