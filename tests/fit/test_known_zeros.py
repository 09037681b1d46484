"""The zero of a transducer that rest tells: its mean counts where eq. (17) would leave it out against the record.

The machine is a mass on a damper that a measured force drives, with a constant force on it, in Euler steps of a
tenth of a sample. Without a spring nothing but where it began says where it is.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ident.comparison.compare import compare
from ident.fit.known_zeros import with_known_zeros
from ident.fit.settings import Settings
from ident.matrix import Actuator, Matrix
from ident.run import Run
from ident.workflows import identify

SMALL = {"population": 20.0, "generations": 6.0, "elite": 3.0}
RATE, MASS, DAMPING, LOAD = 400.0, 2.0, 3.0, 0.4


def pushed(seed: int, noise: float = 1e-6, seconds: float = 8.0, stiffness: float = 0.0) -> Matrix:
    """A mass under a force of four sines, less a constant one, which set out from zero a sample ago; or on a spring."""
    runs, n = [], round(RATE * seconds)
    t = np.arange(n) / RATE
    for number in range(2):
        rng = np.random.default_rng([63, seed, number])
        parts = [rng.normal(2.0, 0.5) * np.cos(2 * np.pi * f * t) for f in (0.3, 0.5, 0.9, 1.4)]
        force = 0.5 * np.sum(parts, axis=0) + LOAD
        x, v, y = 0.0, 0.0, np.empty(n)
        for k in range(n):
            y[k] = x
            following = force[min(k + 1, n - 1)]
            for step in range(10):
                now = force[k] + (following - force[k]) * step / 10
                v += (now - LOAD - DAMPING * v - stiffness * x) / MASS / RATE / 10
                x += v / RATE / 10
        y += noise * rng.standard_normal(n)
        channels = {"drive_force": force[1:], "displacement": y[1:]}
        runs.append(
            Run(
                f"r{number}",
                "",
                RATE,
                channels,
                {"drive_force": "N", "displacement": "m"},
                use="verify" if number else "fit",
            )
        )
    return Matrix(Actuator("MASS"), tuple(runs))


def test_rest_tells_the_zero_and_its_standard_error():
    """At rest the mean of the first samples, of a motion that sets out its first one; none of one that is under way."""
    rng = np.random.default_rng(64)
    scores, rate = [], 1000.0
    t = np.arange(4000) / rate
    for _ in range(300):
        x = 0.01 + np.where(t > 0.1, 1.0 - np.cos(3.0 * (t - 0.1)), 0.0) + 1e-3 * rng.standard_normal(len(t))
        run = Run("r", "", rate, {"displacement": x}, {})
        assert run.begins == "at rest"
        value, error = run.zero_at_rest
        scores.append((value - 0.01) / error)
    assert 0.8 < np.std(scores) < 1.25
    sets_out = Run("r", "", rate, {"displacement": 1.0 - np.cos(3.0 * (t + 0.012))}, {})
    assert sets_out.begins == "moving"
    assert sets_out.zero_at_rest == (0.0, pytest.approx(1.0 - np.cos(0.036), rel=0.01))
    passing = Run("r", "", rate, {"displacement": np.sin(3.0 * t + 1e-4)}, {})
    assert passing.begins == "moving"
    assert passing.zero_at_rest is None
    by_hand = replace(sets_out, zeroed={"displacement": True})
    assert by_hand.zero_at_rest is None


def test_a_motion_that_sets_out_is_taken_from_rest_where_its_mean_counts():
    t = np.arange(4000) / 1000.0
    run = Run("r", "", 1000.0, {"displacement": 1.0 - np.cos(3.0 * (t + 0.012))}, {})
    (known,) = with_known_zeros(Matrix(Actuator("A"), (run,)), ["displacement"]).runs
    assert known.begins == "at rest"
    assert known.zeroed == {"displacement": False}
    assert known.zero_at_rest == run.zero_at_rest
    by_hand = replace(run, zeroed={"displacement": True})
    assert with_known_zeros(Matrix(Actuator("A"), (by_hand,)), ["displacement"]).runs == (by_hand,)


def test_a_constant_force_is_told_from_an_offset_by_where_the_run_began():
    """Eq. (17) cannot tell an offset from a constant force over a weak spring: it ends kilometres away. Rest can."""
    found = identify(pushed(0), Settings(model="drive", effects=("static_load",), options=SMALL, seed=1))
    assert found.settings["known_zeros"] == ["displacement"]
    assert found.parameters["static_load.force"].value == pytest.approx(-LOAD, rel=0.02)
    assert found.parameters["static_load.force"].std_error < 0.02 * LOAD
    assert found.parameters["m0"].value == pytest.approx(MASS, rel=0.02)
    assert abs(found.transducer_offset["displacement"].value) < 1e-4
    assert found.error_with_mean["verify"] < 0.03
    assert any("begin at rest" in note for note in found.notes)
    again = identify(pushed(0), Settings.from_json(found.settings))
    assert again.values == found.values


def test_a_comparison_begins_where_the_fit_did():
    """A mass on a spring with a wrong damping: first states of its own would make up for a part of the error."""
    matrix = pushed(1, stiffness=8.0)
    later = [{name: samples[1:] for name, samples in run.channels.items()} for run in matrix.runs]
    runs = tuple(replace(run, channels=channels) for run, channels in zip(matrix.runs, later, strict=True))
    matrix = replace(matrix, runs=runs)
    settings = Settings(model="drive", effects=("static_load",), fixed={"c0": 2.0}, options=SMALL, seed=1)
    found = identify(matrix, replace(settings, known_zeros=("displacement",)))
    compared = compare(matrix, found)
    assert found.window is None
    assert compared.error["fit"] == pytest.approx(found.error["fit"], rel=1e-6)
    assert compared.error["verify"] == pytest.approx(found.error["verify"], rel=1e-6)
