"""Where the motion of records reverses: the way, the speed and the force that tell how finely that is simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.parameter import AtReversals
from ident.run import KINEMATIC, Run
from ident.simulation.steps import steps_where_reversed

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Reversals:
    """What records tell of the reversals of their motion.

    `way` (m) is covered by the largest acceleration of any run in a sample at `rate` (Hz): that of a sine up to the
    band. `amplitude` (m) is that of the motion, 0 where it is not known.
    """

    way: float
    rate: float
    amplitude: float

    @classmethod
    def of(cls, runs: Sequence[Run], band: float, amplitude: float) -> Reversals:
        """What the runs tell, whose commands excite the `band` (rad/s)."""
        speeds = [
            (run.speed if "velocity" in run.channels else band * run.motion) / run.sample_rate**2
            for run in runs
            if not run.channels.keys().isdisjoint(KINEMATIC)
        ]
        way = float(np.sqrt(2.0) * band * max(speeds, default=0.0))
        return cls(way, min(run.sample_rate for run in runs), amplitude)

    def steps(self, of: AtReversals, size: Array, mass: Array | None, every: int) -> NDArray[np.int64]:
        """Steps for each `every` samples that a way, a speed or a force (v,) asks for; `mass` (kg), None is none."""
        rate = self.rate / every
        force = None if mass is None or self.amplitude <= 0 else mass * rate**2 * self.amplitude
        return steps_where_reversed(of, size, self.way * every**2, rate, force, every)
