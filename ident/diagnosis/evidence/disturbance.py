"""One disturbance spectrum, common to all models that are compared, and the loss that is weighted by it.

A disturbance that no model explains, a drift of the sensor or an unlisted term, must not decide between models. Its
energy in each band is the least residual energy of all models in that band, and at least the noise. A part of the mean
level of the explainable energy is added: else the kinks of a useful model, in empty bands, would outweigh the energy
that it explains.

    S_b = max(min_m E_b(m), F_b) + ε X c_b / Σ c      X = Σ_b max(E_b(reference) − F_b, 0), of each condition
    V(m) = Σ_b c_b max(E_b(m), F_b) / S_b / Σ c      1/ν = 1/Σ c + 1/ν_max

with E_b the energies, c_b the distinct degrees of freedom (:mod:`ident.diagnosis.evidence.energy_bands`), F_b = f d_b
the energy of the noise. It is the likelihood of Whittle (1953) with a fitted discrepancy. The logarithm is taken of the
sum over all bands, because the level of the disturbance is not known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.evidence.energy_bands import EnergyBands

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Disturbance:
    """The spectrum: the expected energies (bands,) of the disturbance and of the noise alone, over the `bands`.

    `floors` are the variances of the noise of each run over the power of its output, (runs,).
    """

    bands: EnergyBands
    energy: Array
    noise: Array
    floors: Array

    @classmethod
    def of_energies(cls, bands: EnergyBands, energies: Array, floors: Array, reference: int = 0) -> Disturbance:
        """The disturbance spectrum of models by their energies (models, bands)."""
        noise = bands.white(floors)
        explainable = np.maximum(energies[reference] - noise, 0.0)
        conditions = int(bands.condition.max()) + 1
        of_condition = np.bincount(bands.condition, explainable, conditions)
        distinct = np.bincount(bands.condition, bands.distinct, conditions)
        share = bands.criteria.tolerance * of_condition / np.maximum(distinct, 1.0)
        expected = np.maximum(energies.min(axis=0), noise) + share[bands.condition] * bands.distinct
        return cls(bands, expected, noise, floors)

    @property
    def counted(self) -> Array:
        """c_b of the bands that have energy, 0 of the others, (bands,)."""
        return np.where(self.energy > 0, self.bands.distinct, 0.0)

    @property
    def distinct(self) -> float:
        """ν: the number of distinct degrees of freedom of the data."""
        return self._all / (1.0 + self._all / self.bands.criteria.degrees_in_all)

    @property
    def _all(self) -> float:
        """Σ c_b."""
        return float(self.counted.sum())

    @property
    def weights(self) -> Array:
        """c_b / S_b, the weight of the energy of each band in the loss, 0 of a band without energy, (bands,)."""
        return self.counted / np.where(self.energy > 0, self.energy, 1.0)

    def loss(self, energies: Array) -> float:
        """V of a model by its energies (bands,): 1 or less where its residual is the disturbance."""
        shares = np.maximum(energies, self.noise) / np.where(self.energy > 0, self.energy, 1.0)
        return float(self.counted @ shares) / self._all

    def weighted(self, scaled: Sequence[Array]) -> list[Array]:
        """The residuals (n,) of the runs, each over the standard deviation of its output, weighted as in the loss."""
        return [run.weighted(r, self.weights) for run, r in zip(self.bands.runs, scaled, strict=True)]

    @property
    def weighted_floors(self) -> Array:
        """The variance of the noise of each run, weighted as in the loss, (runs,)."""
        of_runs = [run.degrees(self.bands.size) @ self.weights / run.n for run in self.bands.runs]
        return self.floors * np.array(of_runs)

    def gain(self, before: Array, after: Array) -> float:
        """G = ν/2 ln(V before / V after) of the energies (bands,) of two models, in nats; 0 where no band has
        energy."""
        losses = (self.loss(before), self.loss(after)) if self.distinct > 0 else (1.0, 1.0)
        return 0.5 * self.distinct * float(np.log(losses[0] / losses[1])) if min(losses) > 0 else 0.0

    def without(self, run: int) -> Disturbance:
        """The disturbance spectrum of the other runs alone."""
        own = self.bands.runs[run].degrees(self.bands.size)
        remaining = 1.0 - own / np.maximum(self.bands.degrees, 1.0)
        return replace(self, energy=np.where(remaining > 0, remaining * self.energy, 0.0), noise=remaining * self.noise)

    def most(self, before: Array) -> float:
        """The gain of a model whose residual is the noise, as far as the noise is known for sure."""
        surely = self.bands.criteria.floor_margin**2 * self.noise
        return self.gain(np.maximum(before, surely), surely)
