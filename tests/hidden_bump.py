"""A small matrix of the reference whose flow gain is larger at one part of the way: no list holds that."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from tests.app.conftest import archived, packed, unpacked
from tests.reference import qian_reference as linear
from tests.reference.outside_reference import Outside, measure_all

BUMP, NOISE = 0.25, 0.005  # of the flow gain; of each output's deviation
SECONDS = 0.5


@lru_cache
def files(serial: str = "BUMP-1") -> dict[str, bytes]:
    """Six runs of half a second to fit, of which a search parts no fewer, and three to verify: name → bytes."""
    trials = linear.trials()
    chosen = [trial for trial in trials if trial.use == "fit"][:72:12] + trials[-3:]
    hidden = Outside(gain_bump=BUMP)
    return packed(measure_all(hidden, chosen, linear.Plant(), seconds=SECONDS, noise=NOISE, seed=5), serial)


@lru_cache
def zipped(serial: str = "BUMP-1") -> bytes:
    """The same as one archive."""
    return archived(files(serial))


def write(folder: Path, serial: str = "BUMP-1") -> Path:
    """The same as a folder."""
    return unpacked(files(serial), folder)
