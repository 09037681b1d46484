"""A model that stays in question: what the runs say of its parameters, and how it would answer further runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.comparison.compare import modelled
from ident.fit.normal_matrices import NormalMatrices
from ident.fit.settings import Settings
from ident.fit.simulated_fitness import SimulatedFitness
from ident.fit.space import search_space
from ident.fit.trial_runs import shortened
from ident.matrix import Matrix
from ident.noise.floor import by_spectrum, like_transducer
from ident.presets import Preset
from ident.run import Run

Array = NDArray[np.float64]
Deviation = Callable[[float], float]
"""From the standard deviation of an output to that of its noise."""
_SAMPLES = 65_536  # of the runs there are, from which their information is taken
PRIOR = 12.0  # of an axis of the unit cube before anything was measured: 1 over the variance between its bounds


def deviation_of_noise(runs: Sequence[Run], band: float, noise: float) -> Deviation:
    """How noisy a further run would be: like the transducer, or like its output, whichever varies less over the runs.

    `noise` is the mean relative floor, which stands where the records do not show theirs.
    """
    sizes = np.array([np.std(run.measured) for run in runs], float)
    if like_transducer(sizes, by_spectrum(runs, band)):
        steady = float(np.exp(np.mean(np.log(noise * sizes))))
        return lambda _size: steady
    return lambda size: noise * size


@dataclass(frozen=True)
class Rival:
    """A model at its fitted `values` (by the equations' names, SI), for a matrix as it drives the model."""

    preset: Preset
    values: Mapping[str, float]
    matrix: Matrix
    band: float
    deviation: Deviation

    @cached_property
    def _fitness(self) -> SimulatedFitness:
        shapes = {p.in_equations: self.values[p.in_equations] for e in self.preset.effects for p in e.added[1:]}
        space = search_space(self.preset, self.matrix, Settings(self.preset.name, fixed=shapes), self.band)
        runs = shortened(self.matrix.of_use("fit"), _SAMPLES)
        return SimulatedFitness(self.preset, self.matrix, runs, self.band, space)

    @cached_property
    def point(self) -> Array:
        """The values in the unit cube of their search, (p,)."""
        space = self._fitness.space
        return space.point({**self.values, **space.fixed})

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters, one an axis."""
        return tuple(self.preset.parameter(name).name for name in self._fitness.space.names)

    @cached_property
    def information(self) -> Array:
        """What the runs there are say of the parameters, (p, p), in units of the noise; with the bounds as a prior."""
        here, runs = self._fitness.exact(self.point), self._fitness.runs
        longer = sum(run.length for run in self.matrix.of_use("fit")) / sum(run.length for run in runs)
        p = len(self.point)
        terms = [
            m.gram[:p, :p] / self.deviation(float(np.std(r.measured))) ** 2
            for m, r in zip(here.runs, runs, strict=True)
        ]
        return np.asarray(longer * np.sum([t for t in terms if np.all(np.isfinite(t))], axis=0) + PRIOR * np.eye(p))

    @cached_property
    def runs(self) -> tuple[Run, ...]:
        """The runs there are, as far as they are used here."""
        return self._fitness.runs

    def outputs(self, runs: Sequence[Run]) -> dict[str, Array]:
        """What it would record in these runs, by their ids."""
        with np.errstate(all="ignore"):
            return modelled(self.preset, self.values, Matrix(self.matrix.actuator, tuple(runs)))

    def normal_matrices(self, runs: Sequence[Run]) -> tuple[NormalMatrices, ...]:
        """Sums of products of its sensitivities and residuals on these runs."""
        with np.errstate(all="ignore"):
            return self._fitness.fresh(tuple(runs)).exact(self.point).runs
