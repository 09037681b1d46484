"""A run in which the machine stands still is set apart: its relative error is noise, a thousand times another's."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from ident.preprocessing import screen
from ident.preprocessing.run_exclusion import still_apart
from ident.readers import from_arrays, read_matrix
from ident.run import Run
from ident.workflows import compare, identify

RATE = 100.0


def run(name: str, size: float, drive: float = 1.0, use: str = "fit", output: str = "displacement") -> Run:
    """A record whose command and output have these amplitudes."""
    wave = np.sin(np.arange(400) / 7.0)
    channels = {"command": drive * wave, output: size * wave}
    return Run(name, "", RATE, channels, {"command": "V", output: "m"}, output=output, use=use)


def uses(*runs: Run) -> list[str]:
    return [one.use for one in still_apart(runs)[0]]


def test_what_does_next_to_nothing_beside_others_is_neither_fitted_nor_verified():
    runs = (run("a", 1.0), run("b", 0.8), run("c", 0.005), run("d", 0.005, use="verify"))
    assert uses(*runs) == ["fit", "fit", "still", "still"]
    _, said = still_apart(runs)
    assert len(said) == 2
    assert said[0].startswith("run c stands still: its displacement has 0.")


@pytest.mark.parametrize(
    "runs",
    [
        (run("a", 1.0), run("b", 0.03), run("c", 1.0)),  # little, but no nothing
        (run("a", 1.0), run("b", 0.005, drive=0.05), run("c", 1.0)),  # asked for next to nothing
        (run("a", 0.005), run("b", 0.004)),  # all alike
        (run("a", 1.0), run("b", 0.005, output="force"), run("c", 1.0)),  # of another output
        (run("a", 0.005), run("b", 1.0, use="verify"), run("c", 1.0, use="verify")),  # nothing else to fit
    ],
)
def test_all_others_stay_as_they_are(runs):
    assert uses(*runs) == [one.use for one in runs]
    assert still_apart(runs)[1] == ()


def bench(folder: Path) -> Path:
    """A cylinder of 0.4 m/s for 1 V behind a dead zone of 0.3 V, driven to and fro at four sizes, noise of 0.1 mm."""
    folder.mkdir(exist_ok=True)
    random = np.random.default_rng(8)
    lines = ["actuator: {serial: DZ}", "runs:"]
    for number, size in enumerate((1.0, 0.8, 0.25, 0.6)):
        t = np.arange(int(6 * RATE)) / RATE
        u = size * np.sign(np.sin(2 * np.pi * t / 2.0)) * (t > 0.2)
        opened = np.sign(u) * np.maximum(np.abs(u) - 0.3, 0.0)
        x, speed = np.zeros(len(t)), 0.0
        for k in range(len(t) - 1):
            speed += (0.4 * opened[k] - speed) * -np.expm1(-1 / RATE / 0.05)
            x[k + 1] = x[k] + speed / RATE
        x += 1e-4 * random.standard_normal(len(t))
        rows = "\n".join(f"{a:.6f},{b:.9f}" for a, b in zip(u, x, strict=True))
        (folder / f"r{number}.csv").write_text(f"u,x\n{rows}\n")
        use = "verify" if number == 3 else "fit"
        lines.append(
            f"  - {{id: r{number}, file: r{number}.csv, sample_rate: 100 Hz, hold: zoh, use: {use}, "
            "channels: {command: {column: u, unit: V}, displacement: {column: x, unit: m}}}"
        )
    (folder / "matrix.yaml").write_text("\n".join(lines) + "\n")
    return folder


def test_a_run_below_the_dead_zone_spoils_no_error(tmp_path):
    """It was some thousand per cent, and with it the mean of all; the fit is that of the others, and says so."""
    matrix = read_matrix(bench(tmp_path))
    assert [one.use for one in matrix.runs] == ["fit", "fit", "fit", "verify"]  # as it is stated
    screened = screen(matrix)
    assert [one.use for one in screened.runs] == ["fit", "fit", "still", "verify"]
    assert any(notice.startswith("run r2 stands still") for notice in screened.notices)
    fit = identify(matrix, model="motor", effects=["dead_zone"])
    assert any(note.startswith("run r2 stands still") for note in fit.notes)
    assert [one.id for one in fit.runs] == ["r0", "r1", "r3"]
    assert max(fit.error["fit"], fit.error["verify"]) < 0.02
    assert fit.values["dead_zone.half_width"] == pytest.approx(0.3, rel=0.05)
    assert compare(matrix, fit).error == pytest.approx({use: fit.error[use] for use in ("fit", "verify")}, rel=1e-6)


def test_records_that_are_added_up_are_told_apart_alike():
    made = [
        from_arrays(dict(one.channels), sample_rate="100 Hz", units={"command": "V", "displacement": "m"}, id=one.id)
        for one in (run("a", 1.0), run("b", 0.9), run("c", 0.004))
    ]
    whole = made[0] + made[1] + made[2]
    screened = screen(whole)
    assert [one.use for one in screened.runs] == ["fit", "fit", "still"]
    assert screened.notices[-1].startswith("run c stands still")
    assert screen(screened).notices == screened.notices  # said once


def test_the_commands_keep_such_a_run_where_they_are_told_to(servoident, tmp_path):
    """`check` says what is taken out; `fit` has the run among its errors again, and says that the step is off."""
    folder = bench(tmp_path / "bench")
    usual, kept = servoident("check", folder), servoident("check", folder, "--no-run-exclusion")
    assert "notice: run r2 stands still" in usual.stdout
    assert "estimation data: 2 runs" in usual.stdout
    assert "stands still" not in kept.stdout
    assert "estimation data: 3 runs" in kept.stdout
    assert "notice: The step run_exclusion of preprocessing is switched off" in kept.stdout
    held = [part for text in ("Kt=0.4", "c0=1", "m0=0.05") for part in ("--set", text)]
    file = tmp_path / "fit.json"
    done = servoident("fit", folder, "--model", "motor", *held, "--no-run-exclusion", "--json", file)
    assert done.returncode == 0, done.stderr
    assert "note: The step run_exclusion of preprocessing is switched off" in done.stdout
    found = json.loads(file.read_text())
    assert [run["id"] for run in found["runs"]] == ["r0", "r1", "r2", "r3"]
    assert found["settings"]["preprocessing"] == {"run_exclusion": False}
    again = servoident("fit", folder, "--start", file, "--no-stroke-centre")
    assert again.returncode == 2
    assert "--no-stroke-centre cannot be given with a start" in again.stderr
