"""Auxiliary channels that a term may read: the pressure behind a seal, a temperature.

A term of a response of the machine itself would explain the record by the record. So for a machine with a command only
the channels of its surroundings count; the only response of a machine that is moved is its force.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ident.chain.channels import READABLE, unmeasured
from ident.presets import Preset
from ident.rounding import EPSILON
from ident.run import MOTIONS, Run

_SURROUNDS = ("supply_pressure", "vertical_load", "temperature")
_FORCES = ("force", "drive_force")


def auxiliary_channels(preset: Preset, every: Sequence[Run], fitted: Sequence[Run]) -> tuple[str, ...]:
    """The channels that every run of a matrix has, other than the input and the output of the model, and that vary in
    the fitted runs."""
    moved = preset.data.driven_by in MOTIONS
    free = [name for name in READABLE if name not in _FORCES] if moved else _SURROUNDS
    return tuple(name for name in free if unmeasured({name}, every) is None and _varies(name, fitted))


def channels_of(run: Run) -> Mapping[str, NDArray[np.float64]]:
    """The channels of a run that an equation may read, in SI."""
    return {name: run.channels[name] for name in READABLE if name in run.channels}


def units_of(run: Run) -> Mapping[str, str]:
    """The units of these channels."""
    return {name: run.units.get(name, "1") for name in channels_of(run)}


def _varies(name: str, runs: Sequence[Run]) -> bool:
    every = np.concatenate([run.channels[name] for run in runs])
    return bool(np.std(every) > EPSILON * np.abs(every).max(initial=0.0))
