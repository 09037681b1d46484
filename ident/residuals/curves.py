"""The missing characteristic itself: what would have to be added at a place of the chain, as a function of a signal.

With T the linear response from that place to the output, s the signal, r the residual, J the sensitivities to the
parameters, φ = Σ θ_b h_b a broken line through knots (h_b hat functions),

    r = T * φ(s) + J δ + noise                       least squares for θ and δ, each run weighted by its residual

so that nothing is inverted and noise is not amplified: T * h_b are simulated. The response is that of first order: s
is then improved by what φ and δ make of it, and the fit repeated. What the parameters explain as well (a straight line
where one of them is just that slope, a constant where eq. (17) is blind to it) is no property of the curve: the line
is chosen with which most of the curve is level, and the constant with which it passes through zero at zero.
Bands are 95 % from the scores of separate stretches of the records, which holds for residuals of any colour.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.compare import Comparison, fitted
from ident.parallel import each
from ident.residuals.coarse import Response
from ident.residuals.traces import Band, Trace, Traces, traces
from ident.residuals.views import View, unit, views
from ident.spectra import within

Array = NDArray[np.float64]
LEVELS = (0.001, 0.006, 0.02, *(0.055 + 0.89 * i / 15 for i in range(16)), 0.98, 0.994, 0.999)
"""Shares of the samples below each knot: the ends are seldom visited, and worth a look."""
_BLOCKS = 8  # stretches of a record; even ones and odd ones judge each other
_ROUNDS = 3
_ABSORBED = 0.98  # share of a response that the parameters explain: then it is theirs
_LOST = 1e-9  # of the largest eigenvalue
_LEVEL = 0.05  # of the range of slopes: pieces within it have the same
_BAND = 1.96  # standard errors of 95 %


@dataclass(frozen=True)
class Curve:
    """One curve: `x` in `x_unit`, `y` with its band in `y_unit`.

    `explained` is the share of the residual's power that the curve takes away on stretches that it was not fitted to.
    """

    name: str
    missing: str
    against: str
    shows: str
    x_unit: str
    y_unit: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    explained: float

    def to_json(self) -> dict[str, Any]:
        """As plain JSON data."""
        return asdict(self)


@dataclass(frozen=True)
class _Normal:
    """Sums of products of [T*h, J, r] of each stretch, (stretches, q, q); `odd` marks every other one."""

    blocks: Array
    odd: NDArray[np.bool_]
    knots: int

    def solved(self, used: NDArray[np.bool_], first: int = 0) -> Array:
        """The least-squares solution on some stretches for the columns from `first` on, zero before."""
        total = self.blocks[used].sum(axis=0)
        found = np.zeros(len(total) - 1)
        found[first:] = _solve(total[first:-1, first:-1], total[first:-1, -1])
        return found

    def left(self, used: NDArray[np.bool_], found: Array) -> float:
        """The residual's power on some stretches after a solution."""
        direction = np.append(-found, 1.0)
        return float(direction @ self.blocks[used].sum(axis=0) @ direction)

    @property
    def explained(self) -> float:
        """What the curve takes off beyond the parameters, on the stretches that it was not fitted to."""
        sides = [(self.odd, ~self.odd), (~self.odd, self.odd)]
        with_curve = sum(self.left(judge, self.solved(fit)) for fit, judge in sides)
        without = sum(self.left(judge, self.solved(fit, self.knots)) for fit, judge in sides)
        return 1.0 - with_curve / without if without > 0 else 0.0


def curves(
    comparison: Comparison, of: Comparison | None = None, *, view: str | None = None, band: Band | None = None
) -> tuple[Curve, ...]:
    """The curves of a compared model, those that explain most first, or the one of `view`.

    With `of`, another model of the same runs, what that model has beyond the first one: its prediction of the curves.
    With `band` (Hz), from what the residual has within it.
    """
    return curves_of(replace(traced(comparison, of), band=band), view)


def traced(comparison: Comparison, of: Comparison | None = None) -> Traces:
    """What moves inside the model, for every signal that a view reads."""
    preset, _, _ = fitted(comparison.fit, comparison.matrix)
    signals = tuple(dict.fromkeys(name for view in views(preset) for name in view.signals))
    return traces(comparison, signals, None if of is None else {run.run.id: run.modelled for run in of.runs})


