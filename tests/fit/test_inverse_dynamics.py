"""Mass and friction of a drive by inverse dynamics: on measured data, and on a rigid mass of known friction."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.signal

from ident.errors import Unusable
from ident.fit.inverse_dynamics import UNITS, regress
from ident.matrix import Actuator, Matrix
from ident.readers import read_matrix
from ident.run import Run

EMPS = Path(__file__).parents[3] / "shared" / "data" / "emps"
PUBLISHED = {"mass": 95.0, "viscous": 203.0, "coulomb": 20.4, "offset": -3.2}
KNOWN = {"mass": 5.0, "viscous": 12.0, "coulomb": 3.0, "offset": 0.7}
RATE, STEPS = 1000, 10  # samples a second, steps a sample


@pytest.fixture(scope="module")
def measured():
    """The regression on the measured positioning system."""
    if not EMPS.exists():
        pytest.skip("the measured data emps is not here")
    return regress(read_matrix(EMPS))


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_published_values_are_found(measured, name):
    """Mass, viscous and dry friction and offset are within 5 % of the publication."""
    assert measured.coefficients[name].value == pytest.approx(PUBLISHED[name], rel=0.05)


@pytest.mark.parametrize(("run", "least"), [("estimation", 2.5), ("validation-pulses", 1.8)])
def test_dry_friction_explains_the_force(measured, run, least):
    """Leaving it out makes the residual several times as large, also on the pulses that no fit saw."""
    assert measured.residual_without_friction[run] / measured.residual[run] >= least


def integrated(seconds: float = 10.0, phase: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Reference, position and force of a rigid mass under a position loop: Euler steps, and it sticks where it stops.

    The reference rests for a second in the middle, so that the record has a true standstill.
    """
    m, c, dry, offset = KNOWN.values()
    t = np.arange(int(seconds * RATE)) / RATE
    clock = t - np.clip(t - seconds / 2, 0, 1)
    reference = 0.1 * np.sin(2 * np.pi * 0.4 * clock + phase) + 0.03 * np.sin(2 * np.pi * 1.1 * clock)
    x, v, h = float(reference[0]), 0.0, 1 / (RATE * STEPS)
    position, force = np.empty(len(t)), np.empty(len(t))
    for i, goal in enumerate(reference):
        drive = 4000.0 * (goal - x) - 150.0 * v  # held between samples
        position[i], force[i] = x, drive
        for _ in range(STEPS):
            push = drive - offset - c * v
            if v == 0.0 and abs(push) <= dry:
                continue
            direction = np.sign(v) if v != 0.0 else np.sign(push)
            faster = v + h * (push - dry * direction) / m
            v = 0.0 if faster * direction < 0 else faster
            x += h * v
    # A held force acts half a sample later than its sample says: the mean of neighbours is the force at the sample.
    force[1:] = (force[1:] + force[:-1]) / 2
    return reference, position, force


def drive_run(noise: float = 0.0, name: str = "run", **how: float) -> Run:
    """A run of the rigid mass; the force's noise (N) has a correlation time of 50 ms."""
    reference, position, force = integrated(**how)
    force = force + noise * coloured(len(force), seed=0)
    return Run(name, "", RATE, {"command": reference, "displacement": position, "drive_force": force})


def coloured(length: int, seed: int) -> np.ndarray:
    """Noise of deviation 1 and a correlation time of 50 ms."""
    pole = np.exp(-20 / RATE)
    white = np.random.default_rng(seed).standard_normal(length)
    return scipy.signal.lfilter([np.sqrt(1 - pole**2)], [1, -pole], white)


def matrix(*runs: Run) -> Matrix:
    return Matrix(Actuator("DRIVE"), runs)


def test_a_rigid_mass_is_found():
    """Without noise every coefficient is within 1 % of what was integrated, and the model explains the force."""
    found = regress(matrix(drive_run()))
    for name, truth in KNOWN.items():
        assert found.coefficients[name].value == pytest.approx(truth, rel=0.01)
    assert found.residual["run"] < 0.1 < found.residual_without_friction["run"]


def test_standard_errors_hold_for_correlated_noise():
    """Over many noises the scatter is what the standard errors say; white-noise formulas would give a third of it."""
    clean = drive_run()
    found = []
    for seed in range(60):
        force = clean.channels["drive_force"] + 2.0 * coloured(clean.length, seed)
        noisy = {**clean.channels, "drive_force": force}
        found.append(regress(matrix(replace(clean, channels=noisy))).coefficients)
    for name in UNITS:
        scatter = np.std([one[name].value for one in found])
        assert 0.6 < scatter / np.mean([one[name].std_error for one in found]) < 1.6


def test_a_noisy_run_weighs_little():
    """Beside a clean run, one of much noise hardly moves the coefficients, and it keeps its own large residual."""
    clean, noisy = drive_run(name="clean"), drive_run(name="noisy", noise=20.0, phase=1.0)
    both, alone = regress(matrix(clean, noisy)), regress(matrix(noisy))
    for name, truth in KNOWN.items():
        assert both.coefficients[name].value == pytest.approx(truth, rel=0.05)
    assert both.residual["noisy"] > 3 * both.residual["clean"]
    assert both.coefficients["mass"].std_error < alone.coefficients["mass"].std_error


def test_runs_to_verify_only_report():
    """A run to verify changes no coefficient and has a residual of its own."""
    fit, other = drive_run(name="fit"), replace(drive_run(name="other", noise=20.0), use="verify")
    both, alone = regress(matrix(fit, other)), regress(matrix(fit))
    assert both.coefficients == alone.coefficients
    assert set(both.residual) == set(both.residual_without_friction) == {"fit", "other"}


def test_without_a_measured_force_it_says_so():
    """The refusal names the channel; a run to verify is not enough, nor a force in unknown units."""
    run = drive_run(seconds=3.0)
    bare = replace(run, channels={"command": run.command, "displacement": run.measured})
    for useless in (bare, replace(run, use="verify"), replace(run, units={"drive_force": "1"})):
        with pytest.raises(Unusable, match="drive_force"):
            regress(matrix(useless))


@pytest.mark.parametrize(
    ("position", "force", "code"),
    [
        (np.zeros(3000), np.sin(np.arange(3000) / 50), "too-short"),
        (np.sin(np.arange(100) / 50), np.cos(np.arange(100) / 50), "too-short"),
        (np.arange(3000) / 1e3, np.sin(np.arange(3000) / 50), "not-determined"),
        (np.sin(np.arange(3000) / 50), np.ones(3000), "zero-variance"),
    ],
    ids=["never moves", "a tenth of a second", "one speed", "one force"],
)
def test_records_that_tell_nothing_are_refused(position, force, code):
    """A record that holds no mass and friction is refused in words, not answered with numbers."""
    run = Run("run", "", RATE, {"command": position, "displacement": position, "drive_force": force})
    with pytest.raises(Unusable) as refused:
        regress(matrix(run))
    assert refused.value.code == code


@pytest.mark.parametrize("cutoff", [0.0, -1.0, 251.0, float("nan")])
def test_a_cut_off_must_suit_the_rate(cutoff):
    """The cut-off is positive and a quarter of the sample rate at most."""
    with pytest.raises(Unusable, match="cut-off"):
        regress(matrix(drive_run(seconds=3.0)), cutoff)
