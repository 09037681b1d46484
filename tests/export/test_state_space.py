"""The linear part of a machine as matrices, beside the kernel."""

from __future__ import annotations

import io

import numpy as np
import scipy.io
import scipy.signal

from ident.export import as_control, as_mat, exported, linear_part
from ident.export.machine import ExportedMachine
from tests.export.machines import RATE, SPECIMEN, command, fitted, largest_error, simulated, with_effects


def finely(machine: ExportedMachine) -> ExportedMachine:
    """The same machine, integrated without an error that counts."""
    return ExportedMachine(machine.preset, machine.values, machine.sample_rate, 32)


def answered(A, B, C, D, u):
    """The channels' answer to a held command, by SciPy's own discretisation."""
    _, y, _ = scipy.signal.dlsim(scipy.signal.cont2discrete((A, B, C, D), 1 / RATE, "zoh"), u)
    return y


def test_the_mat_file_is_the_machine_where_that_is_linear():
    """MATLAB's own format, read by SciPy and sampled by it: the kernel's answer of every channel to 1e-6."""
    machine, u = with_effects(), command()
    held = scipy.io.loadmat(io.BytesIO(as_mat(machine)))
    found = answered(held["A"], held["B"], held["C"], held["D"], u)
    names = ["displacement", "load_pressure", "force", "acceleration"]
    assert [str(name[0][0]) for name in held["OutputName"]] == names
    assert [str(name[0][0]) for name in held["OutputUnit"]] == ["m", "Pa", "N", "m/s^2"]
    assert held["Ts"].item() == 1 / RATE
    for i, channel in enumerate(machine.outputs):
        assert largest_error(found[:, i], simulated(finely(machine), channel, u)) <= 1e-6


def test_linear_effects_are_states_and_the_others_are_named():
    """A lag of the sensor is in the matrices; the dead zone of a fit is not, and the file says so."""
    machine, u = with_effects("sensor_lag"), command()
    part = linear_part(machine)
    assert not part.left_out
    found = answered(part.A, part.B, part.C, part.D, u)
    assert largest_error(found[:, 0], simulated(finely(machine), "displacement", u)) <= 1e-6
    held = scipy.io.loadmat(io.BytesIO(as_mat(exported(fitted(), SPECIMEN))))
    assert [str(name[0][0]) for name in held["LeftOut"]] == ["dead_zone"]


def test_python_control_has_the_same_response_under_the_names_of_the_channels():
    """Command to displacement at 10 Hz, as the matrices give it by hand."""
    machine = with_effects()
    system, part = as_control(machine), linear_part(machine)
    assert system.input_labels == ["command"]
    assert system.output_labels == list(machine.outputs)
    s = 2j * np.pi * 10.0
    by_hand = part.C @ np.linalg.solve(s * np.eye(len(part.A)) - part.A, part.B) + part.D
    np.testing.assert_allclose(system(s), by_hand, rtol=1e-9)