def curves_of(found: Traces, view: str | None = None) -> tuple[Curve, ...]:
    """The curve of every view that the model has the signals for, those that explain most first; or of one."""
    known = views(found.preset)
    wanted = [one for one in known if one.name == view] or known  # an unknown name is refused by who draws
    drawn = each(lambda one: curve(found, one), wanted)
    return tuple(sorted((c for c in drawn if c is not None), key=lambda c: -c.explained))


def curve(found: Traces, view: View) -> Curve | None:
    """The curve of one view; None where its signal does not move."""
    now = [dict(trace.signals) for trace in found.runs]
    knots = _knots(np.concatenate([_abscissa(view, signals) for signals in now]))
    if knots is None:
        return None
    paths = found.paths(view)
    normal = _normal(found, view, knots, paths, now)
    free, solution = _gauge(normal, knots)
    for _ in range(_ROUNDS - 1):
        both = zip(found.runs, paths, now, strict=True)
        now = [_improved(trace, view, knots, solution, path, signals) for trace, path, signals in both]
        normal = _normal(found, view, knots, paths, now)
        free, solution = _gauge(normal, knots)
    deviation = _deviations(normal, free)
    known = found.actuator.piston_area is not None
    unknown = any(trace.run.units.get(trace.run.output, "m") == "1" for trace in found.runs)
    x_unit = "1" if unknown else unit(found.preset, view.by, known)
    y_unit = "1" if unknown or view.relative else unit(found.preset, view.at, known)
    y = solution[: len(knots)]
    return Curve(
        view.name, view.missing, view.against, view.shows, x_unit, y_unit, tuple(knots.tolist()), tuple(y.tolist()),
        tuple((y - _BAND * deviation).tolist()), tuple((y + _BAND * deviation).tolist()), normal.explained,
    )  # fmt: skip


def _abscissa(view: View, signals: Mapping[str, Array]) -> Array:
    s = signals[view.by]
    return s * np.sign(signals[view.directed]) if view.directed else s


def _knots(samples: Array) -> Array | None:
    """Knots at quantiles of the samples; None where these coincide."""
    moving = samples[samples != 0]  # without a specimen its force is zero all the time
    knots = np.unique(np.quantile(moving, LEVELS)) if len(moving) else moving
    return knots if len(knots) == len(LEVELS) and np.ptp(knots) > 0 else None


def _hats(s: Array, knots: Array) -> Array:
    """Every hat function of the samples, (n, knots)."""
    place = np.clip(np.searchsorted(knots, s) - 1, 0, len(knots) - 2)
    share = np.clip((s - knots[place]) / (knots[place + 1] - knots[place]), 0.0, 1.0)
    hats = np.zeros((len(s), len(knots)))
    rows = np.arange(len(s))
    hats[rows, place], hats[rows, place + 1] = 1.0 - share, share
    return hats


def _basis(view: View, signals: Mapping[str, Array], knots: Array) -> Array:
    hats = _hats(_abscissa(view, signals), knots)
    return hats * signals[view.relative][:, None] if view.relative else hats


def _columns(
    trace: Trace, signals: Mapping[str, Array], view: View, knots: Array, path: Response, band: Band | None
) -> Array:
    """[T*h, J, r] without their means and what is out of the band, each over the residual's size, (n, knots+p+1)."""
    answers = path.only(1).to(_basis(view, signals, knots))[:, :, 0]
    columns = np.column_stack([answers, trace.sensitivities, trace.residual])
    if band is not None:
        columns = within(columns, trace.rate, *band)
    columns -= columns.mean(axis=0)
    return np.asarray(columns / max(float(np.std(columns[:, -1])), 1e-300))


def _normal(
    found: Traces, view: View, knots: Array, paths: Sequence[Response], now: Sequence[Mapping[str, Array]]
) -> _Normal:
    def of_run(i: int) -> Array:
        rows = _columns(found.runs[i], now[i], view, knots, paths[i], found.band)
        return np.array([part.T @ part for part in np.array_split(rows, _BLOCKS)])

    blocks = np.concatenate(each(of_run, range(len(now))))
    return _Normal(blocks, np.arange(len(blocks)) % 2 == 1, len(knots))


