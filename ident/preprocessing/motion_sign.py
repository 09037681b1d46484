"""A force moves a mass to its own side: where a record says otherwise, the motion is counted the other way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.preprocessing.power import GIVES_BACK, mean_power
from ident.preprocessing.step import Threshold
from ident.presets.preset import Preset
from ident.run import Run
from ident.stages import ACTING_PRESSURE, DIRECT_FORCE, OPENED_BY_COMMAND, TORQUE

Array = NDArray[np.float64]
_DRIVES = (DIRECT_FORCE, ACTING_PRESSURE, TORQUE)
"""Stages whose force has the sign of what drives."""
_INTEGRALS = {"displacement": 2, "velocity": 1, "acceleration": 0}
"""How often the balance of forces is integrated, so that a motion stands in it without a derivative."""
BALANCED = Threshold(
    0.1,
    "of the power of the drive, integrated twice",
    "a balance of mass, damping and spring leaves less with the sign that is right, and more with the other",
    "what drifts away is next to a polynomial, whose rest a balance of the wrong sign explains by half, too",
)


def drives_mass(model: Preset) -> bool:
    """Whether a force, a pressure or a torque, which has the sign of what was recorded, drives a mass in open loop.

    In a loop the other sign would be no machine: it would run away.
    """
    stages = model.chain.stages
    in_open_loop = DIRECT_FORCE in stages or OPENED_BY_COMMAND in stages
    return in_open_loop and any(drive in stages for drive in _DRIVES)


def against_its_drive(run: Run) -> bool | None:
    """Whether the motion of a run is counted against the force that drives it; None where the run does not tell.

    Of the balance p = m x″ + c x′ + k x + p₀, m, c and k ≥ 0 are found by least squares. It is integrated twice for a
    position and once for a speed, which needs no derivative of a record; first states and p₀ are a polynomial of second
    degree in the time. The run tells the sign where such a balance leaves less than a tenth of the drive with one sign,
    and more with the other.

    A controller that drives the motion back to a reference looks like a spring of the other sign, u = k (r − x). So the
    motion is not turned where it takes work of the drive as it was recorded, which no mass, damper or spring gives.
    """
    drive, motion = run.command, run.measured
    if not (np.ptp(drive) > 0 and np.ptp(motion) > 0):
        return None
    time = np.linspace(-1.0, 1.0, len(drive))
    smooth = np.linalg.qr(np.column_stack([time**power for power in range(3)]))[0]
    target = _integrated(drive, _INTEGRALS.get(run.output, 1))
    terms = np.column_stack([_integrated(motion, times) for times in range(3)])
    target, terms = (part - smooth @ (smooth.T @ part) for part in (target, terms))
    right, turned = (_left(sign * target, terms / np.linalg.norm(terms, axis=0)) for sign in (1.0, -1.0))
    if not min(right, turned) < BALANCED.value < max(right, turned):
        return None
    speeds = {"displacement": np.gradient(motion), "acceleration": terms[:, 1]}
    speed = speeds.get(run.output, motion)
    return turned < right and mean_power(-drive, speed) >= GIVES_BACK.value


def _left(target: Array, terms: Array) -> float:
    """The share of the power of the target that the terms leave with coefficients that are not negative, at most 1."""
    from scipy.optimize import nnls  # noqa: PLC0415 - a record is read without it

    return float(nnls(terms, target)[1] ** 2 / np.sum(target**2))


def _integrated(samples: Array, times: int) -> Array:
    """The integral of the samples, over their number, so many times, less their mean before each."""
    for _ in range(times):
        centred = samples - samples.mean()
        samples = np.concatenate([[0.0], np.cumsum((centred[1:] + centred[:-1]) / 2.0)]) / len(samples)
    return samples
