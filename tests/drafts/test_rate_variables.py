"""A sample rate that stands in a variable of the file, and units that stand there in words, are not asked for again."""

from __future__ import annotations

import io

import numpy as np
import pytest
from scipy.io import savemat

from ident.drafts.answers import Answer, Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from tests.readers.lab_files import lvm

T = 0.01 * np.arange(40)
SIGNALS = {"u": np.sin(3.0 * T), "y": np.sin(3.0 * T - 0.2)}


def mat(variables: dict[str, object]) -> bytes:
    """A MATLAB file of version 5."""
    file = io.BytesIO()
    savemat(file, variables)
    return file.getvalue()


def npz(variables: dict[str, object]) -> bytes:
    """A NumPy archive."""
    file = io.BytesIO()
    np.savez(file, **variables)
    return file.getvalue()


def h5(variables: dict[str, object]) -> bytes:
    """An HDF5 file."""
    import h5py

    file = io.BytesIO()
    with h5py.File(file, "w") as made:
        for name, value in variables.items():
            made[name] = value
    return file.getvalue()


KINDS = {"run.mat": mat, "run.npz": npz, "run.h5": h5}


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("stated", [{"Ts": 0.01}, {"dt": 0.01, "fs": 100.0}, {"Fs": 100}])
def test_a_variable_that_states_the_step_or_the_rate_is_the_clock_and_it_is_said(name, stated):
    """Ts in s and Fs in Hz, as MATLAB calls them."""
    file = read_raw(KINDS[name](SIGNALS | stated), name)
    draft = Draft([file], Answers())
    assert draft.known(file).rate == "100 Hz"
    assert any("100 Hz" in doubt and next(iter(stated)) in doubt and "assumed" in doubt for doubt in draft.doubts)
    assert not [one for one in draft.missing if one.key == "rate"]


@pytest.mark.parametrize(
    "stated", [{}, {"Ts": 0.01, "fs": 1000.0}, {"Ts": 0.0}, {"fs": -1.0}, {"dt": T}, {"Ts": "0.01"}]
)
def test_what_states_no_rate_or_two_leaves_it_to_be_said(stated):
    """Two that disagree, numbers that are no step, a column of steps, a text."""
    file = read_raw(mat(SIGNALS | stated), "run.mat")
    assert "rate" in [one.key for one in Draft([file], Answers()).missing]


def test_a_column_of_times_comes_before_a_variable_that_states_the_rate():
    file = read_raw(mat(SIGNALS | {"t": T, "Ts": 0.02}), "run.mat")
    known = Draft([file], Answers()).known(file)
    assert (known.time.column, known.rate) == ("t", "")


def test_a_labview_file_states_that_its_time_is_in_seconds_and_its_units_in_words():
    """X_Value of the dimension Time is in s; Pounds of a load cell are a force, Volts a voltage."""
    content = (
        lvm()
        .replace(b"Y_Unit_Label\tV\tmm", b"Y_Unit_Label\tVolts\tPounds")
        .replace(b"X_Value\tu\tx", b"X_Value\tcommand\tforce")
    )
    file = read_raw(content, "run.lvm")
    draft = Draft([file], Answers(serial="A1"))
    assert not draft.missing
    run = draft.known(file)
    assert (run.time.column, run.time.unit) == ("X_Value", "s")
    assert (run.channels["command"].unit, run.channels["force"].unit) == ("Volts", "Pounds")
    other = read_raw(content.replace(b"X_Dimension\tTime\tTime", b"X_Dimension\tFrequency\tFrequency"), "run.lvm")
    assert "unit time" in [one.key for one in Draft([other], Answers(serial="A1")).missing]


@pytest.mark.parametrize(
    ("head", "command"),
    [
        ("time_s,commanded_deg_s,angle_deg,feedback_deg_s", "commanded_deg_s"),
        ("time_s,velocity_setpoint_rad_s,velocity_rad_s", "velocity_setpoint_rad_s"),
        ("time_s,target_velocity_mm_s,target_position_mm,position_mm", "target_position_mm"),
    ],
)
def test_the_command_of_a_loop_of_speed_is_known_by_its_name(head, command):
    """A controller of a position logs both its targets: that of the position is the command."""
    names = head.split(",")
    rows = [",".join([f"{0.01 * n:g}", *(f"{np.sin(n + k):.6f}" for k in range(len(names) - 1))]) for n in range(40)]
    file = read_raw("\n".join([head, *rows, ""]).encode(), "log.csv")
    assert Draft([file], Answers()).known(file).channels["command"] == Answer(
        command, file.columns[names.index(command)].unit
    )


def test_a_record_with_times_is_brought_to_a_rate_that_is_stated_with_them():
    """A rate alone takes the place of the times, as before; a command line may state both."""
    text = "time,u,x\nms,mm,mm\n" + "".join(f"{10 * n},{n % 7},{n % 5}\n" for n in range(100))
    files, said = [read_raw(text.encode(), "a.csv")], {"command": Answer("u"), "displacement": Answer("x")}
    both = Draft(files, Answers("S", said, Answer("time", "ms"), rate="50 Hz"))
    assert both.description()["runs"][0]["time"] == {"column": "time", "unit": "ms", "resample": "50 Hz"}
    assert "sample_rate" not in both.description()["runs"][0]
    alone = Draft(files, Answers("S", said, rate="50 Hz"))
    assert alone.description()["runs"][0]["sample_rate"] == "50 Hz"
