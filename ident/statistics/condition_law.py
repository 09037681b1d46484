"""How a parameter of machines depends on a condition of their tests: a law, chosen by evidence, with its band.

Where every value has one sign the sets scatter by a share of the value: ln |y| has one standard deviation, elsewhere y.
The law is that of :mod:`ident.statistics.law_forms` with the least BIC = n ln(RSS/n) + k ln n, −2 times the logarithm
of its evidence for n sets and k parameters (Schwarz, Annals of Statistics 6 (1978) 461). It does not hold where
polynomials up to the fourth degree, added to it, reduce the residual by more than chance: the F-test of lack
of fit. Bands are those of nonlinear regression by its linearisation (Bates and Watts 1988, section 2.3).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy  # optimize, which takes long to load, is loaded where it is first used
from numpy.polynomial.legendre import legvander
from scipy.special import fdtrc, stdtrit

from ident.statistics.law_forms import LINE, Array, LawForm, forms_of

FEWEST_FOR_LAW = 5
"""Sets from which a law is given: a line leaves three degrees of freedom to its scatter."""
LACK_OF_FIT = 0.01
"""A law does not hold where chance would make such a lack of fit more seldom than this."""
SURE = 0.99
"""One-sided confidence with which a value at a condition is said to lie on one side of a limit."""
_BAND = 0.975  # one-sided: 95 % of both sides
_DEGREES = (2, 4)  # of the polynomials of the F-test; of a constant from the first on
_STEP = 1e-6  # of the parameters, for slopes
_EXACT = 1e-11  # of the largest value: a scatter below it is that of rounding


class Level(NamedTuple):
    """A parameter at a condition: value, standard error, and the ends of its 95 % band."""

    value: float
    std_error: float
    lower: float
    upper: float


@dataclass(frozen=True)
class Change:
    """From one condition to another y becomes `factor` y + `shift`; the standard error is that of ln y, or of y."""

    factor: float
    shift: float
    std_error: float


@dataclass(frozen=True)
class ConditionLaw:
    """A law of n `values` at `conditions`, of `probability` among all that were tried.

    `scatter` is the standard deviation of ln |y| where the sets scatter by a share (`relative`), else that of y.
    `lack_of_fit` is the chance of so large a lack of fit were the law true; None of too few sets.
    """

    form: LawForm
    parameters: tuple[float, ...]
    conditions: tuple[float, ...]
    values: tuple[float, ...]
    scatter: float
    relative: bool
    bic: float
    probability: float = 1.0
    lack_of_fit: float | None = None

    @property
    def name(self) -> str:
        """Of its form."""
        return self.form.name

    @property
    def holds(self) -> bool:
        """Whether the sets do not contradict it."""
        return self.lack_of_fit is None or self.lack_of_fit >= LACK_OF_FIT

    @property
    def sure(self) -> float:
        """Standard errors from a limit at which a value lies on one side of it with the confidence `SURE`."""
        return float(stdtrit(self._freedom, SURE))

    def covers(self, condition: float) -> bool:
        """Whether a condition lies between those of the sets."""
        return min(self.conditions) <= condition <= max(self.conditions)

    def at(self, condition: float) -> Level:
        """The law's value at a condition, with its 95 % band."""
        place = np.array([condition])
        level, error = float(self._curve(place)[0]), self._error(self._slopes(place)[0])
        half = float(stdtrit(self._freedom, _BAND)) * error
        if not self.relative:
            return Level(level, error, level - half, level + half)
        value = math.copysign(math.exp(level), self.values[0])
        lower, upper = sorted((value * math.exp(-half), value * math.exp(half)))
        return Level(value, abs(value) * error, lower, upper)

    def change(self, here: float, there: float) -> Change:
        """What becomes of a value when the condition changes."""
        both = np.array([here, there])
        levels, slopes = self._curve(both), self._slopes(both)
        moved, error = float(levels[1] - levels[0]), self._error(slopes[1] - slopes[0])
        return Change(math.exp(moved), 0.0, error) if self.relative else Change(1.0, moved, error)

    def judged(self) -> ConditionLaw:
        """With the chance of its lack of fit."""
        x = np.array(self.conditions)
        known = self._slopes(x)
        extra = legvander(LINE.abscissa(x)(x), _DEGREES[1])[:, min(known.shape[1], _DEGREES[0]) :]
        added = min(extra.shape[1], len(np.unique(x)) - known.shape[1])
        left = len(x) - known.shape[1] - added
        if added <= 0 or left <= 0:
            return self
        residual = _level_of(self.values, self.relative) - self._curve(x)
        before, after = (
            _rss(known, residual),
            _rss(np.asarray(np.column_stack([known, extra[:, :added]]), float), residual),
        )
        ratio = (before - after) / added / max(after / left, 1e-300)
        exact = self.scatter <= _EXACT * max(1.0, float(np.max(np.abs(residual + self._curve(x)))))
        return replace(self, lack_of_fit=1.0 if exact else float(fdtrc(added, left, max(ratio, 0.0))))

    @property
    def _freedom(self) -> int:
        return len(self.values) - len(self.parameters)

    def _curve(self, conditions: Array, parameters: Array | None = None) -> Array:
        given = np.array(self.parameters) if parameters is None else parameters
        return self.form.curve(given, self.form.abscissa(self.conditions)(conditions))

    def _slopes(self, conditions: Array) -> Array:
        """∂curve/∂parameters (n, k) of those that lie inside their bounds, by central differences."""
        given, columns = np.array(self.parameters), []
        for place, (lower, value, upper) in enumerate(zip(self.form.lower, given, self.form.upper, strict=True)):
            if lower < value < upper:
                step = np.zeros_like(given)
                step[place] = _STEP * max(abs(value), 1.0)
                ends = self._curve(conditions, given + step) - self._curve(conditions, given - step)
                columns.append(ends / (2 * step[place]))
        return np.stack(columns, axis=1)

    @cached_property
    def _covariance(self) -> Array:
        slopes = self._slopes(np.array(self.conditions))
        return np.asarray(self.scatter**2 * np.linalg.pinv(slopes.T @ slopes), dtype=float)

    def _error(self, slope: Array) -> float:
        return math.sqrt(max(float(slope @ self._covariance @ slope), 0.0))


