"""The error by run, frequency band, amplitude, gain, specimen, direction of motion and speed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.comparison.compare import Comparison, RunComparison
from ident.fit.reduction import excited_band
from ident.run import Run
from ident.words import conditions

Array = NDArray[np.float64]
_BANDS = 14
_FIFTHS = ("slowest fifth", "second fifth", "middle fifth", "fourth fifth", "fastest fifth")


@dataclass(frozen=True)
class Group:
    """Runs, or parts of every run, with something in common: `error` is eq. (17) on these samples, averaged over runs.

    `mean` is the mean residual of these samples over the run's standard deviation; `value` the condition in SI.
    """

    by: str
    label: str
    value: float | None
    runs: int
    error: float
    mean: float


@dataclass(frozen=True)
class BandErrors:
    """The error of a run in each band; their squares add up to that of eq. (17). None: no frequency lies there."""

    id: str
    use: str
    error: float
    bands: tuple[float | None, ...]


@dataclass(frozen=True)
class Breakdown:
    """All of it; `edges` of the bands are in Hz, or in cycles a sample where the clock is unknown."""

    edges: tuple[float, ...]
    runs: tuple[BandErrors, ...]
    groups: tuple[Group, ...]


def breakdown(comparison: Comparison) -> Breakdown:
    """Where the model fails, run by run and group by group; runs at which the model is unstable are left out."""
    runs = [run for run in comparison.runs if not run.unstable]
    edges = band_edges([run.run for run in runs]) if runs else ()
    by_band = tuple(BandErrors(r.run.id, r.run.use, r.error, in_bands(r, edges)) for r in runs)
    return Breakdown(edges, by_band, tuple(_groups(runs)))


def band_edges(runs: Sequence[Run]) -> tuple[float, ...]:
    """Edges of bands: even on a logarithmic axis where the commands have power, one above, up to half the rate."""
    top = excited_band(runs) / (2 * np.pi)
    resolved = 1.5 / min(run.duration for run in runs)
    nyquist = max(run.sample_rate for run in runs) / 2
    edges = [0.0]
    for edge in np.geomspace(min(top / 100, nyquist / 2), min(top, 0.99 * nyquist), _BANDS):
        if edge - edges[-1] >= resolved:
            edges.append(float(edge))
    return (*edges, float(nyquist)) if len(edges) > 1 else (0.0, float(nyquist) / 2, float(nyquist))


def in_bands(compared: RunComparison, edges: Sequence[float]) -> tuple[float | None, ...]:
    """The error of a run in each band."""
    residual = _residual(compared)
    n = len(residual)
    power = 2 * np.abs(np.fft.rfft(residual)) ** 2 / n**2
    frequency = np.fft.rfftfreq(n, 1 / compared.run.sample_rate)
    place = np.searchsorted(edges, frequency, side="left")
    total = float(np.var(compared.run.measured))
    sums = np.bincount(place, power, len(edges) + 1)[1 : len(edges)]
    there = np.bincount(place, minlength=len(edges) + 1)[1 : len(edges)]
    return tuple(float(np.sqrt(s / total)) if count else None for s, count in zip(sums, there, strict=True))


def noise_in_bands(run: Run, floor: float, edges: Sequence[float]) -> tuple[float | None, ...]:
    """White noise of a floor, as a fraction like eq. (17), in each band; their squares add up to its square."""
    n = run.length
    frequency = np.fft.rfftfreq(n, 1 / run.sample_rate)[1:]
    there = np.bincount(np.searchsorted(edges, frequency, side="left"), minlength=len(edges) + 1)[1 : len(edges)]
    return tuple(float(floor * np.sqrt(count / len(frequency))) if count else None for count in there)


def _residual(compared: RunComparison) -> Array:
    residual = compared.run.measured - compared.modelled
    return np.asarray(residual - residual.mean())


def _groups(runs: Sequence[RunComparison]) -> Iterator[Group]:
    yield from _by(runs, "amplitude", stated_amplitude, _amplitude)
    yield from _by(runs, "gain", lambda run: run.gain, lambda run: f"Kp {run.gain:g}")
    yield from _by(runs, "mass", lambda run: run.specimen.mass if run.specimen else None, _mass)
    yield from _by(runs, "stiffness", lambda run: run.specimen.stiffness if run.specimen else None, _stiffness)
    yield from _by(runs, "specimen", _ratio, lambda run: f"{_mass(run)}, {_stiffness(run)}")
    if runs:
        yield from _by_motion(runs)


def stated_amplitude(run: Run) -> float:
    """The RMS amplitude as it is stated, else the command's to two digits, which groups runs of one amplitude."""
    return run.amplitude if run.amplitude is not None else float(f"{np.std(run.command):.1e}")


def _amplitude(run: Run) -> str:
    return conditions.amplitude(stated_amplitude(run), run.units.get("command", "m"))


def _mass(run: Run) -> str:
    return conditions.mass(run.specimen.mass) if run.specimen else ""


def _stiffness(run: Run) -> str:
    return conditions.stiffness(run.specimen.stiffness) if run.specimen else ""


def _ratio(run: Run) -> float | None:
    """Specimens in the order of their own frequency squared, then of their mass."""
    if run.specimen is None:
        return None
    return run.specimen.stiffness / max(run.specimen.mass, 1e-3)


def _by(
    runs: Sequence[RunComparison], name: str, value: Callable[[Run], float | None], label: Callable[[Run], str]
) -> Iterator[Group]:
    """A group for each value, in numeric order; nothing where no run states it."""
    found: dict[tuple[float, str], list[RunComparison]] = {}
    for run in runs:
        stated = value(run.run)
        if stated is not None:
            found.setdefault((float(stated), label(run.run)), []).append(run)
    for (stated, text), members in sorted(found.items()):
        error, mean = (float(np.mean([getattr(m, what) for m in members])) for what in ("error", "offset"))
        yield Group(name, text, stated if name != "specimen" else None, len(members), error, mean)


def _by_motion(runs: Sequence[RunComparison]) -> Iterator[Group]:
    """By the model's speed, which is free of noise."""
    directions: dict[str, list[tuple[float, float]]] = {"positive": [], "negative": []}
    fifths: dict[str, list[tuple[float, float]]] = {name: [] for name in _FIFTHS}
    for run in runs:
        residual = _residual(run) / np.std(run.run.measured)
        speed = np.gradient(run.modelled)
        for name, inside in (("positive", speed > 0), ("negative", speed < 0)):
            _add(directions[name], residual[inside])
        order = np.argsort(np.abs(speed), kind="stable")
        for name, part in zip(_FIFTHS, np.array_split(order, len(_FIFTHS)), strict=True):
            _add(fifths[name], residual[part])
    for by, found in (("direction", directions), ("speed", fifths)):
        for name, entries in found.items():
            if entries:
                error, mean = np.mean(entries, axis=0)
                yield Group(by, name, None, len(entries), float(error), float(mean))


def _add(entries: list[tuple[float, float]], residual: Array) -> None:
    if len(residual):
        entries.append((float(np.sqrt(np.mean(residual**2))), float(residual.mean())))
