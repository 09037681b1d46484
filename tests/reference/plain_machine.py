"""The actuator once more, written plainly for an adaptive integrator: the linear machine and its integration.

It judges the judge: SciPy's DOP853 at a tight tolerance, from kink to kink of the command. What switches (dry
friction, stiction, play) has a mode, and an event ends it. An effect overrides the lines that it changes. Nothing here
comes from the program or from the nonlinear reference. All quantities are SI.

    e = Kp (u - y)      tau q' = e - q      Q = Z0/A q      Ka P' = Q - Cl P - A v
    (m0 + mL) v' = A P - c0 v - (cL v + k x)      the sensor reads x
"""

# ruff: noqa: ARG002 - what one machine does not read of time and state, another one does

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from tests.reference.qian_reference import Cell, Plant

Samples = NDArray[np.float64]
State = Sequence[float] | NDArray[np.float64]
Switch = tuple[
    Callable[[float, State], float], int
]  # a function of (t, state) and the direction in which 0 ends a mode
RTOL = 1e-10
SCALE = (1e-2, 1e6, 1e-1, 1e-3)  # q (m), P (Pa), v (m/s), x (m)


class Kind(NamedTuple):
    """How exact the reference is, of each output's standard deviation, and by how much a step of a quarter is better.

    Kutta's third order gives 64 where the equations are smooth; kinks cost an order, jumps of a rate two. Below a
    hundredth of the error the place of a kink inside its step decides.
    """

    error: float
    gain: float


SMOOTH, KINKS, STICKS, CHATTERS = Kind(1e-7, 40), Kind(5e-6, 6), Kind(5e-5, 5), Kind(1e-3, 2)


CLOSE, STICKING = 1e-4, 1e-3
"""Of the output's standard deviation: what the program may be off the nonlinear reference; of friction that sticks."""


class Case(NamedTuple):
    """Values of an effect's parameters in the two runs, what kind it is, and the RMS of the command (m).

    The others are of the program's comparison with the nonlinear reference: the `share` of the largest strength at
    which it is made, less than 1 where that would leave little of the machine; what the program may be off, `close`;
    and the factor of the strength that the comparison has to notice, `seen`.
    """

    values: dict[str, tuple[float, float]]
    kind: Kind = SMOOTH
    rms: float = 1.27e-3
    share: float = 1.0
    close: float = CLOSE
    seen: float = 1.01


class Values:
    """Parameters by their letters."""

    def __init__(self, values: dict[str, float]) -> None:
        self.values = values

    def __getattr__(self, name: str) -> float:
        return self.values[name]


