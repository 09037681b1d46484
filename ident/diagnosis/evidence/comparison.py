"""The one comparison of two fitted models, and what it lets one say.

Compared are the residuals of free simulations (over the prediction horizon where a machine integrates) on data that the
fits did not see: blocks or whole runs that were left out in turn. Three questions are asked of a difference.

*Is it real?* The gain, in nats, is that of a coarsened likelihood (Miller and Dunson 2019) under one disturbance
spectrum common to all models (:mod:`ident.diagnosis.evidence.disturbance`),

    G = ν/2 ln(V before / V after)

where ν counts what is distinct, never samples: five and a hundred periods of one sine have the same ν. It has to pass
the bar, the 95 % point of the largest gain that any candidate makes of residuals with the same spectrum and random
phases (:mod:`ident.diagnosis.evidence.chance`): that is the correction for the number of models looked at. Of four runs
or more it has to pass without the run that gains most, too: what one run alone asks for is a doubt about that run.

*Does it matter?* The share of the explainable power, that above the noise, which the change takes,

    ρ = (P before − P after) / (P before − P noise)

with P the power of the error over that of the output, averaged over runs: what a user is shown, squared. Its error
comes from blocks of ten correlation times of the difference, or from whole runs
(:mod:`ident.diagnosis.evidence.blocks`).

*Does it hold everywhere?* No condition of the tests, and neither half of the records, may lose beyond its error.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ident.diagnosis.criteria import TINY
from ident.diagnosis.evidence.blocks import BlockMean, block_mean, block_ratio
from ident.diagnosis.evidence.criteria import EVIDENCE_CRITERIA, EvidenceCriteria
from ident.diagnosis.evidence.disturbance import Disturbance
from ident.diagnosis.evidence.energy_bands import EnergyBands, Record
from ident.noise.effective_sample_size import independent_samples

Array = NDArray[np.float64]
Model = TypeVar("Model", bound=Hashable)
HALVES = ("first half", "second half")


@dataclass(frozen=True)
class Evidence:
    """What speaks for the model `after` against the model `before`, on data that neither was fitted to.

    `gain` is G (nats), `without` the same without the run that gains most, `most` the gain of a model that left nothing
    but the noise, `distinct` ν. `before`, `after` and `noise` are powers of the error over that of the output, averaged
    over runs; `difference` is before − after and `share` ρ, with their errors; `parts` are the differences on each
    condition and each half. `apart` is the power between the two outputs, `resolved` that which the noise would tell
    apart. `parameters` are the numbers of free parameters.
    """

    gain: float
    without: float
    most: float
    distinct: float
    before: float
    after: float
    noise: float
    difference: BlockMean
    share: BlockMean
    parts: Mapping[Hashable, BlockMean]
    apart: float
    resolved: float
    parameters: tuple[int, int] = (0, 0)

    @property
    def explainable(self) -> float:
        """The power that the first model leaves above the noise."""
        return max(self.before - self.noise, 0.0)


def compare(
    before: Sequence[Array], after: Sequence[Array], records: Sequence[Record], disturbance: Disturbance | None = None,
    parameters: tuple[int, int] = (0, 0), criteria: EvidenceCriteria = EVIDENCE_CRITERIA,
) -> Evidence:  # fmt: skip
    """Compare two models by their residuals (n,) of each run on data that was left out of their fits.

    The residuals are in the unit of the outputs, less their mean where the zero is not known. `disturbance` is the
    spectrum common to all models that are looked at, of which the two are members; without one these two are all.
    Raises ValueError where the residuals are not those of the records.
    """
    if not len(before) == len(after) == len(records):
        raise ValueError(f"residuals of {len(before)} and {len(after)} runs, {len(records)} records")
    if disturbance is None:
        bands = EnergyBands(tuple(records), tuple(map(len, before)), criteria)
        disturbance = Disturbance.of(bands, (before, after))
    by_run = [disturbance.bands.by_run(residuals) for residuals in (before, after)]
    energies = [of.sum(axis=0) for of in by_run]
    scaled = [[r / of.size for r, of in zip(side, records, strict=True)] for side in (before, after)]
    powers = [float(np.mean([np.mean(r**2) for r in side])) for side in scaled]
    gained = [first**2 - second**2 for first, second in zip(*scaled, strict=True)]
    between = [first - second for first, second in zip(*scaled, strict=True)]
    noise = min(float(np.mean(disturbance.floors)), *powers)
    excess = [residual**2 - floor for residual, floor in zip(scaled[0], disturbance.floors, strict=True)]
    return Evidence(
        gain=disturbance.gain(energies[0], energies[1]),
        without=_without(disturbance, by_run[0], by_run[1]),
        most=disturbance.most(energies[0]),
        distinct=disturbance.distinct,
        before=powers[0],
        after=powers[1],
        noise=noise,
        difference=block_mean(gained, criteria),
        share=block_ratio(gained, excess, criteria),
        parts=_parts(gained, records, criteria),
        apart=float(np.mean([np.mean(d**2) for d in between])),
        resolved=criteria.resolution
        * noise
        / max(sum(map(independent_samples, scaled[int(powers[1] < powers[0])])), 1),
        parameters=parameters,
    )


def improves(evidence: Evidence, bar: float, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model explains more than chance does, and a share that matters, beyond its error.

    The `bar` is that of :func:`ident.diagnosis.evidence.chance.bar`. Where a residual has few harmonics a random
    phase is often met by some candidate, and the bar comes near to all that can be gained: what
    gains half of that passes, too, if that is worth its prior, η G > κ of :mod:`ident.diagnosis.evidence.probability`.
    """
    worth_its_prior = criteria.effect_prior / criteria.learning_rate
    asked = min(bar, max(criteria.reaches * evidence.most, worth_its_prior))
    return min(evidence.gain, evidence.without) > asked and evidence.share.above(criteria.share, criteria)


