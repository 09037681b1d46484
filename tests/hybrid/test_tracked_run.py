"""Recorded runs tracked: measured sweeps that no first-order loop holds for, simulated ones that it does."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from ident.errors import Unusable
from ident.figures import look, render
from ident.figures.tracking import tracking
from ident.fit.settings import Settings
from ident.hybrid.tracked_run import ROWS, _ranges, sensor_noise, track
from ident.matrix import Actuator, Matrix
from ident.readers import read_matrix
from ident.run import Run
from ident.workflows import identify
from tests.reference import first_order_reference as reference
from tests.reference import qian_reference
from tests.short_form import short_form

LOOPS = [(reference.Loop(8e-3, 0.9),), (reference.Loop(30e-3, 1.1),)]


def recorded(loops, seconds: float = 4.0, noise: float = reference.SENSOR) -> Run:
    """A run of the reference, 1 Hz and 4 Hz."""
    t, sines = reference.times(seconds), (reference.Sine(), reference.Sine(0.01, 4.0, 1.0))
    y = reference.response(t, loops, sines) + noise * np.random.default_rng(0).standard_normal(len(t))
    channels = {"command": reference.reference(t, sines), "displacement": y}
    return Run("sine", "", reference.SAMPLE_RATE, channels)


@pytest.mark.parametrize("run", ["sweep-0A", "sweep-1A"])
def test_no_first_order_loop_holds_for_the_measured_machine(measured_data, run):
    """Whatever the sensor's noise is taken for, and the reason says how far the parameters run."""
    matrix = read_matrix(measured_data / "mts_actuator")
    (found,) = (entry for entry in matrix.runs if entry.id == run)
    for noise in (None, 1e-5, 1e-4):
        said = track(found, noise).verdict
        assert not said.holds
        assert "a first-order loop is not valid" in said.reason
        assert "τyr runs from" in said.reason


@pytest.mark.parametrize("loops", LOOPS)
@pytest.mark.parametrize("noise", [0.0, 2e-5, reference.SENSOR])
def test_a_simulated_first_order_loop_holds(loops, noise):
    found = track(recorded(loops, noise=noise))
    assert found.verdict.holds, found.verdict.reason
    assert (found.tau[-1], found.gain[-1]) == pytest.approx(loops[0][:2], rel=0.01)


def test_a_range_up_to_seconds_is_written_without_an_exponent():
    said = _ranges(np.linspace(0.5, 2.4, 101), np.linspace(1.0, 1.2, 101), "s")
    assert "e+" not in said
    assert said.startswith("τyr runs from 861 to 2229 ms")


def test_a_loop_whose_parameters_step_still_holds():
    loops = (reference.Loop(8e-3, 1.0), reference.Loop(40e-3, 0.9, 3.0))
    found = track(recorded(loops, 7.0))
    assert found.verdict.holds
    assert (found.tau[-1], found.gain[-1]) == pytest.approx(loops[1][:2], rel=0.02)


def test_a_chain_of_fourth_order_is_no_first_order_loop():
    (record,) = qian_reference.measure_all(
        qian_reference.Plant(), qian_reference.trials()[:1], seconds=4.0, noise=0.005, seed=0, hold="linear"
    )
    run = Run("blwn", "", 4096.0, {"command": record.command, "displacement": record.displacement})
    assert not track(run).verdict.holds


def test_the_noise_of_the_sensor_is_read_off_the_record():
    assert sensor_noise(recorded(LOOPS[0]).measured) == pytest.approx(reference.SENSOR, rel=0.03)


def test_the_file_has_the_names_of_the_contract_and_the_last_sample():
    found = track(recorded(LOOPS[0]))
    data = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert {"t", "tau", "gain", "std_tau", "std_gain", "nis_mean", "holds"} <= data.keys()
    assert len(data["t"]) == len(data["std_gain"]) <= ROWS
    assert data["t"][-1] == pytest.approx(found.t[-1])
    assert data["tau"][-1] == found.tau[-1]


