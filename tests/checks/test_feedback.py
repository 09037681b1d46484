"""A command that a controller made is told from one that was given; records of both from recursions of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import yaml

from ident.checks.check import check
from ident.checks.feedback import closed_loop, shares
from ident.errors import Unusable
from ident.fit import identification
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.readers import read_matrix
from ident.run import Run
from ident.workflows import identify
from tests.blind.any_machine import Lab

RATE, GAIN, LAG = 20.0, 0.05, 0.15
QUICK = {"population": 24, "generations": 6, "elite": 3}


def reference(random: np.random.Generator, n: int) -> np.ndarray:
    """Drawn by hand: straight from point to point, 0.1 m at most."""
    at = np.arange(0, n + 60, 60)
    return 0.1 * np.interp(np.arange(n), at, random.uniform(-1, 1, len(at)))


def cylinder(seed: int, looped: bool = True, seconds: float = 120.0) -> Run:
    """LAG q̇ + q = GAIN u, x[k+1] = x[k] + q dt + 1 mm of disturbance, under u = 40 (r − x) + 20 ∫(r − x) dt.

    Not `looped`, the command of another such loop opens the valve: its like, which knows nothing of this output.
    """
    random, n = np.random.default_rng(seed), int(seconds * RATE)
    r, decay = reference(random, n), np.exp(-1 / RATE / LAG)
    u, x, given = np.zeros(n), np.zeros(n), None if looped else cylinder(seed + 1000).command
    place = q = summed = 0.0
    for k in range(n):
        x[k] = place + 2e-4 * random.standard_normal()
        summed += 20.0 / RATE * (r[k] - x[k])
        u[k] = 40.0 * (r[k] - x[k]) + summed if given is None else given[k]
        target = GAIN * u[k]
        place += target / RATE + (q - target) * LAG * (1 - decay) + 1e-3 * random.standard_normal()
        q = target + (q - target) * decay
    units = {"command": "V", "displacement": "m"}
    return Run("one", "", RATE, {"command": u, "displacement": x}, units, hold="zoh")


def motor(seed: int) -> Run:
    """A speed that lags by 12 samples, disturbed, under u = 3 (r − w)."""
    random, n = np.random.default_rng(seed), 3000
    r, w, d, u, out = reference(random, n), 0.0, 0.0, np.zeros(n), np.zeros(n)
    for k in range(n):
        out[k] = w + 1e-3 * random.standard_normal()
        u[k] = 3.0 * (r[k] - out[k])
        d += -d / 20 + 3e-3 * random.standard_normal()
        w += (u[k] + d - w) / 12
    return Run(
        "one",
        "",
        100.0,
        {"command": u, "velocity": out},
        {"command": "V", "velocity": "rad/s"},
        hold="zoh",
        output="velocity",
    )


def alone(run: Run) -> Matrix:
    return Matrix(Actuator("ANY"), (run,))


@pytest.mark.parametrize("run", [*map(cylinder, range(3)), *map(motor, range(3))], ids=lambda run: run.output)
def test_a_command_that_answers_the_output_is_doubted(run):
    doubts = [finding for finding in check(alone(run)) if finding.code == "closed-loop"]
    assert len(doubts) == 1
    assert "Use the reference of the controller" in doubts[0].text


@pytest.mark.parametrize("seed", range(3))
def test_the_like_command_that_knows_nothing_of_the_output_is_not(seed):
    assert not closed_loop(cylinder(seed, looped=False))


@pytest.mark.parametrize("seed", range(3))
def test_ramps_between_levels_that_come_again_and_again_are_not(seed):
    """As the pressure of a ventilator is asked for, breath after breath: how far it sank tells when the next begins."""
    random, rate, breaths = np.random.default_rng(seed), 100.0, 20
    lengths = 100 + random.integers(0, 3, breaths)
    begin = np.concatenate([[0], np.cumsum(lengths)])
    corners = [(b + n, level) for b in begin[:-1] for n, level in ((0, 5.0), (10, 15.0), (40, 15.0), (41, 5.0))]
    u = np.interp(np.arange(begin[-1]), *zip(*corners, strict=True))
    y = np.full(len(u), 5.0)
    for k in range(len(u) - 1):
        y[k + 1] = y[k] + (u[k] - y[k]) / (4.0 if u[k] > y[k] else 60.0)
    y += 0.1 * random.standard_normal(len(u))
    run = Run("one", "", rate, {"command": u, "displacement": y}, {"command": "1", "displacement": "1"})
    assert not closed_loop(run), shares(run)


def test_commands_of_labs_in_open_loop_are_not_doubted(full):
    """Noise, sweeps, steps, staircases, by hand; dead zones, delays and friction between command and output."""
    for seed in range(3000, 3200 if full else 3006):
        for run in Lab.drawn(seed, hidden=bool(seed % 3)).measured(noisy=bool(seed % 5)).runs:
            assert not closed_loop(run), (seed, shares(run))


@pytest.mark.parametrize("bits", [8, 12])
def test_a_command_recorded_coarsely_is_not_doubted(bits):
    """What rounding adds to the command the output does not know; the command's own past less well than without."""
    for seed in range(3):
        run = cylinder(seed, looped=False)
        step = np.ptp(run.command) / 2**bits
        rounded = step * np.round(run.command / step)
        assert not closed_loop(replace(run, channels={**run.channels, "command": rounded})), seed