def _solve(A: Array, g: Array) -> Array:
    """The least solution of a scaled problem, directions that the data do not see left out."""
    return np.asarray(_inverse(A) @ g)


def _inverse(A: Array) -> Array:
    scale = np.sqrt(np.maximum(np.diag(A), 1e-300))
    strengths, directions = np.linalg.eigh(A / scale[:, None] / scale)
    seen = strengths > _LOST * strengths[-1]
    inverse = (directions[:, seen] / strengths[seen]) @ directions[:, seen].T
    return np.asarray(inverse / scale[:, None] / scale)


def _gauge(normal: _Normal, knots: Array) -> tuple[Array, Array]:
    """What is free in the curve, (knots, f), and the solution with the freedom used as the module says."""
    every = np.full(len(normal.odd), True)
    total, k = normal.blocks.sum(axis=0), len(knots)
    found = normal.solved(every)
    line, level = knots / np.abs(knots).max(), np.ones(k)
    free = [shape for shape in (line, level) if _is_absorbed(total, shape, k)]
    y = found[:k].copy()
    if any(shape is line for shape in free):
        y -= _commonest_slope(knots, y) * knots
    if any(shape is level for shape in free):
        y -= float(np.interp(0.0, knots, y))
    delta = _solve(total[k:-1, k:-1], total[k:-1, -1] - total[k:-1, :k] @ y)
    return np.array(free).reshape(-1, k).T, np.concatenate([y, delta])


def _is_absorbed(total: Array, shape: Array, k: int) -> bool:
    """Whether the parameters and the mean do what this shape of the curve does."""
    power = float(shape @ total[:k, :k] @ shape)
    size = float(np.trace(total[:k, :k]))
    if power < 1e-9 * size:
        return True
    cross = total[k:-1, :k] @ shape
    return bool(cross @ _solve(total[k:-1, k:-1], cross) > _ABSORBED * power)


def _commonest_slope(knots: Array, y: Array) -> float:
    """The slope that most pieces have, the mean of two where as many have either: the level parts of the curve."""
    lengths = np.diff(knots)
    slopes = np.diff(y) / lengths
    near = np.abs(slopes[:, None] - slopes) <= _LEVEL * np.ptp(slopes)
    count = near.sum(axis=1)
    chosen = [float(np.average(slopes[of], weights=lengths[of])) for of in near[count >= 0.8 * count.max()]]
    return 0.5 * (min(chosen) + max(chosen))


def _deviations(normal: _Normal, free: Array) -> Array:
    """Standard errors of the knots' values, what is free held, from the scores of the stretches."""
    k, every = normal.knots, np.full(len(normal.odd), True)
    total = normal.blocks.sum(axis=0)
    direction = np.append(-normal.solved(every), 1.0)
    scores = normal.blocks[:, :-1] @ direction
    inverse = _inverse(total[:-1, :-1])
    held = np.eye(k)
    if free.size:
        weight = np.diag(total[:k, :k])[:, None]
        held -= free @ np.linalg.lstsq((weight * free).T @ free, (weight * free).T, rcond=1e-12)[0]
    effect = held @ inverse[:k]
    spread = effect @ scores.T
    return np.asarray(np.sqrt((spread**2).sum(axis=1) * len(scores) / max(len(scores) - 1, 1)))


def _improved(
    trace: Trace, view: View, knots: Array, solution: Array, path: Response, now: Mapping[str, Array]
) -> dict[str, Array]:
    """The signals as the curve and the changed parameters make them; at its own place a signal is meant before it."""
    added = _basis(view, now, knots) @ solution[: len(knots)]
    answers = path.to(added[:, None])[:, 0, 1:]
    delta = solution[len(knots) :]
    out = {}
    for i, name in enumerate(view.signals):
        out[name] = trace.signals[name] + answers[:, i] + trace.moved[name] @ delta
        if name == view.at:
            out[name] -= added
    return dict(now) | out
