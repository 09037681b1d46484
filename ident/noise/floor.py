"""The noise floor: how small eq. (17) can become on a run.

Where a command was measured twice, in two runs or within one, noise is what does not repeat. Without repeats it is
read off the record where the command has no power.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.matrix import Matrix
from ident.noise.criteria import NOISE_CRITERIA
from ident.noise.effective_sample_size import independent_samples
from ident.noise.own_periods import own_repeats
from ident.noise.periodic import fundamental, periodic_noise
from ident.noise.power_density import power_density
from ident.noise.repeats import Repeat, repeated
from ident.parallel import each
from ident.run import USES, Run, over_runs

Array = NDArray[np.float64]
_OF = NOISE_CRITERIA.spectral_floor
_UPPER_HALF = 0.5  # of the spectrum shows the noise


def noise_floor(run: Run, band: float) -> float | None:
    """Standard deviation of white measurement noise over that of the measured output; None where it cannot be told.

    The power density of the record above `band` (rad/s, where the command ends) is taken for the noise's at all
    frequencies: exact for white noise, a lower bound for noise that lives in the band. Of a record that a periodic
    command made it is what differs between samples of one phase.
    """
    nyquist, clear = run.sample_rate / 2, _OF.clear * band / (2 * np.pi)
    if clear > (1 - _OF.free) * nyquist or run.length < _OF.shortest:
        return None
    periodic = None if "command" not in run.channels else periodic_noise(run.command, run.measured, run.sample_rate)
    if periodic is not None:
        return periodic / float(np.std(run.measured))
    segment = min(run.length, _OF.window)
    frequency, power = power_density(run.measured, run.sample_rate, segment)
    # Kinks of friction and dead zones reach far beyond the command's band; half-way up they are gone.
    density = float(np.mean(power[(frequency > max(clear, _UPPER_HALF * nyquist)) & (frequency < _OF.end * nyquist)]))
    return float(np.sqrt(density * nyquist) / np.std(run.measured))


def _is_periodic(run: Run) -> bool:
    return "command" in run.channels and fundamental(run.command, run.sample_rate) is not None


def by_spectrum(runs: Sequence[Run], band: float) -> list[float | None]:
    """The noise floor that the spectrum of each run tells."""
    return each(lambda run: noise_floor(run, band), runs)


@dataclass(frozen=True)
class Floors:
    """The noise floor of each run by its id, as a fraction like eq. (17), and how well it is known.

    `degrees_of_freedom` is the number of independent samples that tell it, `independent_share` the share of a run's
    samples that are independent where there is nothing but noise; `measured` is true where repeats tell it, not the
    spectra. `in_band` is true where it is told of the frequencies of the command, too: by repeats, or by the periods
    of periodic commands.
    """

    by_run: Mapping[str, float | None]
    degrees_of_freedom: float
    independent_share: float = 1.0
    measured: bool = False
    in_band: bool = False

    def times(self, factors: Mapping[str, float]) -> Floors:
        """The floors of signals in which the noise of each run is so many times as large."""
        return replace(self, by_run={run: f if f is None else f * factors[run] for run, f in self.by_run.items()})

    def of_use(self, matrix: Matrix) -> Mapping[str, float | None]:
        """Averaged over the runs of each use; None where it cannot be told of every run."""
        return {use: self.mean(matrix.of_use(use)) for use in USES}

    def mean(self, runs: Sequence[Run]) -> float | None:
        """Averaged over runs; None where it cannot be told of every one."""
        known = [floor for run in runs if (floor := self.by_run[run.id]) is not None]
        told = bool(known) and len(known) == len(runs)
        return float(over_runs(known, runs)) if told else None

    def spread(self, samples: int) -> float:
        """The relative standard deviation of noise over so many samples about its floor."""
        return float(np.sqrt(0.5 / (self.independent_share * samples) + 0.5 / self.degrees_of_freedom))


Counted = Callable[[Run, Array], Array]
"""A signal of a run as it is judged: over windows it is counted from where each begins."""


def noise_floors(
    runs: Sequence[Run], band: float, left_out: Collection[str] = (), counted: Counted = lambda _, signal: signal
) -> Floors:
    """The noise floors of runs whose command ends at `band` (rad/s); `left_out` are ids that are not trusted.

    What differs between repeats is `counted` as the residual of a model is: a disturbance that is there where a window
    begins is known to the model.

    From repeats: half the power of their difference, the median over the pairs, for all runs; in the unit of the
    displacement or in proportion to it, as the pairs say, or where these are few, the spectra. Each output is told by
    itself: two of one record are no repeats, and their noise has nothing in common.
    """
    trusted = [run for run in runs if run.id not in left_out]
    pairs = repeated(trusted) + [pair for of_run in each(own_repeats, trusted) for pair in of_run]
    by_output: dict[str, list[Run]] = {}
    for run in runs:
        by_output.setdefault(run.output, []).append(run)
    parts = [
        _of_one_output(of, [p for p in pairs if p.first.output == name], band, counted)
        for name, of in by_output.items()
    ]
    if len(parts) == 1:
        return parts[0]
    return Floors(
        {run: floor for part in parts for run, floor in part.by_run.items()},
        min(part.degrees_of_freedom for part in parts),
        min(part.independent_share for part in parts),
        measured=all(part.measured for part in parts),
        in_band=all(part.in_band for part in parts),
    )


def _of_one_output(runs: Sequence[Run], pairs: Sequence[Repeat], band: float, counted: Counted) -> Floors:
    if not pairs:
        fitted = [(run.length, _is_periodic(run)) for run in runs if run.use == "fit"]
        degrees_of_freedom = sum(
            length * (NOISE_CRITERIA.periodic_noise.efficiency if periodic else _UPPER_HALF)
            for length, periodic in fitted
        )
        in_band = bool(fitted) and all(periodic for _, periodic in fitted)
        seen = zip(runs, by_spectrum(runs, band), strict=True)
        return Floors({run.id: floor for run, floor in seen}, max(degrees_of_freedom, 1.0), in_band=in_band)
    differences = [counted(pair.first, pair.difference()) for pair in pairs]
    degrees_of_freedom = sum(independent_samples(difference) for difference in differences)
    powers = np.array([0.5 * np.var(difference) for difference in differences])
    shares = powers / [0.5 * (np.var(a.measured) + np.var(b.measured)) for a, b, _ in pairs]
    sizes = np.array([np.std(run.measured) for run in runs], float)
    steady = like_transducer(np.sqrt(powers / shares), list(np.sqrt(shares)))
    if steady is None:
        steady = like_transducer(sizes, by_spectrum(runs, band))
    floors = np.full(len(runs), np.sqrt(np.median(shares))) if steady is False else np.sqrt(np.median(powers)) / sizes
    by_run = {run.id: float(floor) for run, floor in zip(runs, floors, strict=True)}
    share = degrees_of_freedom / sum(map(len, differences))
    return Floors(by_run, degrees_of_freedom, share, measured=True, in_band=True)


def like_transducer(sizes: Array, floors: Sequence[float | None]) -> bool | None:
    """Whether the noise is as large on every record, or in proportion to its size: whichever varies less.

    `sizes` are standard deviations, `floors` those of the noise over them. None where that cannot be told.
    """
    known = np.array([np.nan if floor is None else floor for floor in floors])
    if len(sizes) < _OF.fewest or not np.all(known > 0) or np.std(np.log(sizes)) < _OF.spread:
        return None
    return bool(np.std(np.log(known * sizes)) < np.std(np.log(known)))
