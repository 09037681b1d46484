"""A planned record of a bench as the reference's control unit plays it on an actuator."""

from __future__ import annotations

import numpy as np

from ident.planning.planned_run import PlannedRun
from tests.reference.kononykhin_reference import TABLE, Instruments, Record, Truth, record

STEEPEST = 2000.0  # % of current a second


def played(run: PlannedRun, truth: Truth | None = None, seed: int = 1, read: Instruments = TABLE) -> Record:
    """What is recorded. The reference has per cent and mm, where a law has rated currents and m."""
    law = run.law
    assert law is not None
    offset, two, three, four = law.settings
    settings = {
        0: [100 * offset, 0.1 * two, 1e3 * three, 1e3 * four],
        1: [100 * offset, 100 * two, three, 0.1 * four],
        2: [100 * offset, 100 * two, three, four, STEEPEST],
        3: [100 * offset, 100 * two, 100 * three, 1e3 * four, STEEPEST],
    }[law.number]
    rng = np.random.default_rng(seed)
    truth = truth or Truth(I0=100 * offset)
    frequency = law.named.get("frequency", 0.0)
    return record(
        truth, run.id, run.kind, law.number, settings, law.seconds, 1e3 * law.start, rng, read, frequency=frequency
    )
