"""The whole loop of a hybrid simulation as its stability is judged: machine, delay, controller, numerical part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController
from ident.hybrid.machine import Machine
from ident.hybrid.stability import closed_loop
from ident.run import Specimen
from ident.stability.judgement import Judgement, judge
from ident.stability.loop import DELAY, GAIN, SAMPLES, SHARE, Complex, LoopPart, parts_of

Array = NDArray[np.float64]
_SHARE, _DELAY, _GAIN, _FORCE = "share", "delay", "gain", "force"
_LEAST = 1e-12
"""Of a pole in the z-plane: a command on its way through the delay has poles at 0, whose logarithm is none."""


@dataclass(frozen=True, eq=False)
class HybridLoop:
    """A sampled loop of a machine, a case and a linear controller. It opens at the gain of the servo loop and at the
    measured force, by which the numerical part knows of the physical one."""

    machine: Machine
    case: Case
    controller: SampledController

    @cached_property
    def parts(self) -> tuple[LoopPart, ...]:
        """Gain, delay, the share of the structure that is physical, and the parameters of the machine."""
        return (
            LoopPart(_GAIN, GAIN, "gain of the servo loop", self.case.gain, "1"),
            LoopPart(
                _DELAY, DELAY, "delay from measurement to command", self.case.delay, SAMPLES, self.case.delay == 1
            ),
            LoopPart(_SHARE, SHARE, "physical part, of what the case states", 1.0, "1"),
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
        found = [self._poles(_one(factors, i), _one(gains, i)) for i in range(count)]
        most = max(map(len, found))
        z = np.array([[*one, *[0.0] * (most - len(one))] for one in found], complex)
        size = np.maximum(np.abs(z), _LEAST)
        return np.asarray((np.log(size) + 1j * np.angle(z)) * self.case.sample_rate)

    def _poles(self, factors: Mapping[str, float], gains: Mapping[str, float]) -> Complex:
        """The poles z of one loop."""
        case = self.case
        gain = case.gain * factors.get(_GAIN, 1.0) * gains.get(_GAIN, 1.0)
        delay = max(1, int(case.delay * factors.get(_DELAY, 1.0) + 1e-9))
        physical = _shared(case, factors.get(_SHARE, 1.0))
        changed = {p.in_equations: factors[p.name] for p in self.machine.parameters if p.name in factors}
        values = {name: value * changed.get(name, 1.0) for name, value in self.machine.values.items()}
        of, case = replace(self.machine, values=values), replace(case, gain=gain, delay=delay, physical=physical)
        loop = closed_loop(of, case, self.controller, gains.get(_FORCE, 1.0))
        return np.asarray(np.linalg.eigvals(loop), complex)


def _one(of: Mapping[str, Array], i: int) -> dict[str, float]:
    """The i-th of each."""
    return {name: float(values[i]) for name, values in of.items()}


def _shared(case: Case, share: float) -> Specimen:
    """The specimen times a share."""
    of = case.physical
    return replace(of, mass=share * of.mass, stiffness=share * of.stiffness, damping=share * of.damping)


def judge_hybrid(machine: Machine, case: Case, controller: SampledController) -> Judgement:
    """Whether the loop of a hybrid simulation is stable, and what would make it so."""
    return judge(HybridLoop(machine, case, controller))
