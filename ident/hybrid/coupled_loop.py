"""The whole loop of several actuators as its stability is judged, and what of their dials would make it stable."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.hybrid.controller import SampledController
from ident.hybrid.coupled_case import CoupledCase, Part
from ident.hybrid.machine import Machine
from ident.hybrid.stability import coupled_loop
from ident.run import Specimen
from ident.stability.loop import DELAY, GAIN, SAMPLES, SHARE, Complex, LoopPart

Array = NDArray[np.float64]
_SHARE = "share"
_LEAST = 1e-12
"""Of a pole in the z-plane: a command on its way through the delay has poles at 0, whose logarithm is none."""


@dataclass(frozen=True, eq=False)
class CoupledLoop:
    """A sampled loop of machines with linear controllers on one structure.

    It opens at the gain of each servo loop and at each measured force. Its parts are what a laboratory sets: the gain
    and the delay of each actuator, and the share of the structure that is physical.
    """

    machines: Sequence[Machine]
    case: CoupledCase
    controllers: Sequence[SampledController]

    @cached_property
    def parts(self) -> tuple[LoopPart, ...]:
        """Gain and delay of each actuator, and the share."""
        gains = (
            LoopPart(_gain(one), GAIN, f"gain of the servo loop of {one.name}", one.case.gain, "1")
            for one in self.case.parts
        )
        delays = (
            LoopPart(_delay(one), DELAY, f"delay of {one.name}", one.case.delay, SAMPLES, one.case.delay == 1)
            for one in self.case.parts
        )
        return (*gains, *delays, LoopPart(_SHARE, SHARE, "physical part, of what the case states", 1.0, "1"))

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
        return np.asarray((np.log(size) + 1j * np.angle(found)) * self.case.sample_rate)

    def _poles(self, factors: Mapping[str, float], gains: Mapping[str, Array], count: int) -> Complex:
        """The poles z (count, n) of one loop at gains times (count,)."""
        one = np.ones(count)
        force, gain = (
            np.array([one * gains.get(name(part), 1.0) for part in self.case.parts]) for name in (_force, _gain)
        )
        changed = _changed(self.case, factors)
        return np.asarray(
            np.linalg.eigvals(coupled_loop(self.machines, changed, self.controllers, force, gain)), complex
        )


def _gain(of: Part) -> str:
    return f"{of.name}.Kp"


def _delay(of: Part) -> str:
    return f"{of.name}.delay"


def _force(of: Part) -> str:
    return f"{of.name}.force"


def _changed(of: CoupledCase, factors: Mapping[str, float]) -> CoupledCase:
    """The case with delays and the physical share times their factors."""
    share, parts = factors.get(_SHARE, 1.0), []
    for part in of.parts:
        case, whole = part.case, part.case.physical
        delay = max(1, int(case.delay * factors.get(_delay(part), 1.0) + 1e-9))
        physical = Specimen(share * whole.mass, share * whole.stiffness, share * whole.damping)
        parts.append(replace(part, case=replace(case, delay=delay, physical=physical)))
    return replace(of, parts=tuple(parts), specimen=share * of.specimen)
