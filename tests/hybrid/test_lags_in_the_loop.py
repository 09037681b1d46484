"""Lags and delays of effects leave a hybrid simulation its poles, judged by a flat loop with the lags written out."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg

from ident.hybrid.controller import no_controller
from ident.hybrid.hybrid_simulation import simulate_hybrid
from ident.hybrid.machine import machine
from ident.hybrid.stability import spectral_radius
from tests.hybrid.cases import fitted, of_qian
from tests.reference.hybrid_reference import Actuator, Specimen, Structure, ramps, rods

FIT, RATE = fitted(), 4096.0


def radius(gain: float, feedback: float, recorder: float, delay: int) -> float:
    """The largest |z| of Qian's loop with a lag (s) of the transducer in the servo loop and one of the recorder.

    One sample of each unit state: rod (q, P, v, x), both lags, structure, last force, commands on their way.
    """
    rod, drive = rods(Actuator(), Specimen(), gain)
    A = np.zeros((6, 6))
    A[:4, :4] = rod
    A[0, 4], A[0, 3] = A[0, 3], 0.0  # the position loop has what the transducer shows
    A[4, 3], A[4, 4] = 1 / feedback, -1 / feedback
    A[5, 4], A[5, 5] = 1 / recorder, -1 / recorder
    held = scipy.linalg.expm(np.block([[A, np.vstack([drive, [[0.0], [0.0]]])], [np.zeros((1, 7))]]) / RATE)
    w, s = Structure(), Specimen()
    M = w.M - s.m
    numeric = np.array([[0.0, 1.0], [-(w.K - s.k) / M, -w.C / M]])
    phi, g0, g1 = ramps(numeric, np.array([[0.0], [-1 / M]]), 1 / RATE)
    after = []
    for state in np.eye(6 + 3 + delay):
        x, z, last, u = state[:6], state[6:8], state[8], state[9:]
        f = s.k * x[3] + s.m * (A[2] @ x)
        on = phi @ z + g0[:, 0] * f + g1[:, 0] * (2 * f - last)
        after.append([*(held[:6, :6] @ x + held[:6, 6] * u[0]), *on, f, *u[1:], z[0]])
    return float(np.abs(np.linalg.eigvals(np.array(after).T)).max())


@pytest.mark.full
@pytest.mark.parametrize(("gain", "feedback", "delay"), [(7.0, 2e-3, 1), (40.0, 8e-3, 4)])
def test_the_poles_of_a_loop_with_lags_are_those_of_the_flat_loop(gain, feedback, delay):
    """A lag of the transducer and one of the recorder, stable and not: the same largest pole, and no note."""
    case = of_qian(0.5, gain=gain, delay=delay)
    on = {"sensor_lag": feedback, "acquisition_lag": 1e-3}
    found = simulate_hybrid(FIT, case, None, on)
    assert found.radius == pytest.approx(radius(gain, feedback, 1e-3, delay), abs=1e-8)
    assert found.notes == ()
    assert found.stable == (found.radius < 1)
    assert (found.stability is None) == found.stable


def test_a_delay_of_the_command_turns_a_loop_as_so_many_samples_do():
    """Eight samples as an effect, and as samples of the case: the same largest pole within 1e-5."""
    case, none = of_qian(0.5, gain=20.0), no_controller(RATE)
    late = spectral_radius(machine(FIT, case, {"command_delay": 8 / RATE}), case, none)
    sampled = of_qian(0.5, gain=20.0, delay=9)
    assert late == pytest.approx(spectral_radius(machine(FIT, sampled), sampled, none), abs=1e-5)


def test_what_bends_has_no_poles_beside_a_lag():
    """A dead zone is not linear, a lag is; the note names the one alone."""
    found = simulate_hybrid(FIT, of_qian(0.2), None, {"sensor_lag": 1e-3, "dead_zone": 1e-5})
    assert found.radius is None
    assert any(note.endswith("poles judge no loop with dead_zone") for note in found.notes)
