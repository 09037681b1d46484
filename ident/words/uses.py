"""What runs are used for, in the field's words; files and JSON keep the names `fit`, `held_out` and `verify`."""

from __future__ import annotations

DATA = {"fit": "estimation", "held_out": "held-out", "verify": "validation"}
"""The parameters are estimated on the first. The last are used neither by a fit nor by a ranking (Ljung 1999, 16.5)."""


def data(use: str) -> str:
    """ "estimation data", "held-out data", "validation data"."""
    return f"{DATA[use]} data"


def runs(use: str) -> str:
    """ "estimation runs", "held-out runs", "validation runs"."""
    return f"{DATA[use]} runs"
