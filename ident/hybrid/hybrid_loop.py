"""The whole loop of a hybrid simulation as its stability is judged: machine, delay, controller, numerical part."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.fit.result import FitResult
from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController
from ident.hybrid.machine import Machine, machine
from ident.hybrid.stability import closed_loop
from ident.run import Specimen
from ident.stability.judgement import Judgement, judge
from ident.stability.loop import DELAY, GAIN, LOAD, SAMPLES, SHARE, SHORTEST, Complex, LoopPart, parts_of

Array = NDArray[np.float64]
_SHARE, _DELAY, _GAIN, _FORCE = "share", "delay", "gain", "force"
SPECIMEN = {"mass": "kg", "stiffness": "N/m", "damping": "N*s/m"}
_LEAST = 1e-12
"""Of a pole in the z-plane: a command on its way through the delay has poles at 0, whose logarithm is none."""


@dataclass(frozen=True)
class EarlierCase:
    """A case when its loop was stable, and the fit of its machine then."""

    fit: FitResult
    case: Case

    def with_gain(self, gain: float | None) -> EarlierCase:
        """The same at a gain Kp; as it is without one. Raises Unusable for one that is not above 0."""
        return self if gain is None else replace(self, case=replace(self.case, gain=gain))


@dataclass(frozen=True, eq=False)
class HybridLoop:
    """A sampled loop of a machine, a case and a linear controller. It opens at the gain of the servo loop and at the
    measured force, by which the numerical part knows of the physical one."""

    machine: Machine
    case: Case
    controller: SampledController

    @cached_property
    def parts(self) -> tuple[LoopPart, ...]:
        """Gain, delay, the share of the structure that is physical, the specimen, and the parameters of the machine."""
        specimen = self.case.physical
        return (
            LoopPart(_GAIN, GAIN, "gain of the servo loop", self.case.gain, "1"),
            LoopPart(
                _DELAY, DELAY, "delay from measurement to command", self.case.delay, SAMPLES, self.case.delay == 1
            ),
            LoopPart(_SHARE, SHARE, "physical part, of what the case states", 1.0, "1"),
            *(
                LoopPart(f"specimen {name}", LOAD, f"{name} of the specimen", getattr(specimen, name), unit, True)
                for name, unit in SPECIMEN.items()
            ),
            *parts_of(self.machine.parameters, self.machine.values),
        )

    @property
    def openings(self) -> tuple[str, ...]:
        """See :class:`ident.stability.loop.Loop`."""
        return (_GAIN, _FORCE)

    def poles(self, factors: Mapping[str, Array], gains: Mapping[str, Array]) -> Complex:
        """See :meth:`ident.stability.loop.Loop.poles`: s = ln(z) times the sample rate, of the poles z.

        Loops with fewer samples of delay have fewer poles; those that are not there are far to the left.
        """
        count = max(map(len, (*factors.values(), *gains.values())), default=1)
        if all(np.ptp(values) == 0 for values in factors.values()):
            z = self._poles(_one(factors, 0), {name: np.broadcast_to(given, count) for name, given in gains.items()})
        else:
            found = [self._poles(_one(factors, i), {n: g[i : i + 1] for n, g in gains.items()}) for i in range(count)]
            most = max(one.shape[-1] for one in found)
            z = np.concatenate([np.pad(one, ((0, 0), (0, most - one.shape[-1]))) for one in found])
        size = np.maximum(np.abs(z), _LEAST)
        return np.asarray((np.log(size) + 1j * np.angle(z)) * self.case.sample_rate, complex)

    def _poles(self, factors: Mapping[str, float], gains: Mapping[str, Array]) -> Complex:
        """The poles z (b, n) of one loop at gains times (b,)."""
        case = self.case
        gain = case.gain * factors.get(_GAIN, 1.0)
        delay = max(1, int(case.delay * factors.get(_DELAY, 1.0) + 1e-9))
        physical = _changed(case.physical, factors)
        changed = {p.in_equations: factors[p.name] for p in self.machine.parameters if p.name in factors}
        values = {name: value * changed.get(name, 1.0) for name, value in self.machine.values.items()}
        of, case = replace(self.machine, values=values), replace(case, gain=gain, delay=delay, physical=physical)
        one = np.ones(max(map(len, gains.values()), default=1))
        loop = closed_loop(of, case, self.controller, gains.get(_FORCE, one), gains.get(_GAIN, one))
        return np.asarray(np.linalg.eigvals(loop), complex)


def _one(of: Mapping[str, Array], i: int) -> dict[str, float]:
    """The i-th of each."""
    return {name: float(values[i]) for name, values in of.items()}


def _changed(of: Specimen, factors: Mapping[str, float]) -> Specimen:
    """The specimen times the share that is physical, and each of its quantities times its factor."""
    share = factors.get(_SHARE, 1.0)
    return Specimen(**{n: getattr(of, n) * share * factors.get(f"specimen {n}", 1.0) for n in SPECIMEN})


def judge_hybrid(
    of: Machine, case: Case, controller: SampledController, before: EarlierCase | None = None
) -> Judgement:
    """Whether the loop of a hybrid simulation is stable, what would make it so, and what made it unstable.

    The cause is sought where the case is known as it was `before`, when its loop was stable.
    """
    loop = HybridLoop(of, case, controller)
    if before is None:
        return judge(loop)
    earlier = HybridLoop(machine(before.fit, before.case), before.case, controller)
    return judge(loop, values_before(earlier.parts, loop.parts))


def values_before(earlier: Iterable[LoopPart], parts: Iterable[LoopPart]) -> dict[str, float]:
    """The values of the parts of a loop as they were, by name; off what the machine had not."""
    off = {part.name: SHORTEST if part.unit == "s" else 0.0 for part in parts}
    return {**off, **{part.name: part.value for part in earlier}}
