"""From which error on a model counts as unstable on a run, and the error of a run as it is kept."""

from __future__ import annotations

import math

UNSTABLE = 1e3
"""The error of eq. (17), 1, from which on a model counts as unstable on a run; an error is at most so large.

A model that stays bounded leaves what it and the record hold together, a few times the record. A thousand times comes
only of a growing mode, and how many powers of ten it has grown by says how long the record is, not how wrong the model.
"""


def bounded(error: float) -> float:
    """An error of one run as it is kept: a number at most :data:`UNSTABLE`, so that JSON can hold it."""
    return min(error, UNSTABLE) if math.isfinite(error) else UNSTABLE
