"""`servoident export`, as a user runs it."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
import scipy.io

FIT = Path(__file__).resolve().parents[1] / "stored" / "fit.json"


def test_a_machine_is_written_with_what_it_moves_and_its_gain(servoident, tmp_path):
    """The header states the specimen, the gain and the rate that were given."""
    out = tmp_path / "machine.h"
    given = ("--gain", 7, "--specimen", "mass=0.87 kg, stiffness=36.3 kN/m", "--sample-rate", "2048 Hz")
    done = servoident("export", FIT, "--format", "c", "--out", out, *given)
    assert done.returncode == 0, done.stderr
    text = out.read_text()
    for line in ("#define SERVOIDENT_SAMPLE_RATE 2048.0 ", " *   Kp = 7\n", " *   mL = 0.87\n", " *   k = 36300\n"):
        assert line in text
    assert "command in, displacement, load_pressure, force, acceleration out, at 2048 Hz" in done.stdout


def test_the_state_space_says_what_it_leaves_out(servoident, tmp_path):
    out = tmp_path / "machine.mat"
    done = servoident("export", FIT, "--format", "mat", "--out", out)
    assert done.returncode == 0, done.stderr
    assert scipy.io.loadmat(io.BytesIO(out.read_bytes()))["B"].shape[1] == 1
    assert "without dead_zone" in done.stdout


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--format", "dll"), "choose from c, mat, fmu"),
        (("--format", "c", "--gain", -1), "gain is -1"),
        (("--format", "c", "--sample-rate", "4096"), "--sample-rate"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(servoident, tmp_path, options, said):
    done = servoident("export", FIT, "--out", tmp_path / "machine", *options)
    assert done.returncode == 2
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "machine").exists()
