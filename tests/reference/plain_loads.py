"""The effects of load and sensor as changes of the plain machine, written from the physics."""

# ruff: noqa: ARG002 - what one machine does not read of time and state, another one does

from __future__ import annotations

from math import exp

import numpy as np
from numpy.typing import NDArray

from tests.reference.plain_effects import clip, sgn
from tests.reference.plain_machine import KINKS, STICKING, STICKS, Case, Machine, State, Switch


class CoulombFriction(Machine):
    """Modes: 0 sticks, ±1 slides; it leaves a stop where the other forces are larger than friction at standstill."""

    case = Case({"Fc": (80, 80)}, STICKS, close=STICKING)
    longest = 1e-4

    def limit(self, s: State) -> float:
        return self.p.Fc

    def push(self, s: State) -> float:
        return self.plant.A * s[1] - self.resistance(s) - self.reaction(s)

    def acceleration(self, s: State) -> float:
        if not self.mode:
            return 0.0
        return (self.push(s) - self.mode * self.limit(s)) / (self.plant.m0 + self.cell.mass)

    def settle(self, t: float, s: NDArray[np.float64]) -> None:
        if abs(s[2]) > 1e-12:
            self.mode = int(sgn(s[2]))
            return
        s[2] = 0.0
        push = self.push(s)
        self.mode = int(sgn(push)) if abs(push) > self.limit(s) * (1 - 1e-9) else 0

    def switches(self) -> list[Switch]:
        if self.mode:
            return [(lambda _, s: s[2], -self.mode)]
        return [(lambda _, s: self.push(s) - self.limit(s), 1), (lambda _, s: self.push(s) + self.limit(s), -1)]


class StribeckFriction(CoulombFriction):
    case = Case({"dF": (80, 80), "vs": (5e-3, 2e-2)}, STICKS, 4e-4, close=STICKING)

    def limit(self, s: State) -> float:
        return self.p.dF * exp(-((s[2] / self.p.vs) ** 2))


class PreslidingFriction(Machine):
    case = Case({"Fd": (100, 100), "xs": (1e-5, 1e-4)}, KINKS)
    own = (1.0,)

    def resistance(self, s: State) -> float:
        return super().resistance(s) + self.p.Fd * s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        return [(s[2] - abs(s[2]) * s[4]) / self.p.xs]


class QuadraticDamping(Machine):
    case = Case({"c2": (1e4, 1e4)}, KINKS)

    def resistance(self, s: State) -> float:
        return super().resistance(s) + self.p.c2 * s[2] * abs(s[2])


class CubicStiffness(Machine):
    case = Case({"k3": (5e10, -2e10)})

    def reaction(self, s: State) -> float:
        return super().reaction(s) + self.p.k3 * s[3] ** 3


class SpecimenHysteresis(Machine):
    case = Case({"fy": (200, 200), "xy": (5e-4, 2e-4), "n": (1, 2), "gamma": (0.5, -0.7)}, KINKS)
    own = (1.0,)

    def reaction(self, s: State) -> float:
        return super().reaction(s) + self.p.fy * s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        yielding = self.p.gamma + 0.5 * sgn(s[2] * s[4])
        return [s[2] / self.p.xy * (1 - abs(s[4]) ** self.p.n * yielding)]


class SpecimenFreePlay(Machine):
    case = Case({"g": (5e-4, 5e-4)}, KINKS, share=0.25)

    def reaction(self, s: State) -> float:
        return self.cell.damping * s[2] + self.cell.stiffness * (s[3] - clip(s[3], -self.p.g, self.p.g))


