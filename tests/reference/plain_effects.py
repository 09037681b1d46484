"""The effects from controller to pressure as changes of the plain machine, written from the physics.

A class has the name of its effect, and the letters of the catalogue, in `self.p`. Its `case` has the values at which
the harness judges the effect (test_nonlinear_reference.py).
"""

# ruff: noqa: ARG002 - what one machine does not read of time and state, another one does

from __future__ import annotations

from math import copysign, pi, sin, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.reference.plain_machine import CHATTERS, KINKS, STICKING, Case, Machine, Samples, State, Switch
from tests.reference.qian_reference import Cell, Plant


def sgn(value: float) -> float:
    return float(value > 0) - float(value < 0)


def clip(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


# Controller --------------------------------------------------------------------------------------------------------


class CommandDelay(Machine):
    case = Case({"T": (1.7e-3, 3e-3)}, KINKS)

    def late(self) -> float:
        return self.p.T

    def breaks(self, samples: Samples) -> Samples:
        return np.concatenate([samples, samples + self.p.T])


class CommandLimit(Machine):
    case = Case({"a": (150, 150)}, KINKS, share=0.5)

    def drive(self, t: float, s: State) -> float:
        return clip(super().drive(t, s), -1 / self.p.a, 1 / self.p.a)


class IntegralAction(Machine):
    case = Case({"Ki": (30, 30)})
    own = (1e-5,)

    def drive(self, t: float, s: State) -> float:
        return super().drive(t, s) + self.cell.gain * self.p.Ki * s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        return [self.u(t) - s[3]]


class Lead(Machine):
    case = Case({"Td": (2e-3, 2e-3)})

    def drive(self, t: float, s: State) -> float:
        return super().drive(t, s) + self.cell.gain * self.p.Td * (self.slope - s[2])

    def jump(self, s: NDArray[np.float64], step: float) -> None:
        s[0] += self.cell.gain * self.p.Td * step / self.plant.tau


class PressureFeedback(Machine):
    case = Case({"kd": (5e-10, 5e-10)})

    def drive(self, t: float, s: State) -> float:
        return super().drive(t, s) - self.p.kd * s[1]


class LoopDelay(Machine):
    """Method of steps: no piece is longer than the delay, so that what it needs is already known."""

    case = Case({"T": (1.2e-3, 2.1e-3)})

    def __init__(self, plant: Plant, cell: Cell, values: dict[str, float]) -> None:
        super().__init__(plant, cell, values)
        self.past: list[Any] = []

    def breaks(self, samples: Samples) -> Samples:
        return np.concatenate([samples, samples + self.p.T])

    def remember(self, found: Any) -> None:
        self.past = [*self.past[-3:], found]

    def drive(self, t: float, s: State) -> float:
        then = t - self.p.T
        known = next((past for past in reversed(self.past) if past.t_min <= then), None)
        return self.cell.gain * (self.u(t) - (0.0 if known is None else float(known(then)[3])))


# Valve -------------------------------------------------------------------------------------------------------------


class ValveSecondOrder(Machine):
    case = Case({"Tn": (1.5e-3, 1.5e-3), "zeta": (0.7, 0.4)})
    own = (1e-2, 10.0)

    def opening(self, s: State) -> float:
        return s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        return [s[5], (s[0] - s[4] - 2 * self.p.zeta * self.p.Tn * s[5]) / self.p.Tn**2]


class ValveRateLimit(Machine):
    case = Case({"a": (0.5, 0.5)})

    def valve(self, t: float, s: State) -> float:
        wanted = super().valve(t, s)
        return wanted / sqrt(1 + (self.p.a * wanted) ** 2)


class SpoolStiction(Machine):
    """Modes: 0 stands, ±1 moves, ±2 is dragged along at the edge of the threshold where e moves slower than s/tau."""

    case = Case({"s": (3e-4, 3e-4)}, CHATTERS, 1e-4, close=STICKING, seen=1.5)
    longest = 1e-4

    def gap(self, t: float, s: State) -> float:
        return self.drive(t, s) - s[0]

    def pull(self, s: State) -> float:
        return self.cell.gain * (self.slope - s[2])  # e'

    def valve(self, t: float, s: State) -> float:
        if abs(self.mode) == 2:
            return self.pull(s)
        return self.gap(t, s) / self.plant.tau if self.mode else 0.0

    def settle(self, t: float, s: NDArray[np.float64]) -> None:
        gap = self.gap(t, s)
        side, beyond = int(copysign(1, gap)), abs(gap) / self.p.s - 1
        if abs(beyond) > 1e-7:
            self.mode = side if beyond > 0 else 0
        else:
            speed = side * self.pull(s) * self.plant.tau / self.p.s
            self.mode = side if speed > 1 - 1e-9 else (2 * side if speed > 1e-9 else 0)

    def switches(self) -> list[Switch]:
        side = copysign(1, self.mode)
        if abs(self.mode) == 2:
            return [
                (lambda _, s: side * self.pull(s), -1),
                (lambda _, s: side * self.pull(s) - self.p.s / self.plant.tau, 1),
            ]
        if self.mode:
            return [(lambda t, s: side * self.gap(t, s) - self.p.s, -1)]
        return [(lambda t, s: self.gap(t, s) - self.p.s, 1), (lambda t, s: self.gap(t, s) + self.p.s, -1)]


# Spool -------------------------------------------------------------------------------------------------------------


class Backlash(Machine):
    """Modes: ±1 one side pushes, 0 inside the play; its own state is the part behind the play."""

    case = Case({"b": (5e-4, 5e-4)}, KINKS)
    own = (1e-2,)
    longest = 1e-4

    def opening(self, s: State) -> float:
        return s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        return [self.valve(t, s) if self.mode else 0.0]

    def settle(self, t: float, s: NDArray[np.float64]) -> None:
        side = int(copysign(1, s[0] - s[4]))
        touches = side * (s[0] - s[4]) > self.p.b * (1 - 1e-7)
        self.mode = side if touches and side * self.valve(t, s) > 1e-9 else 0

    def switches(self) -> list[Switch]:
        if self.mode:
            return [(self.valve, -self.mode)]
        return [(lambda _, s: s[0] - s[4] - self.p.b, 1), (lambda _, s: s[0] - s[4] + self.p.b, -1)]


class NullBias(Machine):
    case = Case({"b": (1e-3, -1e-3)})

    def opening(self, s: State) -> float:
        return s[0] + self.p.b


class DeadZone(Machine):
    case = Case({"h": (5e-4, 5e-4), "a": (0.0, 0.4)}, KINKS)

    def opening(self, s: State) -> float:
        return s[0] - clip(s[0], -self.p.h * (1 - self.p.a), self.p.h * (1 + self.p.a))


class Underlap(Machine):
    case = Case({"h": (5e-4, 5e-4)}, KINKS)

    def opening(self, s: State) -> float:
        return s[0] + clip(s[0], -self.p.h, self.p.h)


class GainAsymmetry(Machine):
    case = Case({"a": (0.2, -0.2)}, KINKS)

    def opening(self, s: State) -> float:
        return s[0] * (1 + self.p.a * sgn(s[0]))


class FlowSaturation(Machine):
    case = Case({"a": (150, 150)})

    def opening(self, s: State) -> float:
        return s[0] / sqrt(1 + (self.p.a * s[0]) ** 2)


# Flow and pressure -------------------------------------------------------------------------------------------------


class PressureFlow(Machine):
    case = Case({"r": (3e-7, 3e-7)}, KINKS)

    def flow(self, w: float, s: State) -> float:
        return super().flow(w, s) * sqrt(max(0.0, 1 - sgn(w) * s[1] * self.p.r))


class SupplyDroop(Machine):
    case = Case({"d": (5e3, 5e3), "T": (0.1, 0.02)}, KINKS)
    own = (1e-5,)

    def flow(self, w: float, s: State) -> float:
        return super().flow(w, s) * (1 - self.p.d * s[4])

    def own_rates(self, t: float, s: State) -> list[float]:
        return [(abs(self.flow(self.opening(s), s)) - s[4]) / self.p.T]


class OrificeLeakage(Machine):
    case = Case({"C": (5e-9, 5e-9), "P0": (5e4, 3e5)})

    def leak(self, P: float) -> float:
        return super().leak(P) + self.p.C * P / sqrt(sqrt(P**2 + self.p.P0**2))


class EntrainedAir(Machine):
    case = Case({"alpha": (2, 2), "Pr": (2e6, 5e5)})

    def softness(self, s: State) -> float:
        return self.plant.Ka * (1 + self.p.alpha / (1 + (s[1] / self.p.Pr) ** 2))


class StrokeDependentVolume(Machine):
    case = Case({"kappa": (2e4, 2e4)}, close=2e-6, seen=1.1)

    def softness(self, s: State) -> float:
        return self.plant.Ka * (1 - self.p.kappa * s[3] ** 2)


# What was added to the catalogue later ------------------------------------------------------------------------------


class FlowForce(Machine):
    case = Case({"f": (3e-7, 3e-7)}, KINKS)

    def drive(self, t: float, s: State) -> float:
        return super().drive(t, s) - self.p.f * s[0] * abs(s[1])


class PressureDependentGain(Machine):
    case = Case({"g": (3e-7, -3e-7)}, KINKS, share=0.5)

    def flow(self, w: float, s: State) -> float:
        return super().flow(w, s) * (1 + self.p.g * abs(s[1]))


class SupplyRipple(Machine):
    case = Case({"r": (0.2, 0.2), "f": (25.0, 41.0), "phi": (0.0, 1.0)})
    now = 0.0

    def rates(self, t: float, s: State) -> list[float]:
        self.now = t
        return super().rates(t, s)

    def flow(self, w: float, s: State) -> float:
        return super().flow(w, s) * (1 + self.p.r * sin(2 * pi * self.p.f * self.now + self.p.phi))


class OneWayLeakage(Machine):
    case = Case({"c": (1e-11, -1e-11)}, KINKS)

    def leak(self, P: float) -> float:
        return super().leak(P) + self.p.c * abs(P)