def test_what_the_lab_says_counts_before_what_the_record_shows():
    assert not closed_loop(replace(cylinder(1), closed_loop=False))
    assert closed_loop(replace(cylinder(1, looped=False), closed_loop=True))
    assert not [
        finding for finding in check(alone(replace(cylinder(1), closed_loop=False))) if finding.code == "closed-loop"
    ]


def test_plain_output_error_is_refused_in_one_line():
    with pytest.raises(
        Unusable, match=r"run one: a controller computed this command .* give the controller's reference"
    ):
        identify(alone(motor(1)), Settings(model="motor"))
    said = alone(replace(motor(1), closed_loop=False))
    assert identify(said, Settings(model="first_order", options=QUICK)).error["fit"] < 1.0


def gain(run: Run) -> float:
    fit = identify(alone(run), Settings(model="motor", options=QUICK))
    assert any("a free run would give biased parameters" in note for note in fit.notes) is closed_loop(run)
    return fit.values["Kt"] / fit.values["c0"] / GAIN


def test_what_integrates_is_fitted_with_its_disturbances(monkeypatch):
    """Over whole runs the gain comes out a fifth too low."""
    records = [cylinder(seed) for seed in (2, 3, 4)]
    assert [gain(run) for run in records] == pytest.approx([1.0] * 3, abs=0.05)
    monkeypatch.setattr(identification, "in_windows", lambda optimum, *_, **__: optimum)
    assert max(gain(replace(run, closed_loop=False)) for run in records) < 0.85


def test_without_a_model_only_what_integrates_is_in_question(full):
    if not full:
        pytest.skip("half a minute: run with --full")
    fit = identify(alone(cylinder(1)), Settings(model=""))
    assert {one.machine for one in fit.structures} <= {"open_valve", "motor"}


def test_matrix_yaml_says_it(tmp_path, servoident):
    run = motor(1)
    table = np.column_stack([run.command, run.measured])
    np.savetxt(tmp_path / "run.csv", table, delimiter=",", header="u,w", comments="")
    channels = {"command": {"column": "u", "unit": "V"}, "velocity": {"column": "w", "unit": "rad/s"}}
    entry = {"id": "one", "file": "run.csv", "sample_rate": "100 Hz", "output": "velocity", "channels": channels}
    (tmp_path / "matrix.yaml").write_text(yaml.safe_dump({"actuator": {"serial": "AXIS"}, "runs": [entry]}))
    assert read_matrix(tmp_path).runs[0].closed_loop is None
    done = servoident("fit", tmp_path, "--model", "motor")
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "closed_loop: false" in done.stderr
    (tmp_path / "matrix.yaml").write_text(
        yaml.safe_dump({"actuator": {"serial": "AXIS"}, "runs": [entry | {"closed_loop": False}]})
    )
    assert read_matrix(tmp_path).runs[0].closed_loop is False
