"""The programs of both papers, whole: planned with a model that is off, played on references, identified."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import ident
from ident.bench.acceptance import found_quantities
from ident.bench.analysis import analyse
from ident.bench.records import bench_set
from ident.fit.settings import Settings
from ident.matrix import Actuator
from ident.planning.plan import plan
from ident.rig.limits import RigLimits
from tests.bench.calibration import instruments_of, truth_of
from tests.hybrid.cases import fitted
from tests.planning.control_unit import played
from tests.planning.rigs import another, fit_of
from tests.reference import kononykhin_reference
from tests.reference.qian_reference import BOUNDS, Cell, Plant, simulate

SEED, SECONDS, NOISE = 563, 4.0, 0.005
WITHIN, SHARE = 3.0, 0.01
"""Standard errors, and of the value of a parameter."""
ACTUATORS = range(563, 571)
"""Seeds of the bench's; each of the eight is read by other converters and gauges."""


@pytest.fixture(autouse=True)
def whole(full: bool) -> None:
    """A few runs of each program are in test_files."""
    if not full:
        pytest.skip("minutes: run with --full")


def test_the_matrix_of_qian_leads_to_the_six_parameters(tmp_path):
    """Within 3 standard errors and 1 % at 0.5 % noise, from files planned with parameters that are 20 % off at most."""
    rng = np.random.default_rng(SEED)
    true = another(Plant(), rng)
    made = plan("qian", fit_of(Plant()), RigLimits(stroke=0.1524, speed=0.4, force=5e3), seconds=SECONDS)
    made.write(tmp_path / "plan")
    assert [sum(run.use == use for run in made.runs) for use in ("fit", "verify")] == [63, 21]
    for run in made.runs:
        time, command = np.loadtxt(tmp_path / f"plan/commands/{run.id}.csv", delimiter=",", skiprows=1).T
        s = run.specimen
        x = 1e3 * simulate(true, Cell(s.mass, s.stiffness, s.damping, run.gain), 1e-3 * command)
        x += NOISE * x.std() * rng.standard_normal(len(x))
        header = "time_s,command_mm,displacement_mm"
        rows = np.column_stack([time, command, x])
        np.savetxt(tmp_path / f"plan/runs/{run.id}.csv", rows, "%.9g", ",", header=header, comments="")
    found = ident.identify(ident.read_matrix(tmp_path / "plan"), Settings(seed=1)).parameters
    off = {n: (found[n].value - getattr(true, n)) / found[n].std_error for n in BOUNDS}
    shares = {n: found[n].value / getattr(true, n) - 1 for n in BOUNDS}
    print(f"z {off}, off by {shares}")
    assert max(map(abs, off.values())) <= WITHIN
    assert max(map(abs, shares.values())) <= SHARE


def test_the_program_of_kononykhin_leads_to_the_sheet(tmp_path):
    """Actuators that scatter about the planned one: z of all quantities has an RMS of 1, and none is beyond 4."""
    z = np.concatenate([off_the_sheet(seed, tmp_path / str(seed)) for seed in ACTUATORS])
    print(f"{len(z)} quantities, RMS {np.sqrt(np.mean(z**2)):.2f}, largest {np.abs(z).max():.1f}")
    assert 0.7 < np.sqrt(np.mean(z**2)) < 1.4
    assert np.abs(z).max() < 4


def off_the_sheet(seed, folder):
    """What is wrong of each quantity over its standard error, from the files of a plan that were dropped in."""
    truth, read = kononykhin_reference.scattered(seed), instruments_of(seed)
    actuator = Actuator("BENCH", stroke=0.1, supply_pressure=1e6 * truth.Ps)
    found = replace(fitted("kononykhin", I0=truth.I0 / 100), actuator=actuator)
    made = plan("kononykhin", found, RigLimits(stroke=0.1, supply_pressure=21e6))
    made.write(folder)
    records = [played(run, truth, seed, read) for run in made.runs]
    for of in records:
        rows = np.column_stack([of.current, of.position, of.pressure_a, of.pressure_b])
        header = "current,displacement,pressure_a,pressure_b"
        np.savetxt(folder / f"runs/{of.id}.csv", rows, "%.9g", ",", header=header, comments="")
    quantities = found_quantities(analyse(bench_set(ident.read_matrix(folder), "fit")))
    true = truth_of(truth, records, read.bits)
    return np.array(
        [(quantities[name].value - value) / abs(quantities[name].deviation) for name, value in true.items()]
    )
