"""Dampers moved by a sine, from equations of their own: what the searches of shapes are tried on.

The motion is given as a function of time and advanced in 64 steps a sample, so that a reversal between two samples is
met where it is. Every number of a trial is drawn by its seed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ident.matrix import Actuator, Matrix
from ident.run import Run

Array = NDArray[np.float64]
FINE = 64  # steps a sample


@dataclass(frozen=True)
class Damper:
    """A damper and a spring in parallel with Dahl's friction, SI; moved by a sine, its force recorded with noise."""

    damping: float = 700.0
    stiffness: float = 900.0
    friction: float = 45.0
    displacement: float = 1.5e-4
    amplitude: float = 0.03
    frequency: float = 0.8
    rate: float = 100.0
    noise: float = 0.02
    cycles: float = 8.0
    seed: int = 1

    def force(self) -> tuple[Array, Array]:
        """The speed and the force without noise, at the samples."""
        steps = int(self.cycles / self.frequency * self.rate) * FINE
        t = np.arange(steps + 1) / (self.rate * FINE)
        w = 2 * np.pi * self.frequency
        phase = np.random.default_rng([7, self.seed]).uniform(0, 2 * np.pi)
        x, v = self.amplitude * np.sin(w * t + phase), self.amplitude * w * np.cos(w * t + phase)
        z = self.rubbing(x, v)
        return v[::FINE], (self.damping * v + self.stiffness * (x - x[0]) + self.friction * z)[::FINE]

    def rubbing(self, x: Array, v: Array) -> Array:  # noqa: ARG002  Dahl's friction hangs on the way alone
        """The friction over its largest, along a way."""
        return dahl(x, self.displacement)

    def matrix(self) -> Matrix:
        """A run to fit and one to verify, one after the other of one test."""
        v, clean = self.force()
        rng = np.random.default_rng([8, self.seed])
        noisy = clean + self.noise * clean.std() * rng.standard_normal(len(clean))
        cut = 2 * len(v) // 3
        parts = {"fit": slice(0, cut), "verify": slice(cut, None)}
        units = {"velocity": "m/s", "force": "N"}
        return Matrix(
            Actuator("DAMPER"),
            tuple(
                Run(use, "", self.rate, {"velocity": v[part], "force": noisy[part]}, units, output="force", use=use)
                for use, part in parts.items()
            ),
        )


@dataclass(frozen=True)
class PlayedDamper(Damper):
    """The same with a slider behind a play and a spring: after each reversal it stands until the play is taken up.

    Its force then builds up over the way of the contact.
    """

    half_width: float = 4e-3
    contact: float = 1e-4

    def rubbing(self, x: Array, v: Array) -> Array:  # noqa: ARG002  what a slider carries hangs on the way alone
        """What the slider carries, over its friction."""
        place, reach, stretch = float(x[0]), self.half_width + self.contact, np.zeros(len(x))
        for i, here in enumerate(x.tolist()):
            place = min(max(place, here - reach), here + reach)
            stretch[i] = here - place
        return np.sign(stretch) * np.maximum(np.abs(stretch) - self.half_width, 0.0) / self.contact


def dahl(x: Array, displacement: float) -> Array:
    """z of z' = (v − |v| z)/xs along a way, exact from one step to the next, from z = 0."""
    z, moved = [0.0], np.diff(x)
    kept, towards = np.exp(-np.abs(moved) / displacement), np.sign(moved)
    for share, end in zip(kept.tolist(), towards.tolist(), strict=True):
        z.append(end + (z[-1] - end) * share)
    return np.array(z)
