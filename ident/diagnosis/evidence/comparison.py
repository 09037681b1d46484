"""The one comparison of two fitted models: the numbers from which every statement on them follows.

The comparison takes the residuals of free simulations (over the prediction horizon where a machine integrates) on data
that the fits did not see: blocks or whole runs that were held out in turn. The rule by which an effect is added stands
in :mod:`ident.diagnosis.evidence.rule`, which of two models is better in :mod:`ident.diagnosis.evidence.separation`.

The gain, in nats, is that of a coarsened likelihood (Miller and Dunson 2019) under one disturbance spectrum common to
all models (:mod:`ident.diagnosis.evidence.disturbance`),

    G = ν/2 ln(V before / V after)

where ν counts distinct degrees of freedom, never samples: five and a hundred periods of one sine have the same ν. The
means of the runs, to which a waveform is blind, add (runs − 1)/2 ln(Σ before / Σ after) of their squares.

The explainable power is the residual power above the noise. The change takes the share

    ρ = (P before − P after) / (P before − P noise)

with P the power of the error over the power of the output, averaged over runs: the square of the error that a user is
shown. The error of ρ comes from blocks of ten correlation times of the difference, or from whole runs
(:mod:`ident.diagnosis.evidence.blocks`).
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtri  # the quantile of χ², without scipy.stats, which takes half a second to load

from ident.cached import cached_property
from ident.diagnosis.evidence.blocks import block_mean, block_ratio
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.disturbance import Disturbance
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.diagnosis.evidence.evidence import SPANS, BlockMean, Evidence
from ident.noise.autoregression import prediction_errors
from ident.noise.effective_sample_size import independent_samples

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Residuals:
    """The residuals of a model on data that it was not fitted to: `series` (n,) of each run, in the unit of the
    outputs.

    Where the zero is not known the mean of each series is subtracted; `levels` (runs,) are then the means less their
    common mean, over the outputs' standard deviations. `bands` are the energy bands of all models that are compared.
    """

    series: tuple[Array, ...]
    bands: EnergyBands
    levels: Array = field(default_factory=lambda: np.zeros(1))

    @cached_property
    def energies(self) -> Array:
        """The energies of each run in each band, (runs, bands)."""
        return self.bands.by_run(self.series)

    @property
    def level_squares(self) -> Array:
        """The squares of the levels, (runs,)."""
        return np.broadcast_to(self.levels, len(self.series)) ** 2

    @cached_property
    def scaled(self) -> list[Array]:
        """The series over the standard deviations of the outputs."""
        return [r / of.size for r, of in zip(self.series, self.bands.records, strict=True)]

    @cached_property
    def power(self) -> float:
        """The power of the error over the power of the output, averaged over runs."""
        return float(np.mean([np.mean(r**2) for r in self.scaled]))

    @cached_property
    def independent(self) -> float:
        """The number of independent samples."""
        return max(sum(map(independent_samples, self.scaled)), 1.0)

    @cached_property
    def floors(self) -> Array:
        """The variance of the noise of each run over the power of its output, if this is the best of the models.

        The stated variance; the variance that does not repeat from period to period in a periodic test; else the
        variance of the innovations, which is less than the noise where the noise is coloured. Never above the residual
        power.
        """
        found, energies = [], self.energies.sum(axis=0)
        for run, record, residual in zip(self.bands.runs, self.bands.records, self.scaled, strict=True):
            if record.period is not None:
                others = run.first + run.bands - 1
                found.append(float(energies[others] / max(self.bands.degrees[others], 1.0)))
            elif record.floor is not None:
                found.append(record.floor)
            else:
                found.append(float(np.mean(prediction_errors(residual) ** 2)))
        return np.minimum(found, [np.mean(r**2) for r in self.scaled])


def common_disturbance(compared: Sequence[Residuals]) -> Disturbance:
    """The spectrum common to the compared models; the first is the reference, the model without any of the effects."""
    energies = np.array([residuals.energies.sum(axis=0) for residuals in compared])
    best = compared[int(np.argmin(energies.sum(axis=1)))]
    return Disturbance.of_energies(best.bands, energies, best.floors)


def compare(
    before: Residuals,
    after: Residuals,
    disturbance: Disturbance | None = None,
    criteria: EvidenceCriteria = EVIDENCE_CRITERIA,
) -> Evidence:
    """Compare two models by their residuals.

    `disturbance` is the spectrum common to all compared models, the two among them; without it the spectrum is common
    to these two. Raises ValueError where the residuals are not of the same runs.
    """
    if not len(before.series) == len(after.series) == len(before.bands.records):
        raise ValueError(f"residuals of {len(before.series)} and {len(after.series)} runs")
    disturbance = disturbance or common_disturbance((before, after))
    gained = [first**2 - second**2 for first, second in zip(before.scaled, after.scaled, strict=True)]
    between = [first - second for first, second in zip(before.scaled, after.scaled, strict=True)]
    noise = min(float(np.mean(disturbance.floors)), before.power, after.power)
    excess = [residual**2 - floor for residual, floor in zip(before.scaled, disturbance.floors, strict=True)]
    first, second = (disturbance.weighted(side.scaled) for side in (before, after))
    squares = [side.level_squares[:, None] for side in (before, after)]
    best = before if before.power <= after.power else after
    return Evidence(
        gain=gain(before, after, disturbance),
        without=_without(disturbance, before.energies, after.energies)
        + _level_gain(*_without_best(before.level_squares, after.level_squares, criteria), criteria),
        most=most(before, disturbance),
        distinct=disturbance.distinct,
        before=before.power,
        after=after.power,
        noise=noise,
        difference=block_mean(gained, criteria),
        share=block_ratio(gained, excess, criteria),
        weighted_share=block_ratio(
            [r**2 - s**2 for r, s in zip(first, second, strict=True)],
            [r**2 - floor for r, floor in zip(first, disturbance.weighted_floors, strict=True)],
            criteria,
        ),
        by_part=partial(_parts, gained, before.bands.records, criteria),
        apart=float(np.mean([np.mean(d**2) for d in between])),
        resolved=criteria.resolution * noise / best.independent,
        level=float(np.sqrt(squares[0].mean())),
        levels_apart=float(np.sqrt(np.mean((before.levels - after.levels) ** 2))),
        level_difference=block_mean(list(squares[0] - squares[1]), criteria),
        level_share=block_ratio(list(squares[0] - squares[1]), list(squares[0]), criteria),
    )


def gain(before: Residuals, after: Residuals, disturbance: Disturbance) -> float:
    """G in nats, of the waveforms and of the means of the runs."""
    waveform = disturbance.gain(before.energies.sum(axis=0), after.energies.sum(axis=0))
    return waveform + _level_gain(before.level_squares, after.level_squares, disturbance.bands.criteria)


def most(before: Residuals, disturbance: Disturbance) -> float:
    """The gain of a model whose residual is the noise, as far as the noise is known for sure."""
    bands, levels = disturbance.bands, before.level_squares
    noise = _level_noise(disturbance.floors / bands.lengths, bands.criteria)
    of_levels = _level_gain(levels, noise if noise.sum() < levels.sum() else levels, bands.criteria)
    return disturbance.most(before.energies.sum(axis=0)) + of_levels


def _level_noise(expected: Array, criteria: EvidenceCriteria) -> Array:
    """The squares of the means (runs,) that noise with the `expected` ones exceeds by chance: χ² of runs − 1."""
    others = len(expected) - 1
    return expected * float(chdtri(others, criteria.chance)) / others if others else expected


def _level_gain(before: Array, after: Array, criteria: EvidenceCriteria) -> float:
    """(runs − 1)/2 ln(Σ before / Σ after) of squares of the means, (runs,): the common mean takes one degree of
    freedom."""
    if len(before) < 2:
        return 0.0
    least = len(before) * criteria.level**2
    return 0.5 * (len(before) - 1) * float(np.log((before.sum() + least) / (after.sum() + least)))


def _without_best(before: Array, after: Array, criteria: EvidenceCriteria) -> tuple[Array, Array]:
    """Squares of the means, (runs,), without the run that gains most; all of them where there are few runs."""
    if len(before) < criteria.whole_runs:
        return before, after
    best = int(np.argmax(before - after))
    return np.delete(before, best), np.delete(after, best)


def _without(disturbance: Disturbance, before: Array, after: Array) -> float:
    """The gain without the run that gains most, by the energies (runs, bands); the gain of all runs where they are
    few."""
    if len(before) < disturbance.bands.criteria.whole_runs:
        return disturbance.gain(before.sum(axis=0), after.sum(axis=0))
    best = int(np.argmax((before - after) @ disturbance.weights))
    others = np.arange(len(before)) != best
    return disturbance.without(best).gain(before[others].sum(axis=0), after[others].sum(axis=0))


def _parts(gained: Sequence[Array], records: Sequence[Record], criteria: EvidenceCriteria) -> dict[Hashable, BlockMean]:
    """The difference on each condition, where there are several, and on each span of the records."""
    conditions: dict[Hashable, list[Array]] = {}
    for series, record in zip(gained, records, strict=True):
        conditions.setdefault(record.condition, []).append(series)
    found: dict[Hashable, BlockMean] = {}
    if len(conditions) > 1:
        found |= {condition: block_mean(series, criteria) for condition, series in conditions.items()}
    for name, (begin, end) in SPANS.items():
        found[name] = block_mean([run[int(begin * len(run)) : int(end * len(run))] for run in gained], criteria)
    return found