class SpecimenJoint(Machine):
    """The specimen has its own position x2 and, where it has mass, speed v2; without mass it follows its damper."""

    case = Case({"s": (1e-5, 5e-6)})
    own = (1e-3, 1e-1)

    def joint(self, s: State) -> float:
        return (s[3] - s[4]) / self.p.s

    def acceleration(self, s: State) -> float:
        return (self.plant.A * s[1] - self.resistance(s) - self.joint(s)) / self.plant.m0

    def force(self, s: State) -> float:
        return self.joint(s)

    def own_rates(self, t: float, s: State) -> list[float]:
        spring = self.joint(s) - self.cell.stiffness * s[4]
        if self.cell.mass == 0:
            return [spring / self.cell.damping, 0.0]
        return [s[5], (spring - self.cell.damping * s[5]) / self.cell.mass]


class FrameCompliance(Machine):
    case = Case({"s": (5e-7, 5e-7)})

    def reading(self, t: float, s: State) -> float:
        return s[3] + self.p.s * self.force(s)


class StaticLoad(Machine):
    case = Case({"F0": (200, -200)})

    def resistance(self, s: State) -> float:
        return super().resistance(s) - self.p.F0


# Sensor ------------------------------------------------------------------------------------------------------------


class SensorLag(Machine):
    case = Case({"T": (1.5e-3, 1.5e-3)})
    own = (1e-3,)

    def reading(self, t: float, s: State) -> float:
        return s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        return [(s[3] - s[4]) / self.p.T]


class AcquisitionLag(Machine):
    case = Case({"T": (1.5e-3, 1.5e-3)})
    own = (1e-3,)

    def own_rates(self, t: float, s: State) -> list[float]:
        return [(s[3] - s[4]) / self.p.T]

    def recorded(self, t: float, s: State) -> float:
        return s[4]


class SensorGain(Machine):
    case = Case({"g": (0.05, -0.05)})

    def recorded(self, t: float, s: State) -> float:
        return s[3] * (1 + self.p.g)


# What was added to the catalogue later ------------------------------------------------------------------------------


class Vanishing(CoulombFriction):
    """Friction that may vanish: where nothing holds the rod it does not stick, and follows the command from rest."""

    def settle(self, t: float, s: NDArray[np.float64]) -> None:
        if abs(s[2]) < 1e-11:
            s[2] = 0.0
        super().settle(t, s)
        if not self.mode and self.limit(s) < 1e-9:
            self.mode = int(sgn(self.push(s)) or sgn(self.slope) or sgn(self.u0) or 1)

    def switches(self) -> list[Switch]:
        if self.mode:  # beyond zero: it begins there
            return [(lambda _, s: s[2] + 2e-12 * self.mode, -self.mode)]
        return super().switches()


class UnequalAreas(Vanishing):
    """The area A (1 + a sgn v) of flow and force: against the motion it holds the rod as dry friction does."""

    case = Case({"a": (0.2, -0.2)}, STICKS, share=0.4, close=STICKING)

    def limit(self, s: State) -> float:
        return max(-self.p.a * self.plant.A * s[1], 0.0)

    def rates(self, t: float, s: State) -> list[float]:
        rates = super().rates(t, s)
        rates[1] -= self.p.a * self.plant.A * abs(s[2]) / self.softness(s)
        return rates

    def acceleration(self, s: State) -> float:
        if not self.mode:
            return 0.0
        push = self.push(s) + self.mode * self.p.a * self.plant.A * s[1]
        return push / (self.plant.m0 + self.cell.mass)


class PositionFriction(Vanishing):
    case = Case({"Fx": (5e7, 5e7)}, STICKS, close=STICKING)

    def limit(self, s: State) -> float:
        return self.p.Fx * s[3] ** 2


class EndStop(Machine):
    case = Case({"g": (1e3, 1e3), "ks": (1e7, 3e6), "xm": (0.0, 2e-4)}, KINKS)

    def resistance(self, s: State) -> float:
        way = s[3] - self.p.xm
        return super().resistance(s) + self.p.ks * max(abs(way) - 1 / self.p.g, 0.0) * sgn(way)


class SensorNonlinearity(Machine):
    case = Case({"s": (2e3, -2e3)})

    def reading(self, t: float, s: State) -> float:
        return s[3] + self.p.s * s[3] ** 3
