"""The reference is independent of the program, and exact enough to judge it."""

from __future__ import annotations

import ast
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.reference import qian_reference as reference

SOURCE = Path(reference.__file__)
TIGHT = 1e-12  # relative tolerance of DOP853
CLOSE = 1e-9  # of the output's standard deviation
PROJECT = {"ident", "app", "schemas", "migrations", "benchmarks", "tests"}


def test_the_reference_imports_nothing_of_the_project():
    """Its import statements, wherever they stand, name only numpy, numba and the standard library."""
    tree = ast.parse(SOURCE.read_text(encoding="utf-8"))
    imported = {
        alias.name.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, "a relative import"
            imported.add((node.module or "").split(".")[0])
    assert imported - set(sys.stdlib_module_names) == {"numpy", "numba"}
    assert not imported & PROJECT
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert not names & {"__import__", "exec", "eval", "importlib"}


@pytest.mark.full
def test_the_reference_writes_a_matrix_where_the_project_cannot_be_imported(tmp_path):
    """As a script, with every package of the project blocked, it still writes a whole matrix."""
    blocked = (
        "import runpy, sys\n"
        f"sys.modules.update(dict.fromkeys({sorted(PROJECT)!r}))\n"
        f"sys.argv = ['reference', {str(tmp_path / 'm')!r}, '--seconds', '0.05', '--hold', 'zoh']\n"
        f"runpy.run_path({str(SOURCE)!r}, run_name='__main__')\n"
    )
    subprocess.run([sys.executable, "-c", blocked], check=True, cwd=tmp_path, timeout=120)
    text = (tmp_path / "m" / "matrix.yaml").read_text(encoding="utf-8")
    assert text.count("hold: zoh") == 84
    assert text.count("use: verify") == 21
    assert len(list((tmp_path / "m" / "runs").glob("*.npz"))) == 84


@pytest.mark.parametrize("hold", ["linear", "zoh"])
def test_the_fixed_steps_agree_with_an_adaptive_integrator(hold):
    """Within 1e-9 of the output's standard deviation of scipy's DOP853 at a relative tolerance of 1e-12."""
    plant, trial = reference.Plant(), reference.trials()[-1]
    command = reference.band_limited_noise(2048, trial.amplitude, np.random.default_rng(3))
    ours = reference.simulate(plant, trial.cell, command, hold)
    theirs = by_scipy(plant, trial.cell, command, hold)
    assert np.max(np.abs(ours - theirs)) < CLOSE * np.std(theirs)


def by_scipy(plant, cell, command, hold):
    """The equations once more, integrated interval by interval because the command has a kink at each sample."""
    mass, damping = plant.m0 + cell.mass, plant.c0 + cell.damping
    interval = 1 / reference.SAMPLE_RATE

    def chain(t, y, start, slope):
        q, p, v, x = y
        return [
            (cell.gain * (start + slope * t - x) - q) / plant.tau,
            (plant.Z0 / plant.A * q - plant.Cl * p - plant.A * v) / plant.Ka,
            (plant.A * p - damping * v - cell.stiffness * x) / mass,
            v,
        ]

    state, output = np.zeros(4), [0.0]
    for start, end in pairwise(command):
        slope = (end - start) / interval if hold == "linear" else 0.0
        solution = solve_ivp(
            chain,
            (0, interval),
            state,
            method="DOP853",
            rtol=TIGHT,
            atol=[1e-18, 1e-6, 1e-16, 1e-18],
            args=(start, slope),
        )
        state = solution.y[:, -1]
        output.append(state[3])
    return np.array(output)


def test_the_command_is_noise_of_the_stated_band_and_strength():
    """Its RMS is exact, and less than 1 % of its power lies above 82 Hz."""
    command = reference.band_limited_noise(8192, 1.27e-3, np.random.default_rng(0))
    assert np.sqrt(np.mean(command**2)) == pytest.approx(1.27e-3, rel=1e-12)
    power = np.abs(np.fft.rfft(command * np.hanning(len(command)))) ** 2
    frequency = np.fft.rfftfreq(len(command), 1 / reference.SAMPLE_RATE)
    assert power[frequency > 82].sum() < 0.01 * power.sum()
    assert abs(command[0] - command[-1]) > 0, "the record must not close on itself"


def test_the_matrix_is_the_papers():
    """63 runs at gains 5, 7, 10 to fit, 21 at gain 6 to verify, all with names of their own."""
    runs = reference.trials()
    assert [run.use for run in runs].count("fit") == 63
    assert {run.cell.gain for run in runs if run.use == "verify"} == {6.0}
    assert len({run.id for run in runs}) == 84


def test_the_error_at_the_truth_is_the_noise():
    """Eq. (17) of a run against its own model is the noise put on it, and grows when a parameter is wrong."""
    plant = reference.Plant()
    records = reference.measure_all(plant, reference.trials()[:3], seconds=2, noise=0.005, seed=4)
    assert reference.mean_error(records, plant) == pytest.approx(0.005, rel=0.02)
    assert reference.mean_error(records, plant._replace(Z0=plant.Z0 * 1.02)) > 0.0055


def test_the_bound_is_the_spread_that_least_squares_shows():
    """One-parameter check of the Cramér-Rao bound: linear estimates of Z0 from noisy records spread as it says."""
    plant, trial = reference.Plant(), reference.trials()[10]
    clean = reference.measure(plant, trial, seconds=1, noise=0.0, seed=(9,))
    up = reference.simulate(plant._replace(Z0=plant.Z0 * 1.001), trial.cell, clean.command)
    slope = (up - clean.displacement) / (0.001 * plant.Z0)
    sigma = 0.01 * clean.displacement.std()
    rng = np.random.default_rng(5)
    estimates = [slope @ (sigma * rng.standard_normal(len(slope))) / (slope @ slope) for _ in range(400)]
    alone = reference.cramer_rao([clean], plant, 0.01, names=("Z0",))["Z0"]
    assert np.std(estimates) == pytest.approx(alone, rel=0.15)