def generalises(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether no condition and no half loses beyond its error, and by a share of the explainable power that matters."""
    least = -criteria.share * evidence.explainable
    return not any(part.below(least, criteria) for part in evidence.parts.values())


def indistinguishable(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the data leave open which model is right: as good but for chance, and outputs near to each other.

    Near is what the noise does not separate, or a twentieth of what the better one leaves above the noise.
    """
    excess = max(min(evidence.before, evidence.after) - evidence.noise, 0.0)
    near = evidence.apart <= max(criteria.separation * excess, evidence.resolved)
    difference = evidence.difference
    as_good = not (difference.above(0.0, criteria) or difference.below(0.0, criteria))
    return near and (as_good or evidence.apart <= evidence.resolved)


def dominated(evidence: Evidence, criteria: EvidenceCriteria = EVIDENCE_CRITERIA) -> bool:
    """Whether the second model is worse than the first beyond chance, by a share that matters of what it leaves."""
    excess = max(evidence.after - evidence.noise, 0.0)
    return evidence.difference.below(-criteria.share * excess, criteria)


def _without(disturbance: Disturbance, before: Array, after: Array) -> float:
    """The gain without the run that gains most, of the energies (runs, bands); of few runs that of all."""
    if len(before) < disturbance.bands.criteria.whole_runs:
        return disturbance.gain(before.sum(axis=0), after.sum(axis=0))
    weights = np.where(disturbance.energy > 0, disturbance.counted / np.maximum(disturbance.energy, TINY), 0.0)
    best = int(np.argmax((before - after) @ weights))
    others = np.arange(len(before)) != best
    return disturbance.without(best).gain(before[others].sum(axis=0), after[others].sum(axis=0))


def _parts(
    gained: Sequence[Array], records: Sequence[Record], criteria: EvidenceCriteria
) -> dict[Hashable, BlockMean]:  # fmt: skip
    """The difference on each condition, where there are several, and on each half of the records."""
    conditions: dict[Hashable, list[Array]] = {}
    for series, record in zip(gained, records, strict=True):
        conditions.setdefault(record.condition, []).append(series)
    found: dict[Hashable, BlockMean] = {}
    if len(conditions) > 1:
        found |= {condition: block_mean(series, criteria) for condition, series in conditions.items()}
    halves = ([run[: len(run) // 2] for run in gained], [run[len(run) // 2 :] for run in gained])
    return found | {name: block_mean(half, criteria) for name, half in zip(HALVES, halves, strict=True)}
