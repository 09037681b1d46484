"""The whole loop of several actuators as its stability is judged, and what of their dials would make it stable."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.hybrid.controller import SampledController
from ident.hybrid.coupled_case import QUANTITIES, CoupledCase, Part, System
from ident.hybrid.hybrid_loop import SPECIMEN, values_before
from ident.hybrid.machine import Machine
from ident.hybrid.stability import coupled_loop
from ident.run import Specimen
from ident.stability.judgement import Judgement, judge
from ident.stability.loop import DELAY, GAIN, LOAD, SAMPLES, SHARE, Complex, LoopPart, parts_of

Array = NDArray[np.float64]
_SHARE = "share"
_ONE = np.ones(1)
_LEAST = 1e-12
"""Of a pole in the z-plane: a command on its way through the delay has poles at 0, whose logarithm is none."""


@dataclass(frozen=True)
class EarlierParts:
    """A case of several actuators when its loop was stable, and the fit of the machine of each part then."""

    fits: Sequence[FitResult]
    case: CoupledCase

    def with_gain(self, gain: float | None) -> EarlierParts:
        """The same with a gain Kp of every part; as it is without one. Raises Unusable for one that is not above 0."""
        return self if gain is None else replace(self, case=self.case.changed(gain=gain))

    @classmethod
    def stated(
        cls,
        fits: Sequence[FitResult],
        case: CoupledCase,
        then: System | None,
        fit: FitResult | None,
        find: Callable[[str], FitResult],
    ) -> EarlierParts:
        """The case `then` and the `fit` of its machines; what is left out is that of the `case` and its `fits` now.

        A part that names a fit has that one, which `find` finds. Raises Unusable where the parts are others.
        """
        was, now = case if then is None else then, dict(zip((one.name for one in case.parts), fits, strict=True))
        if not isinstance(was, CoupledCase) or {one.name for one in was.parts} != now.keys():
            raise Unusable("bad-case", "the case before has other parts", "before case", f"name them {', '.join(now)}")

        def earlier(part: Part) -> FitResult:
            if part.fit:
                return now[part.name] if then is None else find(part.fit)
            return now[part.name] if fit is None else fit

        return cls(tuple(map(earlier, was.parts)), was)


@dataclass(frozen=True, eq=False)
class CoupledLoop:
    """A sampled loop of machines with linear controllers on one structure.

    It opens at the gain of each servo loop and at each measured force. Its parts are what a laboratory sets: the gain
    and the delay of each actuator, and the share of the structure that is physical. Specimens and parameters of the
    machines may be causes, but no remedy changes them: with each the judgement would take as long again.
    """

    machines: Sequence[Machine]
    case: CoupledCase
    controllers: Sequence[SampledController]

    @cached_property
    def parts(self) -> tuple[LoopPart, ...]:
        """Gain and delay of each actuator, and the share; specimen and parameters of each."""
        gains = (
            LoopPart(_gain(one), GAIN, f"gain of the servo loop of {one.name}", one.case.gain, "1")
            for one in self.case.parts
        )
        delays = (
            LoopPart(_delay(one), DELAY, f"delay of {one.name}", one.case.delay, SAMPLES, one.case.delay == 1)
            for one in self.case.parts
        )
        share = LoopPart(_SHARE, SHARE, "physical part, of what the case states", 1.0, "1")
        given = (
            replace(one, name=_of(part, one.name), meaning=f"{one.meaning} of {part.name}", fixed=True)
            for part, machine in zip(self.case.parts, self.machines, strict=True)
            for one in (*_specimen(part), *parts_of(machine.parameters, machine.values))
        )
        return (*gains, *delays, share, *given)

    @property
    def openings(self) -> tuple[str, ...]:
        """See :class:`ident.stability.loop.Loop`."""
        return (*map(_gain, self.case.parts), *map(_force, self.case.parts))

    def poles(self, factors: Mapping[str, Array], gains: Mapping[str, Array]) -> Complex:
        """See :meth:`ident.stability.loop.Loop.poles`: s = ln(z) times the sample rate, of the poles z.

        A gain is a part and an opening: its factors are those of the opening, which are worked out all at once.
        """
        count = max(map(len, (*factors.values(), *gains.values())), default=1)
        turned = {name: factors[name] * gains.get(name, 1.0) for name in factors if name in self.openings}
        rest = {name: values for name, values in factors.items() if name not in turned}
        gains = {**gains, **turned}
        if all(np.ptp(values) == 0 for values in rest.values()):
            found = self._poles({name: float(values[0]) for name, values in rest.items()}, gains, count)
        else:
            rows = [
                self._poles({n: float(f[i]) for n, f in rest.items()}, {n: g[i : i + 1] for n, g in gains.items()}, 1)
                for i in range(count)
            ]
            most = max(one.shape[-1] for one in rows)
            found = np.concatenate([np.pad(one, ((0, 0), (0, most - one.shape[-1]))) for one in rows])
        size = np.maximum(np.abs(found), _LEAST)
        return np.asarray((np.log(size) + 1j * np.angle(found)) * self.case.sample_rate, complex)

    def _poles(self, factors: Mapping[str, float], gains: Mapping[str, Array], count: int) -> Complex:
        """The poles z (count, n) of one loop at gains times (count,)."""
        force, gain = (
            np.array(np.broadcast_arrays(*(gains.get(name(part), _ONE) for part in self.case.parts)))
            for name in (_force, _gain)
        )
        changed = _changed(self.case, factors)
        machines = [_other(of, part, factors) for of, part in zip(self.machines, self.case.parts, strict=True)]
        found = np.asarray(np.linalg.eigvals(coupled_loop(machines, changed, self.controllers, force, gain)), complex)
        return np.broadcast_to(found, (count, found.shape[-1]))


def judge_coupled(loop: CoupledLoop, before: CoupledLoop | None = None) -> Judgement:
    """Whether a loop is stable, what would make it so, and what made it unstable since `before`, when it was stable."""
    return judge(loop, None if before is None else values_before(before.parts, loop.parts))


def _specimen(of: Part) -> tuple[LoopPart, ...]:
    """What the actuator of a part moves."""
    return tuple(
        LoopPart(f"specimen {name}", LOAD, f"{name} of the specimen", getattr(of.case.physical, name), unit)
        for name, unit in SPECIMEN.items()
    )


def _other(of: Machine, part: Part, factors: Mapping[str, float]) -> Machine:
    """The machine of a part with its parameters times their factors."""
    changed = {p.in_equations: factors[_of(part, p.name)] for p in of.parameters if _of(part, p.name) in factors}
    return replace(of, values={**of.values, **{name: of.values[name] * by for name, by in changed.items()}})


def _of(part: Part, name: str) -> str:
    """A quantity of a part as the user calls it."""
    return f"{part.name}.{name}"


def _gain(of: Part) -> str:
    return _of(of, "Kp")


def _delay(of: Part) -> str:
    return _of(of, "delay")


def _force(of: Part) -> str:
    return _of(of, "force")


def _changed(of: CoupledCase, factors: Mapping[str, float]) -> CoupledCase:
    """The case with delays, specimens and the physical share times their factors."""
    if not factors:
        return of
    share, parts, specimen = factors.get(_SHARE, 1.0), [], factors.get(_SHARE, 1.0) * of.specimen
    for number, part in enumerate(of.parts):
        delay = max(1, int(part.case.delay * factors.get(_delay(part), 1.0) + 1e-9))
        by = {name: share * factors.get(_of(part, f"specimen {name}"), 1.0) for name in QUANTITIES}
        physical = Specimen(**{name: getattr(part.case.physical, name) * by[name] for name in QUANTITIES})
        specimen[:, number, number] = [getattr(physical, name) for name in QUANTITIES]
        parts.append(replace(part, case=replace(part.case, delay=delay, physical=physical)))
    return replace(of, parts=tuple(parts), specimen=specimen)
