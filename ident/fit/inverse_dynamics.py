"""Inverse-dynamics regression: mass and friction of a drive from its measured force and motion, without simulation.

    F = m x″ + c x′ + Fc sgn x′ + F0

is linear in mass m, viscous friction c, Coulomb friction Fc and offset F0 (Janot, Gautier, Brunot 2019 for the
electro-mechanical positioning system). Position and force pass the same zero-phase Butterworth low-pass, so that what
it takes from one it takes from the other; speed and acceleration are central differences of the filtered position. All
is decimated to four samples a period of the cut-off. Each run weighs by the inverse of its own residual's deviation.

Standstill: a sample slower than 2 % of its run's largest speed is left out, of the fit and of the residuals alike, for
dry friction there is whatever balances the force. So is one period of the cut-off at either end, where the filter has
too little to go on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy  # signal, which takes most of a second to load, is loaded where it is first used
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.fit.criteria import FIT_CRITERIA
from ident.matrix import Matrix
from ident.rounding import ROUNDING
from ident.run import Run
from ident.words.run_name import run_name

Array = NDArray[np.float64]
_OF = FIT_CRITERIA.inverse_dynamics
UNITS = {"mass": "kg", "viscous": "N*s/m", "coulomb": "N", "offset": "N"}
_CHANNELS = ("displacement", "drive_force")
_WITHOUT_FRICTION = tuple(place for place, name in enumerate(UNITS) if name != "coulomb")


@dataclass(frozen=True)
class Coefficient:
    """One coefficient with its standard error, which holds for residuals that are correlated in time."""

    value: float
    std_error: float
    unit: str


@dataclass(frozen=True)
class InverseDynamics:
    """Coefficients by name, and for each run std(F − F_model)/std(F) with dry friction and without it."""

    coefficients: Mapping[str, Coefficient]
    residual: Mapping[str, float]
    residual_without_friction: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class _Record:
    """Rows [x″, x′, sgn x′, 1] and force F (N) on an even grid; rows of samples left out are zero in both."""

    design: Array
    force: Array
    moving: NDArray[np.bool_]

    def error(self, columns: Sequence[int], solution: Array) -> Array:
        """F − F_model, zero where the sample is left out."""
        return np.asarray(self.force - self.design[:, columns] @ solution)

    def relative(self, columns: Sequence[int], solution: Array) -> float:
        """std(F − F_model)/std(F) in motion."""
        return float(np.std(self.error(columns, solution)[self.moving]) / np.std(self.force[self.moving]))


def regress(matrix: Matrix, cutoff: float = _OF.cutoff) -> InverseDynamics:
    """Fit the runs to fit; `cutoff` in Hz. Raises Unusable where no such run has drive_force and displacement."""
    runs = [run for run in matrix.runs if _has_channels(run)]
    if not any(run.use == "fit" for run in runs):
        raise Unusable(
            "missing-channel",
            "no run to fit has drive_force and displacement in known units",
            "runs",
            "name the column and unit of the drive's force and of its position",
        )
    if not 0 < cutoff <= min(run.sample_rate for run in runs) / _OF.samples_of_a_period:
        raise Unusable(
            "bad-value",
            f"cut-off {cutoff:g} Hz",
            "inverse dynamics",
            "give a positive one, a quarter of the sample rate at most",
        )
    records = {run.id: _record(run, cutoff) for run in runs}
    fitted = [records[run.id] for run in runs if run.use == "fit"]
    every = range(len(UNITS))
    solution, weights = _weighted(fitted, every)
    plain, _ = _weighted(fitted, _WITHOUT_FRICTION)
    found = zip(UNITS.items(), solution, _deviations(fitted, weights, solution), strict=True)
    return InverseDynamics(
        {name: Coefficient(float(value), float(error), unit) for (name, unit), value, error in found},
        {name: record.relative(every, solution) for name, record in records.items()},
        {name: record.relative(_WITHOUT_FRICTION, plain) for name, record in records.items()},
    )


def _has_channels(run: Run) -> bool:
    known = run.time_unit == "s" and all(run.units.get(name) != "1" for name in _CHANNELS)
    return known and all(name in run.channels for name in _CHANNELS)


def _record(run: Run, cutoff: float) -> _Record:
    rate, ends = run.sample_rate, int(run.sample_rate / cutoff)
    too_short = Unusable(
        "too-short",
        f"fewer than {_OF.fewest} samples in motion at a cut-off of {cutoff:g} Hz",
        run_name(run.id),
        "give a longer record of motion or leave the run out",
    )
    if len(run.channels["displacement"]) <= 2 * ends + _OF.fewest:
        raise too_short
    low_pass = scipy.signal.butter(_OF.order, cutoff, fs=rate, output="sos")
    x, force = (scipy.signal.sosfiltfilt(low_pass, run.channels[name]) for name in _CHANNELS)
    speed = np.gradient(x, 1 / rate)
    acceleration = np.gradient(speed, 1 / rate)
    # The sign is filtered like the force, or its jumps would stay sharp where the force's are not.
    sign = scipy.signal.sosfiltfilt(low_pass, np.sign(speed))
    grid = np.arange(ends, len(x) - ends, max(1, int(rate / (_OF.samples_of_a_period * cutoff))))
    moving = (np.abs(speed) > _OF.still * np.abs(speed[ends : len(x) - ends]).max())[grid]
    if np.count_nonzero(moving) < _OF.fewest:
        raise too_short
    design = np.column_stack([acceleration, speed, sign, np.ones(len(x))])[grid]
    if np.ptp(force[grid][moving]) <= ROUNDING * np.abs(force).max():
        raise Unusable("zero-variance", "the drive's force does not change", run_name(run.id), "check its column")
    return _Record(design * moving[:, None], force[grid] * moving, moving)


def _weighted(records: Sequence[_Record], columns: Sequence[int]) -> tuple[Array, Array]:
    """Least squares over all records, and again with each weighed by the inverse of its residual's deviation."""
    solution = _solved(records, columns, np.ones(len(records)))
    deviation = np.array([np.std(record.error(columns, solution)[record.moving]) for record in records])
    force = np.array([np.std(record.force[record.moving]) for record in records])
    weights = 1 / np.maximum(deviation, _OF.perfect * force)  # a perfect run must not have all the weight
    return _solved(records, columns, weights), weights