@pytest.mark.parametrize(
    ("format_", "theme"), short_form(product(["svg", "png", "pdf", "json"], ["light", "dark"]), ("svg", "light"))
)
def test_the_figure_is_drawn_in_every_format(format_, theme):
    drawn = render(tracking(track(recorded(LOOPS[0], 2.0)), Actuator("SW-1"), look(theme)), format_)
    assert len(drawn) > 1000
    if format_ == "svg":
        assert "Time constant" in drawn.decode()
        assert "Gain kyr" in drawn.decode()


@pytest.mark.parametrize(
    "channels", [{"displacement": np.ones(100)}, {"command": np.ones(100), "displacement": np.arange(100.0)}]
)
def test_a_run_that_cannot_be_tracked_is_refused(channels):
    with pytest.raises(Unusable):
        track(Run("r", "", 100.0, channels))


def test_the_method_ekf_finds_what_the_search_finds_with_its_standard_errors():
    """Two runs of one loop: parameters and standard errors of the output-error fit."""
    runs = tuple(replace(recorded(LOOPS[1]), id=f"run {n}") for n in range(2))
    matrix = Matrix(Actuator("A"), runs)
    filtered, searched = (
        identify(matrix, Settings(model="first_order", method=method, options=options))
        for method, options in (("ekf", {}), ("ga", {"population": 20, "generations": 3, "elite": 2}))
    )
    assert filtered.method == "ekf"
    assert filtered.error["fit"] == pytest.approx(searched.error["fit"], rel=1e-3)
    for name, found in filtered.parameters.items():
        other = searched.parameters[name]
        assert abs(found.value - other.value) < 2 * other.std_error
        assert found.std_error == pytest.approx(other.std_error, rel=0.2)


def test_a_loop_that_does_not_hold_has_no_standard_error():
    loops = (reference.Loop(8e-3, 1.0), reference.Loop(40e-3, 0.9, 3.0))
    found = identify(Matrix(Actuator("A"), (recorded(loops, 6.0),)), Settings(model="first_order", method="ekf"))
    assert all(parameter.std_error is None for parameter in found.parameters.values())
    assert {entry.name for entry in found.undetermined} == {"tau", "gain"}


@pytest.mark.parametrize(
    "given",
    [
        {"bounds": {"tau": (1e-3, 1.0)}},
        {"fixed": {"tau": 1e-2}},
        {"effects": ("command_delay",)},
        {"model": "qian2014"},
    ],
)
def test_what_a_filter_does_not_know_is_refused(given):
    with pytest.raises(Unusable):
        identify(
            Matrix(Actuator("A"), (recorded(LOOPS[0], 1.0),)),
            Settings(**{"model": "first_order", "method": "ekf", **given}),
        )


def test_the_command_tracks_a_run_and_draws_it(servoident, tmp_path: Path):
    run = recorded(LOOPS[0])
    np.savez(tmp_path / "run.npz", **run.channels)
    (tmp_path / "matrix.yaml").write_text(
        "actuator: {serial: SW-1}\nruns:\n  - {id: sine, file: run.npz, sample_rate: 4096 Hz, channels: {command: "
        "{column: command, unit: m}, displacement: {column: displacement, unit: m}}}\n"
    )
    done = servoident(
        "track", tmp_path, "--run", "sine", "--noise", "0.12 mm", "--json", "-", "--out", tmp_path / "out"
    )
    assert done.returncode == 0, done.stderr
    data, _ = json.JSONDecoder().raw_decode(done.stdout)
    assert data["holds"] is True
    assert data["noise"]["measurement"] == pytest.approx(1.2e-4)
    assert {file.name for file in (tmp_path / "out").iterdir()} == {
        f"tracking.{e}" for e in ("svg", "png", "pdf", "json")
    }
    assert "holds: " in servoident("track", tmp_path).stdout
    for wrong in (("--run", "none"), ("--noise", "0"), ("--noise", "-1 mm"), ("--noise", "much")):
        refused = servoident("track", tmp_path, *wrong)
        assert (refused.returncode, refused.stderr.count("\n")) == (2, 1)


def test_a_few_samples_tell_nothing():
    said = track(recorded(LOOPS[0], 0.1)).verdict
    assert not said.holds
    assert "too few samples" in said.reason
