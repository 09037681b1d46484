"""The stretches in which the inputs of a run rest: the machine moves by itself there, if it moves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy  # ndimage, which takes long to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.run import DISTURBANCES, KINEMATIC, MOTIONS, Run, Samples

HELD = 0.002  # of an input's range, within which the input rests
_LOOKED_AT = 8
"""Samples of a stretch that are looked at first. No answer depends on it."""
STATES = ("load_pressure", "pressure_a", "pressure_b", "spool", "temperature")
"""Channels that follow from the inputs."""


def acting(run: Run) -> list[Samples]:
    """All recorded signals that act on the machine; none where nothing drives it.

    These are the command, forces and disturbances, and the motion where something else answers to it.
    """
    answers = {run.output, *STATES, *(KINEMATIC if run.output in KINEMATIC else ())}
    signals = {name: samples for name, samples in run.channels.items() if name not in answers}
    driven = {"command", "drive_force", *DISTURBANCES, *MOTIONS} & signals.keys()
    return list(signals.values()) if driven else []


def held(inputs: Sequence[Samples], samples: int) -> NDArray[np.bool_]:
    """Whether every input rests over so many samples from each on, (n − samples + 1,)."""
    if not all(_may_rest(u, samples) for u in inputs):
        return np.zeros(max(len(inputs[0]) - samples + 1, 0), dtype=bool)
    return np.asarray(np.all([spans(u, samples) <= HELD * np.ptp(u) for u in inputs], axis=0))


def _may_rest(x: Samples, samples: int) -> bool:
    """Whether a few samples of each stretch allow that it rests: next to no stretch of noise does."""
    step = max(1, samples // _LOOKED_AT)
    near = np.abs(np.diff(x[::step])) <= HELD * np.ptp(x)
    count = samples // step - 1  # of the differences that lie in any stretch
    return count < 1 or len(near) < count or bool(np.convolve(near, np.ones(count)).max() > count - 0.5)


def spans(x: Samples, samples: int) -> Samples:
    """The largest less the least of so many samples from each on, (n − samples + 1,)."""
    found = scipy.ndimage.maximum_filter1d(x, samples) - scipy.ndimage.minimum_filter1d(x, samples)
    return np.asarray(found[samples // 2 : len(x) - (samples - 1 - samples // 2)], np.float64)


def rests(inputs: Sequence[Samples], least: int) -> list[slice]:
    """The stretches of at least so many samples in which every input rests."""
    length = len(inputs[0])
    if length < least:
        return []
    begins = np.flatnonzero(held(inputs, least))
    groups = np.split(begins, np.flatnonzero(np.diff(begins) > 1) + 1)
    return [slice(int(group[0]), int(group[-1]) + least) for group in groups if len(group)]
