"""The whole identification of the 63 + 21 × 30 s matrix with the default method, arrays in memory."""

from __future__ import annotations

import statistics
import time

from benchmarks import material
from benchmarks.table import Table
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from ident.matrix import Matrix

GOAL = 1.5  # s, for each of the two parts


def timed(matrix: Matrix, seed: int) -> tuple[float, float, float, float]:
    """Seconds of preparing the spectra, of the search, of polish and uncertainty, and the error on the verify runs."""
    start = time.perf_counter()
    work = Identification(matrix, Settings(seed=seed))
    prepared = time.perf_counter()
    state = work.start()
    while not work.finished(state):
        state = work.advance(state, work.generations)
    searched = time.perf_counter()
    fit = work.finish(state)
    return prepared - start, searched - prepared, time.perf_counter() - searched, float(fit.error["verify"] or 0)


def measure() -> Table:
    """Median of five seeds; the first run compiles and is left out."""
    timed(material.matrix(1.0), seed=0)
    matrix = material.matrix()
    # Fresh arrays each time would be the same: a run caches only whether it starts at rest.
    rows = [timed(matrix, seed) for seed in range(5)]
    spectra, search, finish, error = (statistics.median(column) for column in zip(*rows, strict=True))
    return Table(
        "Identification",
        f"Default method, six parameters, median of {len(rows)} seeds; error at Kp = 6: {100 * error:.3f} % "
        "(noise 0.5 %).",
        ("part", "time"),
        [
            ("spectra", f"{spectra:.2f} s"),
            ("search", f"{search:.2f} s"),
            ("polish, errors of 84 runs, uncertainty", f"{finish:.2f} s"),
            ("search to result", f"{search + finish:.2f} s"),
        ],
        f"spectra in {GOAL} s, then the result in {GOAL} s",
        spectra <= GOAL and search + finish <= GOAL,
    )
