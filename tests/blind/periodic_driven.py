"""The fits to a driven mass's output without noise, by least squares over the reference's own simulation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from tests.blind.periodic import SETTLING, SUBSTEPS, Test
from tests.blind.periodic_candidates import CANDIDATES, FREE, Candidate
from tests.reference.periodic_reference import Law, driven

Array = NDArray[np.float64]
EXACT = 1.0  # d2 that the truth may leave of itself, simulated with the steps of the fits
_CYCLE = 100  # samples, at least, of the periods that stand for all
_FIRST, _EVALUATIONS = 12, 60  # steps of a fit from each start, and of the best of these
_FARTHER = 2  # starts that are followed so far


@dataclass(frozen=True)
class Driven:
    """The fits to a driven mass, over as few periods as stand for all, with as few steps as leave the truth itself."""

    test: Test

    @cached_property
    def periods(self) -> tuple[int, int]:
        """Periods of the record that are simulated, and how many of the last of them stand for the rest."""
        last = int(np.ceil(_CYCLE / self.test.samples))
        settling = 0 if self.test.begins == "moving" else SETTLING
        return settling + last, last

    @cached_property
    def length(self) -> int:
        """Samples of the record that are simulated."""
        return min(int(self.periods[0] * self.test.samples), self.test.fitted)

    @cached_property
    def weights(self) -> Array:
        """By how many samples each counts."""
        last = min(int(self.periods[1] * self.test.samples), self.length)
        weights = np.ones(self.length)
        weights[self.length - last :] = (self.test.fitted - self.length + last) / last
        return weights

    @cached_property
    def command(self) -> Array:
        return self.test.commands(self.length)

    @cached_property
    def substeps(self) -> int:
        """Steps a sample, by which the truth leaves nothing of itself."""
        steps = max(1, int(np.ceil(150 / self.test.samples)))
        while steps < SUBSTEPS:
            left = self.residual(self.test.law, steps)
            if left @ left <= EXACT:
                return steps
            steps *= 2
        return SUBSTEPS

    def residual(self, law: Law, substeps: int | None = None, length: int | None = None) -> Array:
        """What a law leaves of the truth, in deviations of the noise, offset free; of so many samples with `length`."""
        command = self.command if length is None else self.test.commands(length)
        found = driven(law, command, self.test.rate, self.test.hold, substeps or self.substeps, self.test.output)
        left = found[self.test.before :] - self.test.truth[: len(command) - self.test.before]
        weights = self.weights if length is None else np.ones(length)
        left = np.sqrt(weights) * (left - np.average(left, weights=weights)) / self.test.sigma
        return np.nan_to_num(left, nan=1e6, posinf=1e6, neginf=1e6).clip(-1e6, 1e6)

    @cached_property
    def base(self) -> tuple[float, Law]:
        """What the base alone leaves, and its parameters."""
        bare = Law(**{name: getattr(self.test.law, name) for name in ("m", "c", "k", "Kt", "Kp")})
        return min((self._fit(bare, (), factor) for factor in (1.0, 2.0)), key=lambda one: one[0])

    @cached_property
    def scales(self) -> dict[str, float]:
        """The sizes of what the base does: signals of its motion, by the unit of a parameter."""
        law = self.base[1]
        x, v = (
            driven(law, self.command, self.test.rate, self.test.hold, self.substeps, name)[self.test.before :]
            for name in ("displacement", "velocity")
        )
        drive = self.command[self.test.before :]
        if law.Kp:
            drive = law.Kp * (drive - x)
        size = {"way": np.abs(x).max(), "speed": np.abs(v).max(), "drive": np.abs(drive).max()}
        size |= {"force": law.Kt * size["drive"], "period": 1.0 / self.test.frequency, "1": 1.0}
        size |= {f"1/{name}": 1.0 / size[name] for name in ("drive", "period")}
        size |= {"force/way": size["force"] / size["way"], "1/way^2": size["way"] ** -2}
        size |= {f"force/way^{n}": size["force"] / size["way"] ** n for n in (2, 3)}
        return {
            name: float(one) for name, one in (size | {"force/speed^2": size["force"] / size["speed"] ** 2}).items()
        }

    def d2(self, name: str, enough: float) -> float:
        """What the best fit with an effect leaves; further starts are tried until one is enough."""
        if name == "":
            return self.base[0]
        how, best = CANDIDATES[name], self.base[0]
        named = [f"{name}_{one}" for one in (how.strength, *(shape.name for shape in how.shapes))]
        if self.test.hidden == name:
            best = min(best, self._fit_from(self.test.law, named, how)[0])
        sizes = [self.scales[size] for size in (how.scale, *(shape.scale for shape in how.shapes))]
        found: list[tuple[float, Law]] = []
        for starts in product(how.starts, *(shape.starts for shape in how.shapes)):
            if best <= enough:
                return best
            begun = {one: start * size for one, start, size in zip(named, starts, sizes, strict=True)}
            found.append(self._fit_from(self.base[1]._replace(**begun), named, how, _FIRST))
            best = min(best, found[-1][0])
        for _, law in sorted(found, key=lambda one: one[0])[:_FARTHER]:
            if best > enough:
                best = min(best, self._fit_from(law, named, how)[0])
        return best

    def _fit_from(self, law: Law, named: Sequence[str], how: Candidate, most: int = _EVALUATIONS) -> tuple[float, Law]:
        lowest = 1.0 / (self.test.rate * self.substeps)  # a lag shorter than a step is none
        strength = _Axis(
            named[0],
            self.scales[how.scale],
            False,
            -how.upper
            if how.both
            else lowest / self.scales[how.scale]
            if named[0].endswith(("_T", "_Tn")) and not named[0].endswith("delay_T")
            else 0.0,
            how.upper,
        )
        axes = [
            _Axis(one, self.scales[s.scale], s.logarithmic, s.lower, s.upper)
            for one, s in zip(named[1:], how.shapes, strict=True)
        ]
        return self._fit(law, (strength, *axes), most=most)

    def _fit(self, law: Law, axes: Sequence[_Axis], factor: float = 1.0, most: int = _EVALUATIONS) -> tuple[float, Law]:
        """Least squares over the base's parameters and these axes from a law."""
        own = [_Axis(name, getattr(law, name), True, 1e-4, 1e4) for name in FREE[self.test.machine]]
        every = [*own, *axes]
        lower, upper = (np.array([axis.bound(side) for axis in every]) for side in ("lower", "upper"))
        start = np.array([axis.at(getattr(law, axis.name) * (factor if axis in own else 1.0)) for axis in every])
        start = np.clip(start, lower + 1e-9, upper - 1e-9)

        def law_of(point: Array) -> Law:
            return law._replace(**{axis.name: axis.value(p) for axis, p in zip(every, point, strict=True)})

        found = least_squares(
            lambda point: self.residual(law_of(point)),
            start,
            bounds=(lower, upper),
            x_scale="jac",
            max_nfev=most,
            ftol=1e-4,
            xtol=1e-7,
            diff_step=1e-5,
        )
        return float(2 * found.cost), law_of(found.x)


class _Axis(NamedTuple):
    """A parameter of a fit, in its scale or in the logarithm of that."""

    name: str
    scale: float
    logarithmic: bool
    lower: float
    upper: float

    def at(self, value: float) -> float:
        return float(np.log(max(value / self.scale, 1e-12))) if self.logarithmic else value / self.scale

    def value(self, point: float) -> float:
        return float(np.exp(point)) * self.scale if self.logarithmic else float(point) * self.scale

    def bound(self, side: str) -> float:
        bound: float = getattr(self, side)
        return float(np.log(bound)) if self.logarithmic else bound
