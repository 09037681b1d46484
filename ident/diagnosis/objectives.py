"""The objectives of the models of one set of effects, windows and bounds, and their errors on trial."""

from __future__ import annotations

from dataclasses import dataclass, field

from ident.fit.simulated_fitness import SimulatedFitness
from ident.parallel import Once


@dataclass(frozen=True)
class Objectives:
    """The objective of each model by its effects and the samples of its records, and errors on trial by the point."""

    objectives: dict[tuple[tuple[str, ...], int], SimulatedFitness] = field(default_factory=dict)
    trial_errors: Once[tuple[tuple[str, ...], int, bytes], float] = field(default_factory=Once)
