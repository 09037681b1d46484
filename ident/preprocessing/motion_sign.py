"""A force moves a mass to its own side: where a record says otherwise, the motion is counted the other way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ident.linear_filter import linear_filter
from ident.noise.effective_sample_size import independent_samples
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
FOLLOWED = Threshold(
    0.8,
    "of the output",
    "a motor of one sign leaves less, and nothing that follows the drive with the other sign does",
    "a dead zone, a limit or an end stop hides the balance, but not the way in which a drive moves a motor",
)
TOLD = Threshold(
    2.0,
    "standard errors",
    "the correlation with what the motor shows is beyond chance, by the number of independent samples of the output",
    "a position that wanders by itself follows any command for a while",
)
_LAGS = 9  # time constants of a motor, from a sample to the whole record


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


def a_motor_is_against(runs: Sequence[Run]) -> bool:
    """Whether a motor explains the positions, or the speeds, of the runs only where it turns against its drive.

    The motor is a lag of the speed, T v' + v = K u, without any of the effects that a machine may have. Where a run
    stands, and how fast it moves as it begins, is free. What follows its drive with the right sign, as a loop or a mass
    on a spring does, is not against it.
    """
    integrated = all(run.output == "displacement" for run in runs)
    if not (integrated or all(run.output == "velocity" for run in runs)):
        return False
    shown, least = [_centred(run, run.measured) for run in runs], {1.0: 1.0, -1.0: 1.0}
    for place in np.linspace(0.0, 1.0, _LAGS):
        lagged = [_lagged(run.command, run.length**-place) for run in runs]
        ways = [np.cumsum(speed) if integrated else speed for speed in lagged]
        sign, left = _explained(shown, [_centred(run, way) for run, way in zip(runs, ways, strict=True)])
        least[sign] = min(left, least[sign])
        sign, left = _explained(shown, [_centred(run, x) for run, x in zip(runs, lagged, strict=True)])
        least[1.0] = min(left, least[1.0]) if sign > 0 else least[1.0]
    if not least[-1.0] < FOLLOWED.value <= least[1.0]:
        return False
    speeds = [np.gradient(run.measured) if integrated else run.measured for run in runs]
    gives = all(mean_power(-run.command, v) >= GIVES_BACK.value for run, v in zip(runs, speeds, strict=True))
    errors = np.sqrt((1.0 - least[-1.0] ** 2) * sum(independent_samples(run.measured) for run in runs))
    return gives and bool(errors > TOLD.value)


def _explained(shown: Sequence[Array], by: Sequence[Array]) -> tuple[float, float]:
    """The sign of the factor by which signals explain what is shown best, and what they leave of it; each run counts
    by its mean square."""
    along, size, power = (
        sum(float(x @ y) / len(x) for x, y in zip(first, second, strict=True))
        for first, second in ((by, shown), (by, by), (shown, shown))
    )
    explained = along**2 / (size * power) if size * power > 0 else 0.0
    return (-1.0 if along < 0 else 1.0), float(np.sqrt(max(1.0 - explained, 0.0)))


def _lagged(drive: Array, pole: float) -> Array:
    """A drive (n,) behind a lag with this decay, samples⁻¹, from rest."""
    held = float(np.exp(-pole))
    return linear_filter([0.0, 1.0 - held], [1.0, -held], drive)


def _centred(run: Run, samples: Array) -> Array:
    """The samples without their mean, and without a straight line where a position begins at a speed of its own."""
    left = samples - samples.mean()
    if run.output == "displacement" and run.begins == "moving":
        line = np.linspace(-1.0, 1.0, run.length)
        left -= float(line @ left) / float(line @ line) * line
    return np.asarray(left)


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
