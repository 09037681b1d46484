"""Inverse-dynamics regression: mass and friction of a drive from its measured force and motion, without simulation.

    F = m x″ + c x′ + Fc sgn x′ + F0

is linear in mass m, viscous friction c, Coulomb friction Fc and offset F0 (Gautier, Janot, Brunot 2019 for the
electro-mechanical positioning system). Position and force pass the same zero-phase low-pass, so that what it takes from
one it takes from the other; speed and acceleration are central differences of the filtered position.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy.signal
from numpy.typing import NDArray

from ident.errors import Unusable
from ident.matrix import Matrix, Run

Array = NDArray[np.float64]
CUTOFF = 20.0  # Hz
UNITS = {"mass": "kg", "viscous": "N*s/m", "coulomb": "N", "offset": "N"}
_STILL = 0.02  # of the largest speed: slower than this the sign of the speed, and with it dry friction, is not known
_BLOCKS = 32


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


def regress(matrix: Matrix, cutoff: float = CUTOFF) -> InverseDynamics:
    """Fit the runs to fit; `cutoff` in Hz. Raises Unusable where no such run has drive_force and displacement."""
    runs = [run for run in matrix.runs if {"drive_force", "displacement"} <= run.channels.keys()]
    fitted = [run for run in runs if run.use == "fit"]
    if not fitted:
        raise Unusable("missing-channel", "no run to fit has drive_force and displacement", "runs",
                       "name the column of the drive's force")  # fmt: skip
    if not 0 < cutoff < min(run.sample_rate for run in runs) / 4:
        raise Unusable("bad-value", f"cut-off {cutoff:g} Hz", "inverse dynamics", "give a quarter of the rate at most")
    prepared = {run.id: _prepared(run, cutoff) for run in runs}
    solutions = []
    for columns in ([0, 1, 2, 3], [0, 1, 3]):
        design = np.concatenate([prepared[run.id][0][:, columns] for run in fitted])
        force = np.concatenate([prepared[run.id][1] for run in fitted])
        solution, *_ = np.linalg.lstsq(design, force, rcond=None)
        residual = {run.id: _relative(prepared[run.id], columns, solution) for run in runs}
        solutions.append((solution, residual, design, force))
    solution, with_friction, design, force = solutions[0]
    deviation = _deviations(design, force - design @ solution)
    found = zip(UNITS.items(), solution, deviation, strict=True)
    coefficients = {name: Coefficient(float(value), float(error), unit) for (name, unit), value, error in found}
    return InverseDynamics(coefficients, with_friction, solutions[1][1])


def _prepared(run: Run, cutoff: float) -> tuple[Array, Array]:
    """[x″, x′, sgn x′, 1] and the force, filtered, without the ends that the filter spoils and without standstill."""
    low_pass = scipy.signal.butter(4, cutoff, fs=run.sample_rate, output="sos")
    x, force = (scipy.signal.sosfiltfilt(low_pass, run.channels[name]) for name in ("displacement", "drive_force"))
    speed = np.gradient(x, 1 / run.sample_rate)
    acceleration = np.gradient(speed, 1 / run.sample_rate)
    # The sign is filtered like the force, or its jumps would stay sharp where the force's are not.
    moving = np.abs(speed) > _STILL * np.abs(speed).max()
    sign = scipy.signal.sosfiltfilt(low_pass, np.sign(speed))
    ends = int(run.sample_rate / cutoff)
    inside = np.zeros(len(x), dtype=bool)
    inside[ends : len(x) - ends] = True
    every = max(1, int(run.sample_rate / (4 * cutoff)))
    kept = np.flatnonzero(inside & moving)[::every]
    design = np.column_stack([acceleration, speed, sign, np.ones(len(x))])
    return design[kept], force[kept]


def _relative(prepared: tuple[Array, Array], columns: list[int], solution: Array) -> float:
    design, force = prepared
    return float(np.std(force - design[:, columns] @ solution) / np.std(force))


def _deviations(design: Array, residual: Array) -> Array:
    """Standard errors from the scatter of the score over blocks of the record, as the fits' are."""
    inverse = np.linalg.inv(design.T @ design)
    scores = np.array([block.sum(axis=0) for block in np.array_split(design * residual[:, None], _BLOCKS)])
    return np.sqrt(np.diag(inverse @ (scores.T @ scores) @ inverse))
