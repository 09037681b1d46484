"""Channels that were recorded beside a machine, of which a term may be: the pressure behind a seal, a temperature.

A term of what the machine itself answers would explain the record by the record. So of a machine with a command only
what surrounds it counts; a machine that is moved answers with its force alone.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ident.chain.channels import READABLE, unmeasured
from ident.diagnosis.candidate_models import CandidateModels
from ident.diagnosis.criteria import CRITERIA
from ident.run import MOTIONS, Run

_SURROUNDS = ("supply_pressure", "vertical_load", "temperature")
_FORCES = ("force", "drive_force")


def auxiliary_channels(models: CandidateModels) -> tuple[str, ...]:
    """The channels that every run has, beside what drives the model and what it shows, and that are not the same."""
    moved, runs = models.preset.data.driven_by in MOTIONS, models.matrix.runs
    free = [name for name in READABLE if name not in _FORCES] if moved else _SURROUNDS
    return tuple(name for name in free if unmeasured({name}, runs) is None and _varies(name, models.runs))


def channels_of(run: Run) -> Mapping[str, NDArray[np.float64]]:
    """What of a run may be read so, in SI."""
    return {name: run.channels[name] for name in READABLE if name in run.channels}


def units_of(run: Run) -> Mapping[str, str]:
    """The units of these channels."""
    return {name: run.units.get(name, "1") for name in channels_of(run)}


def _varies(name: str, runs: tuple[Run, ...]) -> bool:
    every = np.concatenate([run.channels[name] for run in runs])
    return bool(np.std(every) > CRITERIA.discovery.rests * np.abs(every).max(initial=0.0))
