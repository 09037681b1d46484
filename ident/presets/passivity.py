"""A specimen that is moved takes work: where a record says that it gives work back, a channel has the wrong sign."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ident.matrix import Matrix
from ident.run import Run

_SURE = -0.1  # of the deviations: a spring or a mass alone takes no work in the mean, and noise neither


def work(run: Run) -> float | None:
    """mean(F v) over the product of the deviations, −1 … 1; None where the run has no force and speed of its own."""
    if run.output != "force" or not {"force", "velocity"} <= run.channels.keys():
        return None
    force, speed = (samples - samples.mean() for samples in (run.channels["force"], run.channels["velocity"]))
    size = float(np.std(force) * np.std(speed))
    return float(np.mean(force * speed)) / size if size > 0 else 0.0


def gives_work_back(run: Run) -> bool:
    """Whether a moved specimen would have to drive what moves it."""
    found = work(run)
    return found is not None and found < _SURE


def passive(matrix: Matrix) -> Matrix:
    """The matrix with the sign of the force turned in every run in which the specimen would give work back."""
    wrong = [run for run in matrix.runs if gives_work_back(run)]
    if not wrong:
        return matrix
    ids = ", ".join(run.id for run in wrong)
    worst = max(work(run) or 0.0 for run in wrong)
    said = (
        f"The force of {ids} is taken with the other sign: as recorded, force times speed is {worst:.2f} of their "
        f"deviations in the mean, so that a specimen without a drive of its own would give work back."
    )
    runs = tuple(run.turned("force") if run in wrong else run for run in matrix.runs)
    return replace(matrix, runs=runs, notices=(said, *matrix.notices))