def condition_laws(
    conditions: Sequence[float], values: Sequence[float], temperature: bool = False
) -> tuple[ConditionLaw, ...]:
    """The laws of values over a condition, the most probable first; over a temperature (K) those of viscosity, too.

    None of fewer than five sets; of sets at one condition only the constant.
    """
    x, y = np.asarray(conditions, dtype=float), np.asarray(values, dtype=float)
    if len(x) < FEWEST_FOR_LAW or not (np.isfinite(x).all() and np.isfinite(y).all()):
        return ()
    relative = bool((y > 0).all() or (y < 0).all())
    tried = (_fitted(form, x, y, relative) for form in forms_of(temperature, relative))
    found = sorted((law for law in tried if law is not None), key=lambda law: law.bic)
    weights = np.exp(-0.5 * (np.array([law.bic for law in found]) - found[0].bic))
    shares = (weights / weights.sum()).tolist()
    return tuple(replace(law.judged(), probability=share) for law, share in zip(found, shares, strict=True))


def _fitted(form: LawForm, x: Array, y: Array, relative: bool) -> ConditionLaw | None:
    """The least squares fit of a form; None where the sets do not determine it."""
    count, target = len(form.lower), _level_of(y, relative)
    if len(np.unique(x)) < count or len(x) < count + 2:
        return None
    place, middle = form.abscissa(x)(x), float(np.mean(target))
    size = float(np.std(target)) or abs(middle) or 1.0

    def residual(p: Array) -> Array:
        return (form.curve(p, place) - target) / size

    starts = [np.array([middle, *start[1:]]) for start in form.starts]
    start = min(starts, key=lambda one: float(np.sum(residual(one) ** 2)))
    end = scipy.optimize.least_squares(
        residual, start, bounds=(form.lower, form.upper), x_scale="jac", xtol=1e-10, ftol=1e-10
    )
    at_bound = np.select([end.active_mask < 0, end.active_mask > 0], [form.lower, form.upper], end.x)
    rss = 2 * float(end.cost) * size**2
    bic = len(x) * math.log(max(rss, 1e-300) / len(x)) + count * math.log(len(x))
    scatter = math.sqrt(rss / (len(x) - count))
    return ConditionLaw(form, tuple(at_bound.tolist()), tuple(x.tolist()), tuple(y.tolist()), scatter, relative, bic)


def _level_of(values: Sequence[float] | Array, relative: bool) -> Array:
    found: Array = np.log(np.abs(values)) if relative else np.asarray(values, dtype=float)
    return found


def _rss(basis: Array, target: Array) -> float:
    """What the least squares fit of a basis leaves."""
    solution = np.linalg.lstsq(basis, target, rcond=None)[0]
    return float(np.sum((target - basis @ solution) ** 2))
