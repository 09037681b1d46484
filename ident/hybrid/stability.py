"""How late the physical part of a structure may answer, and whether a sampled loop around it is stable."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController
from ident.hybrid.coupled_case import System
from ident.hybrid.joint_machines import joint_machines
from ident.hybrid.machine import Machine
from ident.hybrid.substructure import numerical
from ident.run import Specimen

Array = NDArray[np.float64]
_REAL = 1e-6  # imaginary part of a frequency, over its magnitude, up to which it is a crossing


def critical_delay(case: Case) -> float | None:
    """The longest pure delay τ (s) of an otherwise perfect machine with which the hybrid simulation stays stable.

    The poles are the roots of det(M_n s² + C_n s + K_n + e eᵀ (m s² + c s + k) exp(−sτ)) = 0. They cross the imaginary
    axis where the loop L = (k − m ω² + jωc) eᵀ(K_n − M_n ω² + jωC_n)⁻¹ e has the magnitude 1; the least delay that
    turns it to −1 there is critical. 0 where the specimen has more mass than its storey leaves to the computer: then
    any delay is too long. None where none is.
    """
    specimen = case.physical
    if case.table is not None or not (specimen.mass or specimen.stiffness or specimen.damping):
        return None
    inertance = float(np.linalg.inv(case.numerical_mass)[case.place, case.place])
    if specimen.mass * inertance >= 1:
        return 0.0
    found = []
    for omega in _crossings(case):
        turned = -np.angle(-1.0 / _loop(case, omega))
        found.append(float((turned % (2 * np.pi)) / omega))
    return min(found, default=None)


def _loop(case: Case, omega: float) -> complex:
    of: Specimen = case.physical
    s = 1j * omega
    dynamic = case.numerical_mass * s**2 + case.numerical_damping * s + case.numerical_stiffness
    receptance = np.linalg.inv(dynamic)[case.place, case.place]
    return complex(receptance * (of.mass * s**2 + of.damping * s + of.stiffness))


def _crossings(case: Case) -> list[float]:
    """The frequencies (rad/s) at which the loop has the magnitude 1.

    |L|² = 1 are the imaginary roots of L(s) L(−s) = 1, the poles of a system in state space with L in feedback around
    its mirror image: roots of a polynomial of 4n degrees would lose digits.
    """
    A, B, C, D = _open_loop(case)
    n = len(A)
    # L(s) L(−s) − 1 = 0: zeros of 1 − L(s) L(−s), the poles of its inverse
    joint = np.block([[A, B @ -C], [np.zeros((n, n)), -A]])
    drive, read = np.concatenate([B * D, B]), np.concatenate([C, -D * C], axis=1)
    poles = scipy.linalg.eigvals(joint + drive @ read / (1 - D * D))
    real = np.abs(poles.real) <= _REAL * np.abs(poles)
    return sorted({float(abs(pole.imag)) for pole in poles[real] if abs(pole.imag) > 0})


def _open_loop(case: Case) -> tuple[Array, Array, Array, float]:
    """The loop L = e x(s)/f(s) (m s² + c s + k) in state space: x'' = M⁻¹(e − C x' − K x) of a unit force."""
    n, of = case.storeys, case.physical
    inverse, e = np.linalg.inv(case.numerical_mass), np.eye(n)[case.place]
    A = np.block(
        [[np.zeros((n, n)), np.eye(n)], [-inverse @ case.numerical_stiffness, -inverse @ case.numerical_damping]]
    )
    B = np.concatenate([np.zeros(n), inverse @ e])[:, None]
    position = np.concatenate([e, np.zeros(n)])
    speed, rate = position @ A, position @ A @ A
    C = of.stiffness * position + of.damping * speed + of.mass * rate
    return A, B, C[None], float(of.mass * (position @ A @ B)[0])


def spectral_radius(of: Machine, case: Case, controller: SampledController) -> float:
    """The largest magnitude of a pole of the whole sampled loop: stable below 1.

    Machine at small signals with held command, delay, controller and substructure, as :mod:`ident.hybrid.loop` runs
    them.
    """
    return float(np.abs(scipy.linalg.eigvals(closed_loop(of, case, controller)[0])).max())


_ONE = np.ones(1)


def closed_loop(
    of: Machine, case: Case, controller: SampledController, force: Array = _ONE, gain: Array = _ONE
) -> Array:
    """The transition matrix of the whole loop over a sample, (b, n, n): machine, substructure, controller, commands.

    The numerical part is given `force` (b,) times what the load cell reads; the servo loop has `gain` (b,) times Kp.
    """
    return coupled_loop((of,), case, (controller,), force, gain)


def coupled_loop(
    machines: Sequence[Machine],
    system: System,
    controllers: Sequence[SampledController],
    force: Array = _ONE,
    gain: Array = _ONE,
) -> Array:
    """As :func:`closed_loop`, of as many machines, each under its controller, as the system has parts.

    `force` and `gain` are (b,) for all parts, or (P, b) for each.
    """
    parts = range(len(machines))
    phi, drive, read, through = _held(machines, system, gain)
    part, delays = numerical(system), [case.delay for case in system.cases]
    orders = [one.order for one in controllers]
    sizes = (phi.shape[-1], len(part.phi), sum(orders), sum(delays), len(parts))
    s, z, x, held, before = (slice(b - a, b) for a, b in zip(sizes, np.cumsum(sizes), strict=True))
    own = [slice(x.start + sum(orders[:p]), x.start + sum(orders[: p + 1])) for p in parts]
    line = [slice(held.start + sum(delays[:p]), held.start + sum(delays[: p + 1])) for p in parts]
    first = [one.start for one in line]
    count = np.broadcast_shapes(force.shape[-1:], gain.shape[-1:])
    read_by = np.broadcast_to(force, (len(parts), force.shape[-1]))
    y, f, d = np.zeros((3, len(parts), *count, before.stop))  # of what is known at a sample
    for p in parts:
        y[p][:, s], y[p][:, first] = read[p], through[p]
        f[p][:, s], f[p][:, first] = read[len(parts) + p], through[len(parts) + p]
        f[p] *= read_by[p][:, None]
        d[p][:, z.start + part.places[p]] = 1.0
    system_matrix = np.zeros((*count, before.stop, before.stop))
    system_matrix[:, s, s], system_matrix[:, s, first] = phi, drive
    system_matrix[:, z, z] = part.phi
    for p, K in enumerate(controllers):
        system_matrix[:, z] += _outer(part.force0[p] + 2 * part.force1[p], f[p])
        system_matrix[:, z, before.start + p] -= part.force1[p]
        u = K.D[0, 0] * d[p] + K.D[0, 1] * y[p]
        u[:, own[p]] += K.C[0]
        system_matrix[:, own[p], own[p]] = K.A
        system_matrix[:, own[p]] += _outer(K.B[:, 0], d[p]) + _outer(K.B[:, 1], y[p])
        for i in range(line[p].start, line[p].stop - 1):
            system_matrix[:, i, i + 1] = 1.0
        system_matrix[:, line[p].stop - 1] = u
        system_matrix[:, before.start + p] = f[p]
    return system_matrix


def _outer(column: Array, rows: Array) -> Array:
    """column (n,) times each of the rows (b, m), (b, n, m)."""
    return column[:, None] * rows[:, None, :]


def _held(machines: Sequence[Machine], system: System, gain: Array) -> tuple[Array, Array, Array, Array]:
    """The machines from sample to sample under held commands, (b, n, n) and (b, n, P), and how y and f read them.

    Both (2P, b, n) and (2P, b, P): first the displacements, then the forces.
    """
    A, B, C, D = joint_machines(machines, system, gain)
    n, parts = B.shape[-2:]
    block = np.zeros((gain.shape[-1], n + parts, n + parts))
    block[:, :n, :n], block[:, :n, n:] = A, B
    found = scipy.linalg.expm(block / system.sample_rate)
    return found[:, :n, :n], found[:, :n, n:], np.moveaxis(C, 1, 0), np.moveaxis(D, 1, 0)
