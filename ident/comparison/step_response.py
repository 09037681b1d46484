"""The step response of a fitted model under the conditions of a run, and what is read off it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ident.chain.chain import linear_model, settles
from ident.chain.conditions import zeros
from ident.comparison.compare import Simulator, compare, fitted, modelled
from ident.errors import Unusable
from ident.fit.result import FitResult
from ident.matrix import Actuator, Matrix
from ident.run import Run

Array = NDArray[np.float64]
_SAMPLES = 2000
_BEFORE = 1 / 20  # of the record is at rest
_SLOWEST = 8.0  # time constants of the slowest pole: all of a linear response
_SHOWN = 2.5  # of the settling time: the last sample is then the final value
_WITHIN = 0.02  # of the final value: settled
_RISE = (0.1, 0.9)  # of the final value


@dataclass(frozen=True)
class StepResponse:
    """The output (n,) over time (n,), the step of `size` at t = 0; both in the units of the run.

    `rise` (s) is from 10 to 90 % of the final value, `overshoot` a fraction of it, `settling` (s) until it stays within
    2 % of it.
    """

    time: Array
    output: Array
    size: float

    @property
    def final(self) -> float:
        """The output that it ends at."""
        return float(self.output[-1])

    @property
    def rise(self) -> float:
        """Rise time, s."""
        low, high = (self._reaches(share) for share in _RISE)
        return high - low

    @property
    def overshoot(self) -> float:
        """By how much it goes beyond the final value, a fraction of that."""
        return max(0.0, float((self.output / self.final).max()) - 1.0)

    @property
    def settling(self) -> float:
        """Settling time, s."""
        outside = np.flatnonzero(np.abs(self.output / self.final - 1.0) > _WITHIN)
        after = outside[self.time[outside] >= 0]
        return float(self.time[min(after[-1] + 1, len(self.time) - 1)]) if len(after) else 0.0

    def _reaches(self, share: float) -> float:
        """When the output first reaches a share of its final value, on a straight line between two samples."""
        relative = self.output / self.final
        at = int(np.argmax(relative >= share))
        if at == 0:
            return float(self.time[0])
        before, after = relative[at - 1 : at + 1]
        step = self.time[at] - self.time[at - 1]
        return float(self.time[at - 1] + step * (share - before) / (after - before))


def step_response(
    fit: FitResult, run: Run, actuator: Actuator, size: float, seconds: float, simulator: Simulator = modelled
) -> StepResponse:
    """The response to a step of the command of `size`, from rest, followed for so long.

    A model with effects is simulated: its response depends on the size. Raises Unusable for a machine without a
    command, and where the model ends nowhere.
    """
    rate = _SAMPLES / (seconds * (1 + _BEFORE))
    time = (np.arange(_SAMPLES) - round(_BEFORE * _SAMPLES)) / rate
    command = np.where(time >= 0, size, 0.0)
    channels = {"command": command, run.output: np.zeros(_SAMPLES)}
    probe = replace(run, channels=channels, sample_rate=rate, hold="zoh", assumed_beginning="at rest", past=None)
    (found,) = compare(Matrix(actuator, (probe,)), fit, simulator).runs
    response = StepResponse(time, found.modelled, size)
    if not np.isfinite(found.modelled).all() or not response.final:
        raise Unusable("cannot-draw", "the model does not settle after a step", "step response", "see the time record")
    return response


def duration(fit: FitResult, run: Run, actuator: Actuator) -> float:
    """How long a step is followed, s: 2.5 settling times of the linearised machine.

    Raises Unusable for a machine that has no command, or does not settle.
    """
    if "command" not in run.channels:
        what = "the machine is moved by what was recorded, not by a command"
        raise Unusable("cannot-draw", what, "step response", "see the time record")
    preset, matrix, values = fitted(fit, Matrix(actuator, (run,)))
    if preset.core.memories or not settles(preset.core, values, matrix.runs[0], actuator):
        what = "the machine does not settle: it integrates its command, or is unstable"
        raise Unusable("cannot-draw", what, "step response", "see the time record")
    seen = preset.core.observed(run.output, zeros(run, actuator))
    model = linear_model(preset.core, values, matrix.runs[0], actuator).of_states(seen)
    poles = np.linalg.eigvals(model.A[0])
    whole = _SLOWEST / float(np.abs(poles.real).min())
    linear = replace(fit, effects=(), parameters={n: p for n, p in fit.parameters.items() if "." not in n})
    settling = step_response(linear, run, actuator, 1.0, whole).settling
    return _SHOWN * max(settling, 1.0 / float(np.abs(poles).max()))
