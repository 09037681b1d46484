"""What a hybrid simulation asks of the rig, held against its limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.matrix import Actuator
from ident.rig.limits import RigLimits
from ident.rig.motion import edge_of_band, motion_peaks

Array = NDArray[np.float64]


def limits_of(fit: FitResult, case: Case) -> RigLimits:
    """The limits that the case states, and those of the fit's matrix where it states none."""
    return (case.rig or RigLimits()).over((fit.actuator or Actuator("")).rig_limits)


def asked_of_rig(fit: FitResult, case: Case, measured: Array, command: Array, force: Array) -> dict[str, float]:
    """The peaks of a simulation, SI, by the name of the limit: displacement (m), command (m) and load cell (N), (n,).

    The stroke holds for the command, too; the force is that on the specimen; the flow is the one that moves the piston.
    """
    peaks = motion_peaks(measured, case.sample_rate, edge_of_band(measured, case.sample_rate))
    peaks["stroke"] = float(max(np.abs(measured).max(), np.abs(command).max()))
    peaks["force"] = float(np.abs(force).max())
    area = case.piston_area or (fit.actuator.piston_area if fit.actuator is not None else None)
    if area is not None:
        peaks |= {"flow": area * peaks["speed"], "supply_pressure": peaks["force"] / area}
    return peaks


def leaving(fit: FitResult, case: Case, measured: Array, command: Array, force: Array) -> tuple[str, ...]:
    """What of a simulation leaves the limits of the rig, in sentences; nothing where no limit is stated."""
    limits = limits_of(fit, case)
    return limits.leaving(asked_of_rig(fit, case, measured, command, force)) if limits else ()
