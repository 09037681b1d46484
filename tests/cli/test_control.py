"""`servoident control`, as a user runs it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
import scipy.io

from tests.short_form import short_form

FIT = Path(__file__).resolve().parents[1] / "stored" / "fit.json"


@pytest.mark.parametrize("structure", short_form(["feedback", "two-degree"], "two-degree"))
def test_a_controller_is_designed_and_written(servoident, tmp_path, structure):
    """JSON, MAT, header and figure; the table says what the loop can stand, and what the design does not know."""
    out = tmp_path / "controller"
    done = servoident("control", FIT, "--case", "qian", "--structure", structure, "--out", out)
    assert done.returncode == 0, done.stderr
    data = json.loads((out / "controller.json").read_text())
    assert data["design"]["gamma"]["target"] == pytest.approx(2.737, abs=0.005)
    assert data["design"]["structure"] == structure
    assert data["design"]["margins"]["sensitivity_peak"] <= 2.0
    assert data["design"]["robustness"]["stable"] == 100
    assert len(data["A"]) == data["design"]["order"]["reduced"]
    assert scipy.io.loadmat(out / "controller.mat")["A"].tolist() == data["A"]
    assert f"#define SERVOIDENT_ORDER {len(data['A'])}\n" in (out / "controller.h").read_text()
    begin = {"svg": b"<svg", "png": b"\x89PNG", "pdf": b"%PDF", "json": b"{"}
    for kind, first in begin.items():
        assert (out / f"closed-loop.{kind}").read_bytes().startswith(first)
    assert "phase margin" in done.stdout
    assert "without dead_zone" in done.stdout


@pytest.mark.full
def test_a_target_of_a_file_is_used(servoident, tmp_path):
    """A slower target: a smaller bandwidth, under the name that the file gives it."""
    target = tmp_path / "target.yaml"
    target.write_text("name: slow\nnumerator: [2e5]\ndenominator: [0.008, 20, 65, 1200]\nroll_off: 300 1/s\n")
    target.write_text(target.read_text().replace("300 1/s", "2000 rad/s"))
    for name, options in (("own", ("--target", target)), ("paper", ())):
        done = servoident("control", FIT, "--case", "qian", *options, "--out", tmp_path / name)
        assert done.returncode == 0, done.stderr
    own, paper = (json.loads((tmp_path / name / "controller.json").read_text()) for name in ("own", "paper"))
    assert own["design"]["target"]["name"] == "slow"
    assert own["design"]["margins"]["bandwidth"] < paper["design"]["margins"]["bandwidth"]


def test_what_cannot_be_designed_for_is_refused_in_a_line(servoident, tmp_path):
    """No such case, no such target, an unknown structure, no fit: exit status 2, and no folder is left behind."""
    (tmp_path / "empty.json").write_text("{}")
    for arguments, said in (
        ((FIT, "--case", "nowhere"), "no case"),
        ((FIT, "--case", "qian", "--target", tmp_path / "none.yaml"), "does not exist"),
        ((FIT, "--case", "qian", "--structure", "three"), "no structure"),
        ((tmp_path / "empty.json", "--case", "qian"), "not the JSON of a fit"),
        ((FIT, "--case", "benchmark2020"), "piston_area"),
    ):
        done = servoident("control", *arguments, "--out", tmp_path / "out")
        assert done.returncode == 2, arguments
        assert said in done.stderr
        assert done.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_file_in_place_of_the_folder_is_told(servoident, tmp_path):
    """Exit status 2, and the file stays as it was."""
    file = tmp_path / "out"
    shutil.copy(FIT, file)
    done = servoident("control", FIT, "--case", "qian", "--out", file)
    assert done.returncode == 2
    assert file.read_bytes() == FIT.read_bytes()
