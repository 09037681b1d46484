"""How much of the error is noise, how much a better linear model could take, how much only a nonlinear one.

The squares of the three add up to that of eq. (17). Linear: a free linear filter of the model's output that explains
the residual, one for each specimen and gain, the same for every amplitude, found on every other stretch of the records
and judged on the rest, so that what it takes off is no chance. Noise: half the power of the difference between repeats
of one command; without repeats the spectrum above the command's band, as white noise, which is a lower bound.
Nonlinear is the rest. What a filter of each amplitude's own takes off beyond the common one cannot be linear, and
cannot be noise: it is the lower bound of the nonlinear part.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from itertools import product
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from ident.comparison.compare import Comparison, RunComparison
from ident.errors import Unusable
from ident.fit.reduction import excited_band
from ident.noise.floor import noise_floors
from ident.parallel import each
from ident.residuals.decimation import averaged, stride
from ident.run import Run
from ident.words.percent import percent
from ident.words.result_tables import Listing, TabularResult

Array = NDArray[np.float64]
_REACHES = (3, 8, 24)  # samples of the correction to either side of now; the best is taken
_WIDTH = 2 * _REACHES[-1] + 1
_STRETCHES = 8
_LEVELS = (1e-8, 1e-6, 1e-4, 1e-2)  # of the diagonal, against directions that are hardly excited; the best is taken


@dataclass(frozen=True)
class Budget(TabularResult):
    """The parts of eq. (17) as fractions, combining quadratically; `bounds` are (lower, upper) of each.

    `noise` is None where nothing tells it: then it is within `nonlinear`, up to its upper bound.
    """

    noise: float | None
    linear: float
    nonlinear: float
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def error(self) -> float:
        """Eq. (17) averaged over the runs."""
        return float(np.sqrt((self.noise or 0.0) ** 2 + self.linear**2 + self.nonlinear**2))

    def listings(self) -> Iterator[Listing | str]:
        """What the error is made of, and what is to be known of it."""
        sizes = {"noise": self.noise, "linear": self.linear, "nonlinear": self.nonlinear}
        unknown = (None, None)  # of a budget that an earlier version wrote
        rows = [(name, percent(size), *map(percent, self.bounds.get(name, unknown))) for name, size in sizes.items()]
        numbers = ("size", "at least", "at most")
        yield Listing("", ("error budget", *numbers), rows, numbers)
        for note in self.notes:
            yield f"note: {note}"

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return asdict(self) | {"bounds": {name: list(pair) for name, pair in self.bounds.items()}}


def budget(comparison: Comparison, use: str = "fit") -> Budget:
    """The error budget of the runs of a use, or of all runs where there are none of it.

    Raises Unusable where the model is unstable at every run.
    """
    runs = [run for run in comparison.runs if not run.unstable and run.error > 0]
    runs = [run for run in runs if run.run.use == use] or runs
    if not runs:
        raise Unusable("unstable-model", "the model is unstable at every run", "fit", "fit it to these data first")
    squares = np.array([run.error**2 for run in runs])
    count = stride([run.run for run in runs])
    sums = each(lambda run: _sums(run, count), runs)
    common = _left(squares, _gains(sums, [_condition(run.run) for run in runs], squares))
    own = _left(squares, _gains(sums, [(_condition(run.run), _amplitude(run.run)) for run in runs], squares))
    used = [run.run for run in runs]
    floors = noise_floors(comparison.matrix.runs, excited_band(used))
    noise = floors.mean(used)
    parts = _parts(float(np.mean(np.sqrt(squares))), common, own, noise, floors.measured)
    several = len({(_condition(run.run), _amplitude(run.run)) for run in runs}) > len({_condition(r.run) for r in runs})
    return Budget(
        noise=None if noise is None else parts["noise"][0],
        linear=parts["linear"][0],
        nonlinear=parts["nonlinear"][1],
        bounds=parts,
        notes=tuple(_notes(floors.measured, noise is not None, several, parts)),
    )


def _left(squares: Array, gains: Array) -> float:
    """Eq. (17) averaged over the runs after what was gained."""
    return float(np.mean(np.sqrt(np.maximum(squares - gains, 0.0))))


def _parts(
    error: float, common: float, own: float, noise: float | None, measured: bool
) -> dict[str, tuple[float, float]]:
    """(lower, upper) of each part; `common` and `own` are the errors with a linear correction shared, and each its."""
    rest = min(common, error)
    least = min(noise or 0.0, rest)
    proven = min(_apart(rest, own), _apart(rest, least))
    most = least if measured else _apart(rest, proven)
    return {
        "noise": (least, most),
        "linear": (_apart(error, rest), _apart(_apart(error, least), proven)),
        "nonlinear": (_apart(rest, most), _apart(rest, least)),
    }


def _apart(whole: float, part: float) -> float:
    """What is left when a part is taken off, quadratically."""
    return float(np.sqrt(max(whole**2 - part**2, 0.0)))


def _notes(measured: bool, floor: bool, several: bool, parts: Mapping[str, tuple[float, float]]) -> Iterator[str]:
    if measured:
        yield "Noise estimated from repeated runs, or from a command that repeats itself."
        return
    if floor:
        yield "Noise: a lower bound, from the spectrum above the command bandwidth (white noise assumed)."
    else:
        yield "Noise unknown: no part of the spectrum shows the noise alone. It is included in the nonlinear part."
    noise, nonlinear = (" to ".join(f"{100 * bound:.3g}" for bound in parts[name]) for name in ("noise", "nonlinear"))
    yield (
        "Without a repeated run, in-band noise and nonlinear distortion cannot be separated: "
        f"noise {noise} %, nonlinear {nonlinear} %. Repeat one run with the same command."
    )
    if not several:
        yield (
            "No condition was measured at two amplitudes, so a nonlinearity may be counted as linear. "
            "Measure one condition at another amplitude."
        )


# Linear corrections -----------------------------------------------------------------------------------------------


def _condition(run: Run) -> object:
    return run.specimen, run.gain


def _amplitude(run: Run) -> float:
    return float(f"{np.std(run.command):.1e}")


def _sums(compared: RunComparison, count: int) -> Array:
    """Σ of products of [shifted model output, r] over even, over odd stretches, (2, w + 1, w + 1), over the power."""
    run, model, reach = compared.run, compared.modelled, _REACHES[-1]
    residual = run.measured - model
    r, y = averaged(residual - residual.mean(), count), averaged(model - model.mean(), count)
    shifted = sliding_window_view(np.concatenate([np.zeros(reach), y, np.zeros(reach)]), _WIDTH)
    stretch = np.arange(len(r)) * _STRETCHES // len(r) % 2
    rows = np.column_stack([shifted, r])
    sums = [rows[stretch == kind].T @ rows[stretch == kind] for kind in (0, 1)]
    return np.asarray(np.array(sums) / (len(r) * np.var(run.measured)))


def _gains(sums: Sequence[Array], keys: Sequence[object], squares: Array) -> Array:
    """What one correction for each key takes off each run's squared error, on stretches that it was not fitted to."""
    best = np.zeros(len(squares))
    groups = [[i for i, other in enumerate(keys) if other == key] for key in dict.fromkeys(keys)]
    weighted = [np.sum([sums[i] / np.sqrt(squares[i]) for i in members], axis=0) for members in groups]
    for reach, level in product(_REACHES, _LEVELS):
        used = np.arange(_REACHES[-1] - reach, _REACHES[-1] + reach + 1)
        gains = np.zeros(len(squares))
        for members, total in zip(groups, weighted, strict=True):
            for kind in (0, 1):
                h = _correction(total[1 - kind], used, level)
                for i in members:
                    gains[i] += _taken(sums[i][kind], used, h)
        best = gains if _left(squares, gains) < _left(squares, best) else best
    return best


def _correction(total: Array, used: NDArray[np.intp], level: float) -> Array:
    A, g = total[np.ix_(used, used)], total[used, -1]
    return np.asarray(np.linalg.solve(A + level * (np.trace(A) / len(used) or 1.0) * np.eye(len(used)), g))


def _taken(sums: Array, used: NDArray[np.intp], h: Array) -> float:
    """Σr² − Σ(r − h*y)²."""
    return float(2 * h @ sums[used, -1] - h @ sums[np.ix_(used, used)] @ h)
