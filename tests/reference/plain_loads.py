"""The effects of load and sensor as changes of the plain machine, written from the physics."""

# ruff: noqa: ARG002 - what one machine does not read of time and state, another one does

from __future__ import annotations

from math import exp

import numpy as np
from numpy.typing import NDArray

from tests.reference.plain_effects import clip, sgn
from tests.reference.plain_machine import Machine, State, Switch


class CoulombFriction(Machine):
    """Modes: 0 sticks, ±1 slides; it leaves a stop where the other forces are larger than friction at standstill."""

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
    def limit(self, s: State) -> float:
        return self.p.dF * exp(-((s[2] / self.p.vs) ** 2))


class PreslidingFriction(Machine):
    own = (1.0,)

    def resistance(self, s: State) -> float:
        return super().resistance(s) + self.p.Fd * s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        return [(s[2] - abs(s[2]) * s[4]) / self.p.xs]


class QuadraticDamping(Machine):
    def resistance(self, s: State) -> float:
        return super().resistance(s) + self.p.c2 * s[2] * abs(s[2])


class CubicStiffness(Machine):
    def reaction(self, s: State) -> float:
        return super().reaction(s) + self.p.k3 * s[3] ** 3


class SpecimenHysteresis(Machine):
    own = (1.0,)

    def reaction(self, s: State) -> float:
        return super().reaction(s) + self.p.fy * s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        yielding = self.p.gamma + 0.5 * sgn(s[2] * s[4])
        return [s[2] / self.p.xy * (1 - abs(s[4]) ** self.p.n * yielding)]


class SpecimenFreePlay(Machine):
    def reaction(self, s: State) -> float:
        return self.cell.damping * s[2] + self.cell.stiffness * (s[3] - clip(s[3], -self.p.g, self.p.g))


class SpecimenJoint(Machine):
    """The specimen has its own position x2 and, where it has mass, speed v2; without mass it follows its damper."""

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
    def reading(self, t: float, s: State) -> float:
        return s[3] + self.p.s * self.force(s)


class StaticLoad(Machine):
    def resistance(self, s: State) -> float:
        return super().resistance(s) - self.p.F0


# Sensor ------------------------------------------------------------------------------------------------------------


class SensorLag(Machine):
    own = (1e-3,)

    def reading(self, t: float, s: State) -> float:
        return s[4]

    def own_rates(self, t: float, s: State) -> list[float]:
        return [(s[3] - s[4]) / self.p.T]


class AcquisitionLag(Machine):
    own = (1e-3,)

    def own_rates(self, t: float, s: State) -> list[float]:
        return [(s[3] - s[4]) / self.p.T]

    def recorded(self, t: float, s: State) -> float:
        return s[4]


class SensorGain(Machine):
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
    def limit(self, s: State) -> float:
        return self.p.Fx * s[3] ** 2


class EndStop(Machine):
    def resistance(self, s: State) -> float:
        way = s[3] - self.p.xm
        return super().resistance(s) + self.p.ks * max(abs(way) - 1 / self.p.g, 0.0) * sgn(way)


class SensorNonlinearity(Machine):
    def reading(self, t: float, s: State) -> float:
        return s[3] + self.p.s * s[3] ** 3