class Machine:
    """The linear chain; states q, P, v, x, then its `own`. Effects override the lines that they change."""

    case: Case  # at which an effect is judged
    own: tuple[float, ...] = ()  # the sizes of its own states, all 0 at the start
    longest = np.inf  # step of the integrator (s): where events come in pairs

    def __init__(self, plant: Plant, cell: Cell, values: dict[str, float]) -> None:
        self.plant, self.cell = plant, cell
        self.u0 = self.slope = self.t0 = 0.0
        self.mode = 0
        self.p = Values(values)

    def u(self, t: float) -> float:
        return self.u0 + self.slope * (t - self.t0)

    def reading(self, t: float, s: State) -> float:
        return s[3]

    def drive(self, t: float, s: State) -> float:
        return self.cell.gain * (self.u(t) - self.reading(t, s))

    def valve(self, t: float, s: State) -> float:
        return (self.drive(t, s) - s[0]) / self.plant.tau

    def opening(self, s: State) -> float:
        return s[0]

    def flow(self, w: float, s: State) -> float:
        return self.plant.Z0 / self.plant.A * w

    def leak(self, P: float) -> float:
        return self.plant.Cl * P

    def softness(self, s: State) -> float:
        return self.plant.Ka

    def resistance(self, s: State) -> float:
        return self.plant.c0 * s[2]

    def reaction(self, s: State) -> float:
        return self.cell.damping * s[2] + self.cell.stiffness * s[3]

    def acceleration(self, s: State) -> float:
        push = self.plant.A * s[1] - self.resistance(s) - self.reaction(s)
        return push / (self.plant.m0 + self.cell.mass)

    def force(self, s: State) -> float:
        return self.reaction(s) + self.cell.mass * self.acceleration(s)

    def own_rates(self, t: float, s: State) -> list[float]:
        return []

    def rates(self, t: float, s: State) -> list[float]:
        _, P, v, _, *_ = s
        Q = self.flow(self.opening(s), s)
        dP = (Q - self.leak(P) - self.plant.A * v) / self.softness(s)
        return [self.valve(t, s), dP, self.acceleration(s), v, *self.own_rates(t, s)]

    def recorded(self, t: float, s: State) -> float:
        return self.reading(t, s)

    # Pieces ----------------------------------------------------------------------------------------------------

    def breaks(self, samples: Samples) -> Samples:
        """Where the right-hand side may jump or bend in time, beside the samples."""
        return samples

    def command(self, samples: Samples, rate: float, hold: str, a: float, b: float) -> None:
        """Take the straight line that the command is between a and b."""
        middle = 0.5 * (a + b) - self.late()
        n = int(middle * rate)
        self.t0, self.u0, self.slope = n / rate + self.late(), float(samples[n]), 0.0
        if middle < 0:
            self.u0 = 0.0
        elif hold == "linear":
            self.slope = float(samples[n + 1] - samples[n]) * rate

    def late(self) -> float:
        return 0.0

    def jump(self, s: NDArray[np.float64], step: float) -> None:
        """Change the state where a held command jumps by `step`."""

    def remember(self, found: Any) -> None:
        """Keep a piece of the solution."""

    def settle(self, t: float, s: NDArray[np.float64]) -> None:
        """Choose the mode in which the next piece begins."""

    def switches(self) -> list[Switch]:
        """What ends the mode."""
        return []


def respond(machine: Machine, samples: Samples, rate: float, hold: str) -> NDArray[np.float64]:
    """Recorded displacement, force and load pressure, (3, n), from rest."""
    times = np.arange(len(samples)) / rate
    edges = np.unique(np.round(machine.breaks(times), 15))
    edges = edges[edges <= times[-1]]
    s, found, sample = np.zeros(4 + len(machine.own)), [], 0
    for a, b in pairwise(edges):
        before = machine.u(a)
        machine.command(samples, rate, hold, a, b)
        if a > 0:
            machine.jump(s, machine.u(a) - before)
        if a >= times[sample] - 1e-12:
            machine.settle(a, s)
            found.append([machine.recorded(a, s), machine.force(s), s[1]])
            sample += 1
        s = piece(machine, a, b, s)
    found.append([machine.recorded(times[-1], s), machine.force(s), s[1]])
    return np.array(found).T


def piece(machine: Machine, a: float, b: float, s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integrate from a to b, mode by mode."""
    for _ in range(50):
        machine.settle(a, s)
        ends = []
        for switch, direction in machine.switches():
            ends.append(_ends(switch, direction))
        step = min(machine.longest, b - a)
        found = solve_ivp(
            machine.rates,
            (a, b),
            s,
            "DOP853",
            events=ends,
            max_step=step,
            rtol=RTOL,
            atol=RTOL * np.array([*SCALE, *machine.own]),
            dense_output=True,
        )
        machine.remember(found.sol)
        a, s = float(found.t[-1]), found.y[:, -1]
        if found.status == 0:
            return s
    raise AssertionError(f"the mode changes without end at {a} s")


def _ends(switch: Callable[[float, State], float], direction: int) -> Any:
    def end(t: float, s: State) -> float:
        return switch(t, s)

    end.terminal, end.direction = True, direction  # type: ignore[attr-defined]
    return end
