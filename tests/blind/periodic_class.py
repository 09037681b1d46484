"""Which effects a periodic test allows: told by the reference before the program runs.

Every effect of the catalogue that applies at the machine is fitted to the output without noise, base and shape free:
d2 is the sum of the squares that the best fit leaves, over the variance of the noise. The class are all with d2 <= 20.
What the mean of the output alone would tell is left out, for the offset of a transducer is free: a static load, a bias.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize, nnls

from tests.blind.periodic import (
    SETTLING,
    SUBSTEPS,
    WORTH,
    Moved,
    Test,
    drawn,
    specimen_term,
)
from tests.reference.periodic_reference import Law, driven

Array = NDArray[np.float64]
ALIKE = 20.0  # d2 up to which a test cannot tell an effect from what is hidden
SHOWN = 60.0  # d2 that the base alone must leave
BEYOND = 1.1  # floors that the base alone must leave
LARGEST = 3  # names in a class
FASTEST = (
    1.5  # of the largest speed: with a speed that no test reaches the Stribeck excess is dry friction by another name
)
EXACT = 1.0  # d2 of the truth itself, simulated with the steps of the fits
_POINTS = 1500  # samples of a specimen that are fitted
_CYCLE = 100  # samples, at least, of the periods that stand for all
_EVALUATIONS = 25  # steps of a fit

NOTHING = ("static_load", "null_bias", "sensor_gain")
"""What base and offset take up wherever the gain of the output is free; of a loop the gain of the sensor is not."""


class Shape(NamedTuple):
    """A parameter beside the strength: where it is begun, in its scale, and the bounds of it."""

    name: str
    scale: str
    starts: tuple[float, ...]
    lower: float
    upper: float
    logarithmic: bool = True


class Candidate(NamedTuple):
    """How an effect is fitted at a driven mass: its strength, in its scale and to both sides of 0, and its shapes."""

    strength: str
    scale: str
    starts: tuple[float, ...]
    shapes: tuple[Shape, ...] = ()
    upper: float = np.inf
    both: bool = False


_FRICTION = (0.1, 0.5)
CANDIDATES: dict[str, Candidate] = {
    "command_delay": Candidate("T", "period", (0.01, 0.1), upper=0.5),
    "command_limit": Candidate("a", "1/drive", (1.2, 2.0), upper=20.0),
    "integral_action": Candidate("Ki", "1/period", (0.2, 2.0)),
    "lead": Candidate("Td", "period", (0.01,), upper=1.0),
    "loop_delay": Candidate("T", "period", (0.01,), upper=0.2),
    "valve_second_order": Candidate("Tn", "period", (0.01, 0.05), upper=0.5),
    "backlash": Candidate("b", "drive", (0.03, 0.2), upper=0.9),
    "dead_zone": Candidate("h", "drive", (0.05, 0.3), (Shape("a", "1", (0.0,), -1.0, 1.0, False),), upper=0.9),
    "underlap": Candidate("h", "drive", (0.05, 0.3), upper=1.0),
    "gain_asymmetry": Candidate("a", "1", (0.05, -0.05), upper=0.95, both=True),
    "flow_saturation": Candidate("a", "1/drive", (0.3, 1.5), upper=20.0),
    "coulomb_friction": Candidate("Fc", "force", _FRICTION),
    "stribeck_friction": Candidate("dF", "force", (0.3,), (Shape("vs", "speed", (0.03, 0.15, 0.6), 3e-3, FASTEST),)),
    "presliding_friction": Candidate("Fd", "force", (0.2,), (Shape("xs", "way", (3e-3, 0.03, 0.2), 3e-4, 5.0),)),
    "quadratic_damping": Candidate("c2", "force/speed^2", (0.2,)),
    "cubic_stiffness": Candidate("k3", "force/way^3", (0.1, -0.05), both=True),
    "sensor_lag": Candidate("T", "period", (0.01,), upper=0.5),
    "acquisition_lag": Candidate("T", "period", (0.01,), upper=0.5),
    "sensor_gain": Candidate("g", "1", (0.01,), upper=0.9, both=True),
    "position_friction": Candidate("Fx", "force/way^2", _FRICTION),
    "end_stop": Candidate(
        "ks", "force/way", (3.0,),
        (Shape("way", "way", (0.7, 0.85, 0.95), 0.2, 1.2), Shape("xm", "way", (0.0,), -0.3, 0.3, False)),
    ),
    "sensor_nonlinearity": Candidate("s", "1/way^2", (0.05,), both=True),
}  # fmt: skip
"""The catalogue at a driven mass; stops are begun where they would cut the motion that the base makes."""

_OF_LOAD = (
    "coulomb_friction", "stribeck_friction", "presliding_friction", "quadratic_damping", "cubic_stiffness",
    "position_friction", "end_stop",
)  # fmt: skip
_OF_DRIVE = (
    "command_delay", "command_limit", "valve_second_order", "backlash", "dead_zone", "underlap", "gain_asymmetry",
    "flow_saturation",
)  # fmt: skip
APPLICABLE: dict[str, tuple[str, ...]] = {
    "specimen": (*_OF_LOAD, "specimen_hysteresis", "specimen_free_play"),
    "motor": (*_OF_DRIVE, *_OF_LOAD),
    "drive": (*_OF_LOAD, "sensor_lag", "acquisition_lag", "sensor_nonlinearity"),
    "loop": (
        *_OF_DRIVE, *_OF_LOAD, "integral_action", "lead", "loop_delay", "sensor_lag", "acquisition_lag", "sensor_gain",
        "sensor_nonlinearity",
    ),
}  # fmt: skip
"""What is fitted at each machine; what the catalogue has beyond it changes nothing but gain and offset there."""
FREE = {"motor": ("Kt", "c"), "drive": ("m", "c", "k"), "loop": ("Kt", "c")}
"""The base's parameters of a driven mass; without a force in the records one of them is a scale of all."""


