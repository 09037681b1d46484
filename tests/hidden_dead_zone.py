"""A small matrix of the independent reference with a dead zone hidden in it: files, an archive, a folder."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from tests.app.conftest import archived, packed, unpacked
from tests.reference import nonlinear_reference as reference
from tests.reference import qian_reference as linear

HALF_WIDTH = 8e-5  # m: the linear model is then some times the noise off
SECONDS = 0.5


@lru_cache
def files(serial: str = "DZ-1") -> dict[str, bytes]:
    """Nine runs of half a second: name → bytes."""
    trials = linear.trials()
    chosen = [trial for trial in trials if trial.use == "fit"][::9] + trials[-2:]
    hidden = reference.named({"dead_zone.h": HALF_WIDTH})
    return packed(reference.measure_all(hidden, chosen, seconds=SECONDS, noise=0.005, seed=3), serial)


@lru_cache
def zipped(serial: str = "DZ-1") -> bytes:
    """The same as one archive."""
    return archived(files(serial))


def write(folder: Path, serial: str = "DZ-1") -> Path:
    """The same as a folder."""
    return unpacked(files(serial), folder)
