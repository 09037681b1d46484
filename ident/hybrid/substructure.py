"""The numerical part of a hybrid simulation, integrated exactly from sample to sample, and the whole structure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.hybrid.case import Case
from ident.hybrid.coupled_case import System
from ident.simulation.jit import jit

Array = NDArray[np.float64]
_STEEP = 8.0
"""Exponent of the filter that takes off what is below the band of a table: 0.03 dB at twice its lowest frequency."""


@dataclass(frozen=True, eq=False)
class Substructure:
    """M_n x'' + C_n x' + K_n x = −M ι a(t) − Σ e_p f_p(t) from sample to sample, z = [x, x'].

    z(k+1) = Φ z(k) + Σ (F0_p f_p(k) + F1_p f̂_p(k+1)) + G0 a(k) + G1 a(k+1), exact for straight lines between samples;
    the forces of the next sample are not measured yet, and f̂(k+1) = 2 f(k) − f(k−1) goes on as it came. The force of
    the ground acts on the whole mass: the specimen stands still against the ground where the structure does, so its
    load cell knows nothing of it. Φ (2n, 2n), forces (P, 2n), ground (2n,); e_p picks the storey `places[p]`.
    """

    phi: Array
    force0: Array
    force1: Array
    ground0: Array
    ground1: Array
    places: tuple[int, ...]

    @property
    def drives(self) -> Array:
        """What drives it, (2P + 2, 2n): of each f_p(k) and f̂_p(k+1), then of a(k) and a(k+1)."""
        forces = [one for both in zip(self.force0, self.force1, strict=True) for one in both]
        return np.array([*forces, self.ground0, self.ground1])


def numerical(of: System) -> Substructure:
    """The part that is left to the computer; a table moves as the samples that drive it say."""
    if isinstance(of, Case) and of.table is not None:
        still, given = np.zeros((1, 2)), np.array([1.0, 0.0])
        return Substructure(np.zeros((2, 2)), still, still, np.zeros(2), given, of.places)
    return _sampled(of, of.numerical_mass, of.numerical_damping, of.numerical_stiffness)


def reference(case: Case, ground: Array) -> Array:
    """The displacement (m) of the storey where the specimen stands, of the whole structure, (n,): what should come out.

    Exact at the samples for a ground acceleration (n,) that is a straight line between them. Of a table the
    displacement that is wanted.
    """
    if case.table is not None:
        return wanted_of(case, ground)
    whole = _sampled(case, case.mass, case.damping, case.stiffness)
    return np.asarray(_recursion(whole.phi, whole.ground0, whole.ground1, ground, case.place))


def wanted_of(case: Case, record: Array) -> Array:
    """The displacement (m) of a table whose acceleration is that of a record (m/s²) in its band, both (n,).

    D(ω) = −H(ω) A(ω)/ω²: see :mod:`ident.hybrid.shaking_table`. The ends are faded to rest.
    """
    assert case.table is not None
    lowest, highest = case.table
    frequency = np.fft.rfftfreq(len(record), 1 / case.sample_rate)
    steady = np.maximum(frequency, frequency[1])
    gain = 1.0 / (1.0 + (lowest / steady) ** _STEEP) / (2 * np.pi * steady) ** 2
    fall = np.clip((frequency / highest - 1.0) / 0.5, 0.0, 1.0)
    gain = np.where(frequency > 0, gain * 0.5 * (1 + np.cos(np.pi * fall)), 0.0)
    found = np.fft.irfft(-gain * np.fft.rfft(record), len(record))
    fade = max(1, min(round(case.ground.rest * case.sample_rate / 2), len(record) // 4))
    rise = 0.5 * (1 - np.cos(np.pi * np.arange(fade) / fade))
    found[:fade] *= rise
    found[-fade:] *= rise[::-1]
    return np.asarray(found)


def driven_by(case: Case, ground: Array) -> Array:
    """What drives the loop of a case, (n,): the acceleration of the ground; of a table the displacement wanted."""
    return ground if case.table is None else wanted_of(case, ground)


@jit(nogil=True)
def _recursion(phi: Array, now: Array, then: Array, drive: Array, place: int) -> Array:
    out, z = np.zeros(len(drive)), np.zeros(len(phi))
    for k in range(1, len(drive)):
        on = now * drive[k - 1] + then * drive[k]
        for i in range(len(z)):
            for j in range(len(z)):
                on[i] += phi[i, j] * z[j]
        z = on
        out[k] = z[place]
    return out


def _sampled(of: System, mass: Array, damping: Array, stiffness: Array) -> Substructure:
    n, parts = of.storeys, len(of.places)
    inverse, period, drives = np.linalg.inv(mass), 1.0 / of.sample_rate, parts + 1
    pushed = np.zeros((n, drives))
    pushed[of.places, range(parts)] = -1.0
    pushed[:, parts] = -of.mass @ of.influence
    # A ramp over one sample, and a constant, drive the system: one exponential holds both responses.
    system = np.zeros((2 * n + 2 * drives, 2 * n + 2 * drives))
    system[:n, n : 2 * n] = np.eye(n)
    system[n : 2 * n, :n], system[n : 2 * n, n : 2 * n] = -inverse @ stiffness, -inverse @ damping
    system[n : 2 * n, 2 * n : 2 * n + drives] = inverse @ pushed
    system[2 * n : 2 * n + drives, 2 * n + drives :] = np.eye(drives) / period
    found = scipy.linalg.expm(system * period)[: 2 * n]
    constant, ramp = found[:, 2 * n : 2 * n + drives], found[:, 2 * n + drives :]
    first = (constant - ramp).T
    return Substructure(found[:, : 2 * n], first[:-1], ramp.T[:-1], first[-1], ramp[:, -1], of.places)
