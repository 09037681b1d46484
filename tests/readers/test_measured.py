"""Every measured folder that has a description reads, and holds what its publication says."""

from __future__ import annotations

import numpy as np
import pytest

from ident.readers import read_matrix


def test_every_measured_folder_reads(measured_data):
    folders = sorted(path.parent for path in measured_data.glob("*/matrix.yaml"))
    assert len(folders) >= 3
    for folder in folders:
        matrix = read_matrix(folder)
        assert {"fit"} <= {run.use for run in matrix.runs} <= {"fit", "verify"}
        assert all(samples.dtype == np.float64 for run in matrix.runs for samples in run.channels.values())


def test_raw_logs_with_ragged_rows_are_read_whole(measured_data):
    first, second = read_matrix(measured_data / "mts_actuator").runs
    assert (first.length, second.length) == (61500, 59100)
    assert first.command[:2] == pytest.approx([-0.0169e-2, -0.0167e-2], rel=1e-12)  # cm
    assert first.measured[-1] == pytest.approx(-0.0282e-2, rel=1e-12)
    assert first.channels["force"][0] == pytest.approx(-0.0166 * 9806.65, rel=1e-12)  # tonne-force


def test_a_time_column_of_a_matlab_file_gives_the_rate_and_a_scale_the_force(measured_data):
    matrix = read_matrix(measured_data / "emps")
    run = matrix.runs[0]
    assert (run.sample_rate, run.gaps, run.length) == (1000.0, 0, 24841)
    assert matrix.controller is not None
    assert (matrix.controller.kp, matrix.controller.kv) == (160.18, 243.45)
    assert run.units["drive_force"] == "N"
    assert 10 < run.channels["drive_force"].std() < 100


def test_records_in_unknown_units_keep_them(measured_data):
    first, second = read_matrix(measured_data / "crane_actuator").runs
    assert (first.sample_rate, first.time_unit, first.units["load_pressure"]) == (1.0, "sample", "1")
    assert (first.length, second.length) == (512, 512)
    assert first.output == "load_pressure"
    assert not np.array_equal(first.measured, second.measured)


def test_a_speed_may_be_in_turns_or_in_lengths_and_drive_or_be_driven(measured_data):
    motor, damper = (read_matrix(measured_data / name).runs[0] for name in ("dc_motor", "mr_damper"))
    assert motor.units["velocity"] == "rad/s"
    assert 10 < motor.measured.max() < 40  # 100 to 380 rpm
    assert damper.units == {"velocity": "m/s", "force": "N"}
    assert "command" not in damper.channels
