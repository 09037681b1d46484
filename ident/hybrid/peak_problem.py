"""A peak of the response as smooth conditions on a change of the parameters, for a search that follows slopes.

The unknowns are x = (z, p, t): z the natural logarithms of the factors of n parameters, and for each of g gains the
logarithms of the frequency p of the peak and of a trough t below it. With L = ln|G| over ln f the conditions are

    L'(p) = 0,  L''(p) < 0,  L(p) ≥ L within 10 % of p,  L(p) − L(t) ≥ ln 1.01,  t < p,  f0 ± tolerance holds exp p,

poles that settle, and |G| inside its axes over their frequencies. Slopes are differences of the one linearised chain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.errors import Unusable
from ident.hybrid.changed_machine import ChangedMachine
from ident.hybrid.peaks import PROMINENCE, Peak, peaks

Array = NDArray[np.float64]
_STEP, _SPAN = 1e-6, 2e-3  # of ln factor and of ln f: the steps of slopes
_MARGIN = 5e-4  # by which a solution keeps its conditions
_WITHIN = 5e-3  # of the tolerance, by which a peak keeps from its edge
_SETTLING = 1e-3  # of the frequency of the peak: the least share at which every pole settles
_ON_AXES = 50  # frequencies at which the axes are kept
_FINE = 900  # frequencies at which a solution is judged
_STENCIL, _OUTER = np.array([-1.0, 0.0, 1.0]) * _SPAN, np.array([-2.0, 2.0]) * _SPAN
_AROUND = np.array([0.0, -0.1, -0.06, -0.03, 0.03, 0.06, 0.1])  # of ln f: where the peak is higher than the curve
_BELOW = 0.03  # of ln f: the least distance of the trough
_ROUND = 0.05  # the least −L'' of a peak: a broad one that stands 1 % above its trough has 0.08


@dataclass(frozen=True)
class Axes:
    """The range of |G| at a gain Kp that the response has to stay in, up to the frequency of the target."""

    gain: float
    lower: float
    upper: float


@dataclass(frozen=True)
class PeakTarget:
    """A peak at `frequency` ± `tolerance` (Hz) at each of the gains, inside `axes` from 0 to `up_to` (Hz).

    Without `up_to` the axes end where the tolerance does; without gains they are those of who asks. Raises Unusable for
    numbers that are no such thing.
    """

    frequency: float
    tolerance: float
    gains: tuple[float, ...] = ()
    axes: tuple[Axes, ...] = ()
    up_to: float = 0.0

    def __post_init__(self) -> None:
        if not (0 < self.tolerance < self.frequency < np.inf and min(self.gains, default=1.0) > 0):
            raise Unusable(
                "bad-peak",
                f"no peak at {self.frequency:g} ± {self.tolerance:g} Hz",
                "peak",
                "give a frequency and a smaller tolerance above 0",
            )
        for axes in self.axes:
            if (self.gains and axes.gain not in self.gains) or not 0 < axes.lower < axes.upper:
                raise Unusable(
                    "bad-axes",
                    f"{axes.lower:g} to {axes.upper:g} at Kp = {axes.gain:g}",
                    "axes",
                    "give a range above 0 at one of the gains",
                )
        if not self.up_to:
            object.__setattr__(self, "up_to", self.frequency + self.tolerance)

    def of(self, gain: float) -> tuple[float, float]:
        """The range of |G| at a gain."""
        found = [(axes.lower, axes.upper) for axes in self.axes if axes.gain == gain]
        return found[0] if found else (0.0, np.inf)

    def widened(self, share: float) -> tuple[Axes, ...]:
        """The axes wider by this share of either end."""
        return tuple(Axes(a.gain, a.lower * (1 - share), a.upper * (1 + share)) for a in self.axes)


@dataclass(frozen=True)
class PeakProblem:
    """The conditions for one machine and the parameters `names` that may change."""

    machine: ChangedMachine
    target: PeakTarget
    names: tuple[str, ...]
    _last: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)

    @property
    def gains(self) -> Array:
        """Gains Kp, (g,)."""
        return np.array(self.target.gains)

    def levels(self, z: Array, frequency: Array) -> tuple[Array, Array]:
        """L = ln|G| (v, g, f) and the largest real part of a pole (v, g) in Hz, for changes z (v, n)."""
        factors = {name: np.exp(z[:, i, None]) for i, name in enumerate(self.names)}
        model = self.machine.linear(np.broadcast_to(self.gains, (len(z), len(self.gains))), factors)
        growth = np.linalg.eigvals(model.A).real.max(axis=-1) / (2 * np.pi)
        return np.log(np.abs(model.frequency_response(frequency))), growth

    @cached_property
    def grid(self) -> Array:
        """Frequencies at which the axes are kept, (f,) in Hz; none without axes."""
        return np.linspace(self.target.up_to / _ON_AXES, self.target.up_to, _ON_AXES if self.target.axes else 0)

    @cached_property
    def _axes(self) -> tuple[Array, Array]:
        """The ends of the axes as logarithms, (g,) each."""
        with np.errstate(divide="ignore"):
            ends = np.log(np.array([self.target.of(gain) for gain in self.target.gains]))
        return ends[:, 0], ends[:, 1]

    def bounds(self, widest: float) -> list[tuple[float, float]]:
        """Of x; `widest` is the largest |ln factor|."""
        f0, d, g = self.target.frequency, self.target.tolerance * (1 - _WITHIN), len(self.gains)
        near = (float(np.log(f0 - d)), float(np.log(f0 + d)))
        return [(-widest, widest)] * len(self.names) + [near] * g + [(near[0] - 4, near[1])] * g

    def equal(self, x: Array) -> tuple[Array, Array]:
        """L'(p) at each gain, (g,), and its slope by x."""
        found: tuple[Array, Array] = self._conditions(x)[0]
        return found

    def least(self, x: Array) -> tuple[Array, Array]:
        """What must not be below 0, (c,), and its slope by x."""
        found: tuple[Array, Array] = self._conditions(x)[1]
        return found

    def _conditions(self, x: Array) -> Any:
        if "x" not in self._last or not np.array_equal(self._last["x"], x):
            self._last.update(x=x.copy(), found=self._at(x))
        return self._last["found"]

    def _at(self, x: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Both kinds of conditions, each with its slope."""
        n, g = len(self.names), len(self.gains)
        z, p, t = x[:n], x[n : n + g], x[n + g :]
        around = (p[:, None] + _AROUND).ravel()
        centres = np.concatenate([around, t])[:, None] + _STENCIL
        near = np.exp(np.concatenate([centres.ravel(), (p[:, None] + _OUTER).ravel()]))
        moved = np.concatenate([z[None], z + _STEP * np.eye(n)])
        L, growth = self.levels(moved, np.concatenate([near, self.grid]))
        own, m = np.arange(g), 3 * g * len(_AROUND)
        by = L[:, :, :m].reshape(n + 1, g, g, len(_AROUND), 3)[:, own, own]  # each gain at its own peak
        low = L[:, :, m : m + 3 * g].reshape(n + 1, g, g, 3)[:, own, own]
        outer = L[0, :, m + 3 * g : m + 5 * g].reshape(g, g, 2)[own, own]
        top = by[:, :, 0]
        slope, bend = _slope(by), _bend(top)
        equal = (slope[0, :, 0], np.concatenate([_by_z(slope[..., 0]), np.diag(bend[0]), np.zeros((g, g))], axis=1))
        third = (outer[:, 1] - 2 * top[0, :, 2] + 2 * top[0, :, 0] - outer[:, 0]) / (2 * _SPAN**3)
        step = top[..., 1] - low[..., 1] - np.log(PROMINENCE) - _MARGIN
        limit = -growth / self.target.frequency - _SETTLING
        I, O = np.eye(g), np.zeros((g, g))  # noqa: E741 - as in print
        rows = [
            (-bend[0] - _ROUND, [_by_z(-bend), -np.diag(third), O]),
            (step[0], [_by_z(step), np.diag(slope[0, :, 0]), -np.diag(_slope(low[0]))]),
            (p - t - _BELOW, [np.zeros((g, n)), I, -I]),
            (limit[0], [_by_z(limit), O, O]),
        ]
        for j in range(1, len(_AROUND)):
            above = top[..., 1] - by[:, :, j, 1]
            rows.append((above[0], [_by_z(above), np.diag(slope[0, :, 0] - slope[0, :, j]), O]))
        rows += self._inside(L[:, :, m + 5 * g :], top[..., 1], slope[0, :, 0])
        least = np.concatenate([value for value, _ in rows])
        return equal, (least, np.concatenate([np.concatenate(parts, axis=1) for _, parts in rows]))

    def _inside(self, curve: Array, top: Array, slope: Array) -> list[tuple[Array, list[Array]]]:
        """The conditions of the axes, at their frequencies and at the peak."""
        rows, (g, f) = [], curve.shape[1:]
        for i, (lower, upper) in enumerate(zip(*self._axes, strict=True)):
            for sign, end in ((1.0, lower), (-1.0, upper)):
                if np.isfinite(end):
                    kept = sign * (curve[:, i] - end) - _MARGIN
                    rows.append((kept[0], [_by_z(kept), np.zeros((f, 2 * g))]))
                    peak = sign * (top[:, i, None] - end) - _MARGIN
                    by_p = np.zeros((1, 2 * g))
                    by_p[0, i] = sign * slope[i]
                    rows.append((peak[0], [_by_z(peak), by_p]))
        return rows

    def judged(self, z: Array) -> tuple[tuple[Peak, ...], ...] | None:
        """The peaks at the target, one a gain, of a change z (n,); None where it does not do. Judged on a fine grid."""
        f0, d = self.target.frequency, self.target.tolerance
        frequency = np.linspace(0, 1.5 * max(f0 + d, self.target.up_to), _FINE + 1)[1:]
        L, growth = self.levels(np.asarray(z)[None], frequency)
        return self.fits(frequency, L[0], growth[0])

    def fits(self, frequency: Array, L: Array, growth: Array) -> tuple[tuple[Peak, ...], ...] | None:
        """The peaks at the target of curves L (g, f) with poles of this growth (g,); None where they do not do."""
        if growth.max() >= 0:
            return None
        within, (lower, upper) = frequency <= self.target.up_to, self._axes
        if np.any(L[:, within] < lower[:, None]) or np.any(L[:, within] > upper[:, None]):
            return None
        found = tuple(tuple(peak for peak in peaks(frequency, np.exp(row)) if self._near(peak.frequency)) for row in L)
        return found if all(found) else None

    def _near(self, frequency: float) -> bool:
        return abs(frequency - self.target.frequency) <= self.target.tolerance


def free_parameters(machine: ChangedMachine) -> tuple[str, ...]:
    """The parameters that a search may change: those of the core that are not 0 and that the response reads."""
    read = set(machine.chain.symbols)
    found: Sequence[str] = [
        name
        for name, entry in machine.parameters.items()
        if entry.after and not (p := machine.preset.parameter(name)).of and p.in_equations in read
    ]
    return tuple(found)


def _slope(three: Array) -> Array:
    return np.asarray((three[..., 2] - three[..., 0]) / (2 * _SPAN))


def _bend(three: Array) -> Array:
    return np.asarray((three[..., 2] - 2 * three[..., 1] + three[..., 0]) / _SPAN**2)


def _by_z(values: Array) -> Array:
    """The slope by z (m, n) of values at the point and at each step, (n + 1, m)."""
    return np.asarray((values[1:] - values[0]).T / _STEP)