def _solved(records: Sequence[_Record], columns: Sequence[int], weights: Array) -> Array:
    pairs = list(zip(weights, records, strict=True))
    design = np.concatenate([weight * record.design[:, columns] for weight, record in pairs])
    force = np.concatenate([weight * record.force for weight, record in pairs])
    scale = np.linalg.norm(design, axis=0)
    if not scale.all() or np.linalg.matrix_rank(design / scale, tol=_OF.separated * np.sqrt(len(scale))) < len(scale):
        raise Unusable(
            "not-determined",
            "this motion does not separate mass, friction and offset",
            "inverse dynamics",
            "record motion both ways with speeds that change",
        )
    solution, *_ = np.linalg.lstsq(design / scale, force, rcond=None)
    return np.asarray(solution / scale)


def _deviations(records: Sequence[_Record], weights: Array, solution: Array) -> Array:
    """Standard errors: the sandwich H⁻¹ S H⁻¹ with S the long-run covariance of the scores, run by run.

    On the motion of the positioning system with coloured force noise of correlation times up to 0.2 s, the true scatter
    is 0.7 to 1.4 times what they say; disturbances as slow as the motion leave that of the offset 2.3 times too small.
    """
    hessian, scatter = np.zeros((len(UNITS), len(UNITS))), np.zeros((len(UNITS), len(UNITS)))
    for weight, record in zip(weights, records, strict=True):
        design = weight * record.design
        hessian += design.T @ design
        scatter += _long_run(design * (weight * record.error(range(len(UNITS)), solution))[:, None])
    scale = np.sqrt(np.diag(hessian))  # units differ: invert the hessian of columns of one size
    inverse = np.linalg.inv(hessian / np.outer(scale, scale)) / np.outer(scale, scale)
    return np.asarray(np.sqrt(np.diag(inverse @ scatter @ inverse)))


def _long_run(scores: Array) -> Array:
    """n times the long-run covariance of the scores: Parzen's kernel, bandwidth from first-order fits (Andrews 1991).

    Their correlation counts as 0.97 at most (Andrews and Monahan 1992).
    """
    power = np.sum(scores**2, axis=0)
    correlation = np.sum(scores[1:] * scores[:-1], axis=0) / np.where(power > 0, power, 1.0)
    rho = float(np.clip(correlation, 0.0, 0.97).max())
    bandwidth = 2.6614 * (4 * rho**2 / (1 - rho) ** 4 * len(scores)) ** 0.2
    total = scores.T @ scores
    for lag in range(1, min(len(scores) - 1, int(bandwidth) + 1)):
        u = lag / (bandwidth + 1)
        kernel = 1 - 6 * u**2 + 6 * u**3 if u <= 0.5 else 2 * (1 - u) ** 3
        product = scores[lag:].T @ scores[:-lag]
        total = total + max(kernel, 0.0) * (product + product.T)
    return np.asarray(total)
