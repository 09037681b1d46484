"""The models in question: what experiment design is asked with, whoever asks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ident.matrix import Matrix
from ident.preprocessing import screen
from ident.presets import Preset

Model = tuple[Preset, dict[str, float]]
NOISE = 0.005
"""The relative noise floor that stands where nothing tells it."""


@dataclass(frozen=True)
class Rivals:
    """Models that are to be told apart, or one to be known better: presets, and values by their equations' names, SI.

    `noise` is the noise floor relative to the output; `doubted` are the ids of runs whose labels are not believed.
    `preprocessing` has false for each step that was switched off where they were fitted.
    """

    models: tuple[Model, ...]
    noise: float = NOISE
    doubted: frozenset[str] = frozenset()
    preprocessing: Mapping[str, bool] = field(default_factory=dict)

    def trusted(self, matrix: Matrix) -> Matrix:
        """The matrix without the runs that are doubted, as far as runs to fit are left."""
        matrix = screen(matrix, self.preprocessing)
        rest = replace(matrix, runs=tuple(run for run in matrix.runs if run.id not in self.doubted))
        return rest if rest.of_use("fit") else matrix
