"""One generation of 200 vectors on the 63 × 30 s matrix: the program's fitness against plain SciPy."""

from __future__ import annotations

import numpy as np

from benchmarks import material, plain_scipy
from benchmarks.table import Table, seconds_of
from ident.fit.identification import Identification
from ident.fit.settings import Settings
from tests.reference import qian_reference as reference

GENERATION, SCIPY_VECTORS, GOAL = 200, 8, 1000


def measure() -> Table:
    """Time per vector and fitness evaluation, all cores, both sides in turn; and how well the two agree."""
    matrix = material.matrix()
    objective = Identification(matrix, Settings()).objective
    vectors = material.random_vectors(GENERATION)
    points = np.array([objective.space.point(dict(zip(reference.PARAMETERS, v, strict=True))) for v in vectors])
    objective.errors(points)
    plain_scipy.share(matrix.of_use("fit"))
    few = vectors[:SCIPY_VECTORS]
    with plain_scipy.on_all_cores("threads") as threads, plain_scipy.on_all_cores("processes") as processes:
        plain = np.array(threads(few))
        processes(few)
        ours, by_threads, by_processes = seconds_of(
            lambda: objective.errors(points), lambda: threads(few), lambda: processes(few), repeats=9
        )
    stable = plain < 10
    agreement = np.max(np.abs(objective.errors(points)[:SCIPY_VECTORS] / plain - 1)[stable])
    ours, theirs = ours / GENERATION, {"threads": by_threads / len(few), "processes": by_processes / len(few)}
    best = min(theirs.values())
    rows = [
        ("program, generation of 200", f"{1e3 * ours:.4f} ms", "1"),
        *((f"SciPy, {kind}", f"{1e3 * taken:.0f} ms", f"{taken / ours:.0f}") for kind, taken in theirs.items()),
    ]
    return Table(
        "Fitness",
        "Eq. (17) of 63 runs of 30 s at 4096 Hz, per parameter vector, on every core. SciPy: `cont2discrete` once for "
        "each of the 21 filters, `lfilter` over the runs. The two agree within "
        f"{100 * agreement:.3f} % at the vectors compared.",
        ("way", "per vector", "times the program's"),
        rows,
        f"at least {GOAL} times faster than the best SciPy way",
        best / ours >= GOAL,
    )