# -------------------------------------------------------------------------------------------------- a specimen, moved


@dataclass(frozen=True)
class Specimen:
    """The fits to a specimen's force: strengths are linear, so only the shapes are searched."""

    test: Test

    @cached_property
    def samples(self) -> NDArray[np.int64]:
        """All samples of the first two periods, and some of the others."""
        n = self.test.fitted
        first = min(int(2 * self.test.samples), _POINTS // 2, n)
        rest = np.random.default_rng(0).permutation(np.arange(first, n))[: _POINTS - first]
        return np.sort(np.concatenate([np.arange(first), rest]))

    @cached_property
    def weights(self) -> Array:
        """By how many samples each counts."""
        n = self.test.fitted
        first = min(int(2 * self.test.samples), _POINTS // 2, n)
        rest = max(len(self.samples) - first, 1)
        return np.where(self.samples < first, 1.0, (n - first) / rest)

    @cached_property
    def path(self) -> Moved:
        return self.test.path(self.samples)

    @cached_property
    def _root(self) -> Array:
        return np.sqrt(self.weights) / self.test.sigma

    @cached_property
    def _target(self) -> Array:
        return self._root * self.test.truth[self.samples]

    def d2(self, name: str = "", enough: float = ALIKE) -> float:
        """What the best fit with an effect leaves; the search ends where it is enough."""
        if name == "":
            return self._left(self._base(self.path.x), None)
        shapes = [*self._grid(name), *([self._true()] if name == self.test.hidden else [])]
        refined = sorted(((self._with(name, shape), shape) for shape in shapes), key=lambda one: one[0])
        best = refined[0][0]
        for _, shape in refined[:3] if len(refined[0][1]) else ():
            if best > enough:
                found = minimize(lambda p: self._with(name, p), shape, method="Nelder-Mead",
                                 options={"maxfev": 120, "xatol": 1e-4, "fatol": 0.1,
                                          "initial_simplex": _simplex(shape)})  # fmt: skip
                best = min(best, float(found.fun))
        return best

    def _grid(self, name: str) -> Iterator[Array]:
        if name == "stribeck_friction":
            yield from (np.array([p]) for p in np.linspace(np.log(3e-3), np.log(FASTEST), 24))
        elif name == "presliding_friction":
            yield from (np.array([p]) for p in np.linspace(np.log(3e-4), np.log(5.0), 28))
        elif name == "specimen_hysteresis":
            for xy, n in product(np.linspace(np.log(3e-3), np.log(5.0), 16), np.log([1.0, 1.7, 3.0, 5.0])):
                yield np.array([xy, n])
        elif name == "specimen_free_play":
            yield from (np.array([p]) for p in np.linspace(np.log(3e-3), np.log(0.95), 24))
        elif name == "end_stop":
            yield from (np.array([p, 0.0]) for p in np.linspace(np.log(0.3), np.log(0.999), 24))
        else:
            yield np.array([])

    def _true(self) -> Array:
        """The shape of what is hidden."""
        law, x, v = self.test.law, *(float(np.abs(one).max()) for one in (self.path.x, self.path.v))
        shape: dict[str, tuple[float, ...]] = {
            "stribeck_friction": (law.stribeck_friction_vs / v,),
            "presliding_friction": (law.presliding_friction_xs / x,),
            "specimen_hysteresis": (law.specimen_hysteresis_xy / x, law.specimen_hysteresis_n),
            "specimen_free_play": (self.test.free_play / x,),
        }  # fmt: skip
        if self.test.hidden == "end_stop":
            return np.array([np.log(law.end_stop_way / x), 0.0])
        return np.log(shape.get(self.test.hidden, ()))

    def _with(self, name: str, shape: Array) -> float:
        """The least that is left with an effect of that shape; shapes outside of their bounds leave all."""
        x, v = (float(np.abs(one).max()) for one in (self.path.x, self.path.v))
        if name == "specimen_free_play":
            play = float(np.exp(shape[0])) * x
            if play >= x:
                return np.inf
            return self._left(self._base(self.path.x - np.clip(self.path.x, -play, play)), None)
        if name == "specimen_hysteresis" and not -1e-9 <= shape[1] <= np.log(5.0) + 1e-9:
            return np.inf
        if name == "end_stop" and abs(shape[1]) > 0.3:
            return np.inf
        if name == "stribeck_friction" and shape[0] > np.log(FASTEST) + 1e-9:
            return np.inf
        values = [float(np.exp(p)) for p in shape]
        of = {
            "stribeck_friction": lambda: {"vs": values[0] * v}, "presliding_friction": lambda: {"xs": values[0] * x},
            "specimen_hysteresis": lambda: {"xy": values[0] * x, "n": max(values[1], 1.0)},
            "end_stop": lambda: {"way": values[0] * x, "xm": float(shape[1]) * x},
        }.get(name, dict)()  # fmt: skip
        return self._left(self._base(self.path.x), specimen_term(name, of, self.path), name == "cubic_stiffness")

    def _base(self, stretch: Array) -> list[Array]:
        return [self.path.v, stretch, self.path.a, np.ones(len(stretch)), -np.ones(len(stretch))]

    def _left(self, columns: list[Array], term: Array | None, both: bool = False) -> float:
        """The squares left by columns whose factors are not negative; the offset is free, and what may be negative."""
        if term is not None:
            columns = [*columns, term, *([-term] if both else [])]
        table = np.array(columns)
        size = np.sqrt(np.mean(table**2, axis=1))
        table = table[size > 0] / size[size > 0, None] * self._root
        reduced = np.linalg.qr(np.column_stack([table.T, self._target]), mode="r")
        _, left = nnls(reduced[:-1, :-1], reduced[:-1, -1])
        return float(left**2 + reduced[-1, -1] ** 2)


def _simplex(shape: Array) -> Array:
    """Where a search about a shape begins."""
    return np.vstack([shape, *(shape + 0.15 * step for step in np.eye(len(shape)))])


# ----------------------------------------------------------------------------------------------------- a driven mass


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
        x, v = (driven(law, self.command, self.test.rate, self.test.hold, self.substeps, name)[self.test.before :]
                for name in ("displacement", "velocity"))  # fmt: skip
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

    def d2(self, name: str = "", enough: float = ALIKE) -> float:
        """What the best fit with an effect leaves; further starts are tried until one is enough."""
        if name == "":
            return self.base[0]
        how, best = CANDIDATES[name], self.base[0]
        named = [f"{name}_{one}" for one in (how.strength, *(shape.name for shape in how.shapes))]
        if self.test.hidden == name:
            best = min(best, self._fit_from(self.test.law, named, how)[0])
        for starts in product(how.starts, *(shape.starts for shape in how.shapes)):
            if best <= enough:
                break
            sizes = [how.scale, *(shape.scale for shape in how.shapes)]
            begun = {one: start * self.scales[size] for one, start, size in zip(named, starts, sizes, strict=True)}
            best = min(best, self._fit_from(self.base[1]._replace(**begun), named, how)[0])
        return best

    def _fit_from(self, law: Law, named: Sequence[str], how: Candidate) -> tuple[float, Law]:
        lowest = 1.0 / (self.test.rate * self.substeps)  # a lag shorter than a step is none
        strength = _Axis(
            named[0], self.scales[how.scale], False,
            -how.upper if how.both else lowest / self.scales[how.scale] if named[0].endswith(("_T", "_Tn"))
            and not named[0].endswith("delay_T") else 0.0, how.upper,
        )  # fmt: skip
        axes = [
            _Axis(one, self.scales[s.scale], s.logarithmic, s.lower, s.upper)
            for one, s in zip(named[1:], how.shapes, strict=True)
        ]
        return self._fit(law, (strength, *axes))

    def _fit(self, law: Law, axes: Sequence[_Axis], factor: float = 1.0) -> tuple[float, Law]:
        """Least squares over the base's parameters and these axes from a law."""
        own = [_Axis(name, getattr(law, name), True, 1e-4, 1e4) for name in FREE[self.test.machine]]
        every = [*own, *axes]
        lower, upper = (np.array([axis.bound(side) for axis in every]) for side in ("lower", "upper"))
        start = np.array([axis.at(getattr(law, axis.name) * (factor if axis in own else 1.0)) for axis in every])
        start = np.clip(start, lower + 1e-9, upper - 1e-9)

        def law_of(point: Array) -> Law:
            return law._replace(**{axis.name: axis.value(p) for axis, p in zip(every, point, strict=True)})

        found = least_squares(
            lambda point: self.residual(law_of(point)), start, bounds=(lower, upper), x_scale="jac",
            max_nfev=_EVALUATIONS, ftol=1e-4, xtol=1e-7, diff_step=1e-5,
        )  # fmt: skip
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


# ------------------------------------------------------------------------------------------------ what a test allows


def fits(test: Test) -> Specimen | Driven:
    """The fits to a test's output without noise."""
    return Specimen(test) if test.machine == "specimen" else Driven(test)


@dataclass(frozen=True)
class Allowed:
    """What the reference decides of a test: d2 of the base alone ("") and of every effect."""

    d2: Mapping[str, float]
    samples: int

    @property
    def names(self) -> tuple[str, ...]:
        """The class."""
        return tuple(name for name, left in self.d2.items() if name and left <= ALIKE)

    @property
    def error(self) -> float:
        """That the base alone leaves, in floors."""
        return float(np.sqrt(1.0 + self.d2[""] / self.samples))

    @property
    def counts(self) -> str:
        """As what the test counts: "nothing", "hidden", or "dropped"."""
        if self.d2[""] <= ALIKE:
            return "nothing"
        shown = self.d2[""] >= SHOWN and self.error >= BEYOND and 0 < len(self.names) <= LARGEST
        return "hidden" if shown else "dropped"


def allowed(test: Test) -> Allowed:
    """The class of a test; where the base alone will do nothing more is fitted."""
    of = fits(test)
    d2 = {"": of.d2()}
    if d2[""] > ALIKE:
        d2 |= {name: of.d2(name) for name in APPLICABLE[test.machine]}
    return Allowed(d2, test.fitted)


# --------------------------------------------------------------------------------------------------- what is hidden

_MOST: dict[str, float] = {
    "coulomb_friction": 0.6, "presliding_friction": 0.6, "stribeck_friction": 0.6, "quadratic_damping": 3.0,
    "cubic_stiffness": 2.0, "specimen_hysteresis": 1.0, "specimen_free_play": 0.6, "end_stop": 30.0, "dead_zone": 0.6,
    "gain_asymmetry": 0.5, "backlash": 0.6,
}  # fmt: skip
"""The largest strength, in its scale: a machine that does not move tells nothing."""
_CLOSE = 0.1  # of the wanted excess
_TRIES = 8
_SHORT = 6  # periods by which a strength is set


def completed(seed: int, hidden: bool) -> Test:
    """A test by its seed, with the strength of what is hidden set so that the base leaves a drawn number of floors."""
    test = drawn(seed, hidden)
    if not hidden:
        return test
    wanted = float(np.exp(np.random.default_rng([52, seed]).uniform(*np.log(WORTH))))
    goal, most = np.sqrt(wanted**2 - 1.0), _MOST[test.hidden]
    scales = _sizes(replace(test, hidden="", periods=_SHORT))
    strength, tries = 0.1 * most, []
    for _ in range(_TRIES):
        found = hiding(test, strength, scales)
        short = replace(found, periods=_SHORT)
        excess = np.inf
        if np.all(np.isfinite(short.truth)) and short.sigma > 0:
            excess = float(np.sqrt(fits(short).d2() / short.fitted))
        tries.append((abs(np.log(max(excess, 1e-9) / goal)), strength))
        if abs(excess / goal - 1.0) < _CLOSE or (strength == most and excess < goal):
            break
        strength = float(min(most, strength * np.clip(goal / max(excess, 1e-9), 0.1, 8.0)))
    return hiding(test, min(tries)[1], scales)


def _sizes(test: Test) -> dict[str, float]:
    """What strengths and shapes are measured by."""
    if test.machine != "specimen":
        return Driven(test).scales
    x, v, a = (float(np.abs(one).max()) for one in test.motion(np.linspace(2, 3, 2000) / test.frequency))
    law = test.law
    force = law.c * v + law.k * x + law.m * a
    return {
        "way": x, "speed": v, "force": force, "force/way": force / x, "force/way^3": force / x**3,
        "force/speed^2": force / v**2,
    }  # fmt: skip


def hiding(test: Test, strength: float, scales: Mapping[str, float]) -> Test:
    """The test with what is hidden so strong, in its scale."""
    name, shapes = test.hidden, dict(test.shapes)
    if name == "specimen_free_play":
        return replace(test, free_play=strength * scales["way"])
    if name == "specimen_hysteresis":
        own = {"fy": strength * scales["force"], "xy": shapes["xy"] * scales["way"], "n": shapes["n"]}
        return replace(test, law=test.law._replace(**{f"{name}_{key}": value for key, value in own.items()}))
    how = CANDIDATES[name]
    sign = shapes.pop("sign", 1.0) * (0.2 if name == "cubic_stiffness" and test.shapes["sign"] < 0 else 1.0)
    values = {f"{name}_{how.strength}": sign * strength * scales[how.scale]}
    for shape in how.shapes:
        if shape.name in shapes:
            values[f"{name}_{shape.name}"] = shapes[shape.name] * scales[shape.scale]
    return replace(test, law=test.law._replace(**values))
