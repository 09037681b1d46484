"""The flat reference of the fifth-order actuator against what must hold of it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import odeint

from tests.reference import strano_reference as reference

MACHINE = reference.Machine()


def test_half_the_step_gives_the_same():
    r = reference.motion(2.0)
    coarse, fine = (reference.respond(MACHINE, r, gain=60.0, fine=n) for n in (reference.FINE, 2 * reference.FINE))
    for name, most in (("displacement", 1e-5), ("spool", 1e-5), ("load_pressure", 2e-3)):
        a, b = getattr(coarse, name), getattr(fine, name)
        assert np.std(a - b) < most * np.std(b), name


def test_without_dry_friction_it_is_the_equations_by_scipy():
    """No sticking, so that an integrator of SciPy can follow the same equations, with the command as straight lines."""
    machine = MACHINE._replace(Fc=0.0, mu=0.0)
    r = reference.motion(1.0)
    t = np.arange(len(r)) / reference.RATE

    def rates(now, state):
        ve, dve, P, v, y = state
        u = 60.0 * (np.interp(now, t, r) - y)
        vc = machine.ve0 + (machine.kep if u >= 0 else machine.ken) * u
        opening = machine.kqp * max(ve - machine.vep, 0.0) + machine.kqn * min(ve - machine.ven, 0.0)
        Q = opening * np.sqrt(reference.SUPPLY - np.sign(opening) * P)
        bend = machine.wn**2 * (vc - ve) - 2 * machine.xi * machine.wn * dve
        force = reference.AREA * P - machine.sigma * v
        return [dve, bend, (Q - reference.AREA * v) / machine.C, force / machine.m, v]

    found = odeint(rates, [machine.ve0, 0, 0, 0, 0], t, tfirst=True, rtol=1e-9, atol=1e-12, hmax=1e-3).T
    ours = reference.respond(machine, r, gain=60.0)
    assert ours.displacement == pytest.approx(found[4], abs=3e-6)
    assert np.std(ours.load_pressure - found[2]) < 3e-3 * np.std(found[2])


def test_the_table_sticks_below_the_friction():
    """A voltage whose flow builds up less than the breakaway pressure moves nothing, and a larger one does."""
    command = np.zeros(400)
    assert not np.any(reference.respond(MACHINE, command, vertical=1e5).displacement)
    command[50:] = 1.2
    moved = reference.respond(MACHINE, command, vertical=1e5)
    breakaway = (MACHINE.Fc + MACHINE.mu * 1e5) / reference.AREA
    still = moved.load_pressure < breakaway
    first = int(np.flatnonzero(~still)[0])
    assert not np.any(moved.displacement[:first]), "it moves before the friction is overcome"
    assert moved.displacement[-1] > 1e-3
