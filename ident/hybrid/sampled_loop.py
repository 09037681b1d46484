"""A sampled controller around a plant: is it stable, what does it make of the wanted displacement, how near is it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.cached import cached_property
from ident.hybrid.controller import SampledController
from ident.hybrid.state_space import StateSpace, sampled_plant
from ident.linear import LinearModel
from ident.stability.mode import Mode

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class SampledLoop:
    """The plant command → displacement, without a batch, its command held and `delay` samples late."""

    plant: LinearModel
    controller: SampledController
    delay: float

    @cached_property
    def sampled(self) -> StateSpace:
        """The plant as the controller sees it."""
        return sampled_plant(self.plant, self.controller.sample_rate, self.delay)

    @cached_property
    def poles(self) -> Complex:
        """The poles z of the closed loop, (n,)."""
        P, K = self.sampled, self.controller
        b, d = K.B[:, 1:], K.D[:, 1:]
        loop = 1.0 / (1.0 - d @ P.D)  # both pass something on at once only where there is no delay
        system = np.block(
            [
                [P.A + P.B @ loop @ d @ P.C, P.B @ loop @ K.C],
                [b @ (P.C + P.D @ loop @ d @ P.C), K.A + b @ P.D @ loop @ K.C],
            ]
        )
        return np.asarray(np.linalg.eigvals(system), complex)

    @property
    def spectral_radius(self) -> float:
        """The largest magnitude of a pole of the closed loop."""
        return float(np.abs(self.poles).max(initial=0.0))

    @property
    def mode(self) -> Mode:
        """The mode that grows fastest, or dies out last: s = ln(z) times the sample rate."""
        leading = self.poles[np.argmax(np.abs(self.poles))]
        return Mode.of(complex(np.log(leading) * self.controller.sample_rate))

    @property
    def stable(self) -> bool:
        """Whether every pole of the closed loop lies in the unit circle."""
        return self.spectral_radius < 1.0

    def points(self, frequency: Array) -> Complex:
        """z = e^{jω/f} at `frequency` (Hz)."""
        return np.asarray(np.exp(2j * np.pi * np.asarray(frequency) / self.controller.sample_rate))

    def open_loop(self, frequency: Array) -> Complex:
        """L = −P K_y at `frequency` (Hz), (f,), closed by negative feedback."""
        z = self.points(frequency)
        return -self.sampled.response(z)[:, 0, 0] * channels(self.controller, z)[:, 1]

    def sensitivity(self, frequency: Array) -> Complex:
        """S = 1/(1 + L) at `frequency` (Hz), (f,)."""
        return np.asarray(1.0 / (1.0 + self.open_loop(frequency)))

    def response(self, frequency: Array) -> Complex:
        """T = P K_d/(1 + L), wanted → measured displacement, at `frequency` (Hz), (f,)."""
        z = self.points(frequency)
        plant, by = self.sampled.response(z)[:, 0, 0], channels(self.controller, z)
        return np.asarray(plant * by[:, 0] / (1.0 - plant * by[:, 1]))

    def noise_gain(self) -> float:
        """RMS of the command over that of white noise of the displacement's sensor, about standstill."""
        frequency = (np.arange(_NOISE) + 0.5) / _NOISE * self.controller.sample_rate / 2
        by_noise = channels(self.controller, self.points(frequency))[:, 1] * self.sensitivity(frequency)
        return float(np.sqrt(np.mean(np.abs(by_noise) ** 2)))


_NOISE = 4096  # points between standstill and half the sample rate


def channels(controller: SampledController, z: Complex) -> Complex:
    """K_d and K_y of a controller at the points z (f,), shape (f, 2)."""
    return controller.response(z)[:, 0, :]
