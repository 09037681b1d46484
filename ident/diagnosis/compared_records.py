"""The records on which fitted models are compared: their conditions, periods and noise, the same for all models."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass

import numpy as np

from ident.cached import cached_property
from ident.diagnosis.criteria import CRITERIA
from ident.diagnosis.cross_validation import is_sweep
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.noise.floor import Floors
from ident.noise.periodic import fundamental
from ident.noise.repeats import labels
from ident.run import Run


@dataclass(frozen=True, eq=False)
class ComparedRecords:
    """Some runs, and a function that gives their noise floors when they are needed."""

    runs: tuple[Run, ...]
    floors: Callable[[], Floors]

    @cached_property
    def swept(self) -> bool:
        """Whether the command of a run is a sweep."""
        return any("command" in run.channels and is_sweep(run.command) for run in self.runs)

    @cached_property
    def bands(self) -> EnergyBands:
        """The bands in which the energy of their residuals lies."""
        floors = self.floors().by_run
        records = tuple(_record(run, floors.get(run.id)) for run in self.runs)
        return EnergyBands(records, tuple(run.length for run in self.runs))


def _record(run: Run, floor: float | None) -> Record:
    period = _period(run)
    return Record(float(np.std(run.measured)), _condition(run, period), period, None if floor is None else floor**2)


def _period(run: Run) -> float | None:
    """The period of a periodic command in samples; None for other commands."""
    frequency = fundamental(run.command, run.sample_rate) if "command" in run.channels else None
    return None if frequency is None else run.sample_rate / frequency


def _condition(run: Run, period: float | None) -> Hashable:
    """The condition of a test, equal in repetitions: its labels, its sample rate, size and period of the command."""
    sizes = (run.drive if "command" in run.channels else float(np.std(run.measured)), period)
    steps = tuple(
        round(CRITERIA.cross_validation.conditions_of_an_octave * float(np.log2(s))) if s else 0 for s in sizes
    )
    return (labels(run), run.sample_rate, steps)
