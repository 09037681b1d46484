"""One disturbance spectrum, common to all models that are compared, and the loss that it weighs.

What no model explains, a drift of the sensor or a term that no list holds, must not decide between models. Its energy in
each band is at most what the best of them leaves there, and at least the noise; a hundredth of what could be explained is
asked of no model, spread over all that is distinct:

    S_b = max(min_m E_b(m), F_b) + ε X c_b / Σ c      X = Σ_b max(E_b(reference) − F_b, 0), of each condition
    V(m) = Σ_b c_b max(E_b(m), F_b) / S_b / ν         ν = Σ_b c_b

with E_b the energies, c_b what is distinct (:mod:`ident.diagnosis.energy_bands`), F_b = f d_b the energy of the noise.
It is the likelihood of Whittle (1953) with a fitted discrepancy, of which the logarithm is taken over all bands at once,
as the level of the disturbance is not known. Of a periodic test the noise is told by what does not repeat.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.energy_bands import EnergyBands

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Disturbance:
    """The spectrum: expected energies (bands,) of it, and of the noise alone, over the `bands`."""

    bands: EnergyBands
    energy: Array
    noise: Array

    @classmethod
    def of(cls, bands: EnergyBands, compared: Sequence[Sequence[Array]], reference: int = 0) -> Disturbance:
        """That of models by their residuals, one of them, the `reference`, the model without any of the effects."""
        energies = np.array([bands.energies(residuals) for residuals in compared])
        least = energies.min(axis=0)
        noise = _noise(bands, least)
        explainable = np.maximum(energies[reference] - noise, 0.0)
        conditions = int(bands.condition.max()) + 1
        of_condition = np.bincount(bands.condition, explainable, conditions)
        distinct = np.bincount(bands.condition, bands.distinct, conditions)
        share = bands.criteria.tolerance * of_condition / np.maximum(distinct, 1.0)
        return cls(bands, np.maximum(least, noise) + share[bands.condition] * bands.distinct, noise)

    @property
    def counted(self) -> Array:
        """c_b of the bands in which there is anything, (bands,): a mean that is taken off says nothing."""
        return np.where(self.energy > 0, self.bands.distinct, 0.0)

    @property
    def distinct(self) -> float:
        """ν: how much of the data is distinct."""
        return float(self.counted.sum())

    def loss(self, residuals: Sequence[Array]) -> float:
        """V of a model: 1 or less where it leaves nothing but the disturbance."""
        return self.loss_of(self.bands.energies(residuals))

    def loss_of(self, energies: Array) -> float:
        """V of a model by its energies (bands,)."""
        shares = np.maximum(energies, self.noise) / np.where(self.energy > 0, self.energy, 1.0)
        return float(self.counted @ shares) / self.distinct

    def gain(self, before: Array, after: Array) -> float:
        """G = ν/2 ln(V before / V after) of the energies of two models, in nats."""
        return 0.5 * self.distinct * float(np.log(self.loss_of(before) / self.loss_of(after)))

    @property
    def reachable(self) -> Array:
        """The energies (bands,) of a model that leaves the noise alone, or where it is not known the disturbance."""
        return np.where(self.noise > 0, np.minimum(self.noise, self.energy), self.energy)


def _noise(bands: EnergyBands, least: Array) -> Array:
    """F_b: the stated floor, of a periodic test what does not repeat; nothing where neither is known."""
    found = np.zeros(bands.size)
    between: dict[int, tuple[float, float]] = {}
    for run, record in zip(bands.runs, bands.records, strict=True):
        if record.period is not None:
            rest = run.first + run.bands - 1
            between[run.first] = (float(least[rest]), float(bands.degrees[rest]))
            continue
        found += (record.floor or 0.0) * run.degrees(bands.size)
    for run in bands.runs:
        if run.first in between:
            energy, degrees = between[run.first]
            own = slice(run.first, run.first + run.bands)
            found[own] = energy / max(degrees, 1.0) * bands.degrees[own]
    return found
