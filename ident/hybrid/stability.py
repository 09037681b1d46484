"""How late the physical part of a structure may answer, and whether a sampled loop around it is stable."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from ident.hybrid.case import Case
from ident.hybrid.controller import SampledController
from ident.hybrid.machine import DISPLACEMENT, FORCE, Machine
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
    if not (specimen.mass or specimen.stiffness or specimen.damping):
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
    phi, drive, read, through = _held(of, case, gain)
    part, delay = numerical(case), case.delay
    sizes = (phi.shape[-1], len(part.phi), controller.order, delay, 1)
    at = np.cumsum((0, *sizes))
    s, z, x, held, before = (slice(at[i], at[i + 1]) for i in range(5))
    count = np.broadcast_shapes(force.shape, gain.shape)
    row = np.zeros((3, *count, at[-1]))  # y, f and d of what is known at a sample
    row[:2, :, s], row[:2, :, held.start] = read, through
    row[1] *= force[:, None]
    row[2, :, z.start + part.place] = 1.0
    u = controller.D[0, 0] * row[2] + controller.D[0, 1] * row[0]
    u[:, x] += controller.C[0]
    system = np.zeros((*count, at[-1], at[-1]))
    system[:, s, s], system[:, s, held.start] = phi, drive
    system[:, z, z] = part.phi
    system[:, z] += _outer(part.force0 + 2 * part.force1, row[1])
    system[:, z, before.start] -= part.force1
    system[:, x, x] = controller.A
    system[:, x] += _outer(controller.B[:, 0], row[2]) + _outer(controller.B[:, 1], row[0])
    for i in range(delay - 1):
        system[:, held.start + i, held.start + i + 1] = 1.0
    system[:, held.stop - 1] = u
    system[:, before.start] = row[1]
    return system


def _outer(column: Array, rows: Array) -> Array:
    """column (n,) times each of the rows (b, m), (b, n, m)."""
    return column[:, None] * rows[:, None, :]


def _held(of: Machine, case: Case, gain: Array) -> tuple[Array, Array, Array, Array]:
    """The machine from sample to sample under a held command, (b, n, n) and (b, n), and how y and f read it."""
    known = of.at(case)
    values: dict[str, Any] = {name: known[name] for name in of.chain.symbols}
    values["Kp"] = known.get("Kp", 1.0) * gain
    models = [of.chain.linearise(values, channel) for channel in (DISPLACEMENT, FORCE)]
    A, B, n = models[0].A, models[0].B, models[0].A.shape[-1]
    system = np.zeros((len(gain), n + 1, n + 1))
    system[:, :n, :n], system[:, :n, n] = A, B
    found = scipy.linalg.expm(system / case.sample_rate)
    read, through = np.array([model.C for model in models]), np.array([model.D for model in models])
    return found[:, :n, :n], found[:, :n, n], read, through
