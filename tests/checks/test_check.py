"""One fault in a healthy matrix gives one finding, with the right code and run, and nothing else does."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import TransferFunction, lsim

from ident.checks.check import check, describe
from ident.checks.delay import Delay, delay, delays
from ident.checks.response import respond
from ident.matrix import Actuator, Matrix
from ident.readers import read_matrix
from ident.run import Run
from ident.words.messages import MESSAGES

from .conftest import SPECIMENS, displacement_of, noise_of


def test_a_healthy_matrix_raises_nothing(healthy):
    assert check(healthy) == ()


@pytest.mark.parametrize(("channel", "flip"), [("command", 1), ("displacement", 1), ("displacement", -1)])
def test_a_clipped_channel_is_found(faulty, channel, flip):
    samples = flip * faulty.matrix.runs[3].channels[channel]
    clipped = flip * np.minimum(samples, 1.5 * samples.std())
    found = faulty.channel(3, channel, clipped)
    assert found.found()["run-3", "clipping"] == "doubt"
    assert channel in found.text("clipping")
    assert {run for run, code in found.found() if code == "clipping"} == {"run-3"}


def test_a_clipped_sine_is_found_and_a_whole_one_is_not_even_when_rounded(faulty):
    time = np.arange(8192) / 4096
    sine = np.round(0.00127 * np.sqrt(2) * np.sin(2 * np.pi * 3 * time), 6)
    for share, expected in ((1.0, False), (0.8, True)):
        top = share * sine.max()
        found = faulty.channel(0, "command", np.clip(sine, -top, top)).run(0, kind="sine").found()
        assert (("run-0", "clipping") in found) is expected


def test_a_command_that_jumps_between_levels_is_not_clipped(faulty):
    """A random binary sequence about a middle level, which is reached by a ramp."""
    levels = np.minimum(0.5 * np.arange(8192.0), 50.0)
    levels[2000:5000] = np.where(np.random.default_rng(2).random(30) < 0.5, 40.0, 60.0).repeat(100)
    evened = np.concatenate([levels[:1], (levels[1:] + levels[:-1]) / 2])  # a jump between two samples of a clock
    for command in (levels, evened):
        assert ("run-0", "clipping") not in faulty.channel(0, "command", command).run(0, kind="other").found()


def test_what_flickers_by_a_digit_at_rest_is_not_clipped_though_rest_is_its_lowest_value(faulty):
    """A speed in whole numbers that goes from rest to many of them; one that is cut at rest again and again is."""
    rng = np.random.default_rng(4)
    speed = np.zeros(8192)
    for first in range(10, 4000, 90):
        speed[first : first + 20] = -4.0
    speed[4000:] = np.round(1000.0 * (1.0 - np.exp(-np.arange(4192) / 300)) + rng.normal(0, 2.0, 4192))
    assert ("run-0", "clipping") not in faulty.channel(0, "displacement", speed).run(0, kind="other").found()
    sine = np.round(5000.0 * np.sin(2 * np.pi * 3 * np.arange(8192) / 4096))
    cut = np.maximum(sine, -4000.0)
    assert ("run-0", "clipping") in faulty.channel(0, "displacement", cut).run(0, kind="other").found()


def test_a_displacement_that_stands_still_is_found(faulty):
    samples = faulty.matrix.runs[2].measured.copy()
    samples[3000:3600] = samples[3000]
    found = faulty.channel(2, "displacement", samples)
    assert found.found()["run-2", "flat"] == "doubt"
    assert "from sample 3000 to 3599" in found.text("flat")


def test_a_machine_that_stays_at_rest_in_its_dead_zone_is_no_stuck_sensor(faulty):
    """It goes on from where it stood; a sensor that was stuck jumps to where the machine meanwhile is."""
    command = faulty.matrix.runs[2].command
    pushed = np.sign(command) * np.maximum(np.abs(command) - 0.7 * command.std(), 0.0)
    pushed[3000:3600] = 0.0
    moved = np.cumsum(pushed) / 40
    assert ("run-2", "flat") not in faulty.channel(2, "displacement", moved).found()
    stuck = np.cumsum(command) / 40
    stuck[3000:3600] = stuck[3000]
    assert faulty.channel(2, "displacement", stuck).found()["run-2", "flat"] == "doubt"


def test_a_command_that_stands_still_is_found_inside_a_run_but_not_at_its_ends(faulty):
    samples = faulty.matrix.runs[2].command.copy()
    samples[3000:3600] = samples[3000]
    assert ("run-2", "flat") in faulty.channel(2, "command", samples).found()
    resting = faulty.matrix.runs[2].command.copy()
    resting[:600] = resting[0]
    assert ("run-2", "flat") not in faulty.channel(2, "command", resting).found()


def test_gaps_and_jitter_are_told(faulty):
    assert faulty.run(1, gaps=3).found() == {("run-1", "gaps"): "doubt"}
    assert "are missing (3)" in faulty.run(1, gaps=3).text("gaps")
    assert "rows: [40, 900]" in faulty.run(1, gaps=3, unbroken=(40, 900)).text("gaps")
    assert faulty.run(1, gaps=3, evened=True).found() == {("run-1", "gaps"): "note"}
    assert faulty.run(1, gaps=300, evened=True).found() == {("run-1", "gaps"): "doubt"}
    assert faulty.run(1, clock_jitter=0.7).found() == {("run-1", "clock-jitter"): "doubt"}
    assert faulty.run(1, clock_jitter=0.3).found() == {("run-1", "clock-jitter"): "note"}
    assert faulty.run(1, clock_jitter=0.05).found() == {}


@pytest.mark.parametrize("channel", ["command", "displacement"])
def test_a_wrong_sign_is_found(faulty, channel):
    found = faulty.channel(4, channel, -faulty.matrix.runs[4].channels[channel])
    assert [place for place, severity in found.found().items() if severity != "note"] == [("run-4", "sign")]
    assert "moves against the command" in found.text("sign")


@pytest.mark.parametrize(("ratio", "found"), [(0.85, True), (0.93, False), (1.06, False), (1.15, True)])
def test_an_rms_that_disagrees_with_the_stated_amplitude_is_found(faulty, ratio, found):
    assert (("run-5", "amplitude") in faulty.run(5, amplitude=0.00127 / ratio).found()) is found


@pytest.mark.parametrize("factor", [10.0, 25.4, 1000.0, 0.1, 1 / 25.4, 0.001])
def test_a_wrong_unit_is_named(faulty, factor, full):
    if not full and factor not in (25.4, 1000.0, 0.1):
        pytest.skip("the same the other way about: run with --full")
    label = faulty.run(5, amplitude=0.00127 * factor)
    assert label.found() == {("run-5", "unit"): "doubt"}
    displacement = faulty.channel(5, "displacement", factor * faulty.matrix.runs[5].measured)
    assert displacement.found()["run-5", "unit"] == "doubt"
    named = f"near {max(factor, 1 / factor):g}"
    assert named in label.text("unit")
    assert named in displacement.text("unit")


@pytest.mark.parametrize("shift", [-20, -3, -1, 1, 3])
def test_a_run_whose_channels_are_shifted_by_whole_samples_is_found(faulty, shift):
    run = faulty.matrix.runs[7]
    command, displacement = run.command[30:-30], run.measured[30 - shift : len(run.measured) - 30 - shift]
    found = faulty.run(7, channels={"command": command, "displacement": displacement}).found()
    assert found == {("run-7", "skew"): "doubt"}


@pytest.mark.parametrize("shift", [-2, 2])
def test_a_shift_of_all_runs_is_found_although_an_actuator_lags_by_itself(faulty, shift):
    runs = [
        replace(
            run,
            channels={
                "command": run.command[30:-30],
                "displacement": run.measured[30 - shift : len(run.measured) - 30 - shift],
            },
        )
        for run in faulty.matrix.runs
    ]
    found = {(each.run, each.code): each for each in check(replace(faulty.matrix, runs=tuple(runs)))}
    assert list(found) == [(None, "delay")]
    assert f"{abs(shift)}.0 samples" in found[None, "delay"].text
    assert ("leads" if shift < 0 else "lags") in found[None, "delay"].text


@pytest.mark.parametrize(("size", "natural", "damping"), [(20, 10, 0.1), (50, 20, 0.3), (100, 15, 0.6)])
def test_a_step_that_an_encoder_counts_is_explained_by_no_delay_and_none_is_told(size, natural, damping):
    """Of one jump and whole counts no model is left that a delay could be measured beside."""
    t = np.arange(2000) / 500.0
    command = np.where(t >= 0.1, float(size), 0.0)
    swing = TransferFunction([natural**2], [1, 2 * damping * natural, natural**2])
    channels = {"command": command, "displacement": np.round(lsim(swing, command, t)[1])}
    run = Run("counted", "", 500.0, channels, dict.fromkeys(channels, "deg"), kind="step", hold="zoh")
    assert not list(delays([(run, respond(run))]))


def test_the_estimated_delay_of_a_healthy_run_is_a_small_part_of_a_sample(healthy):
    for run in healthy.runs:
        estimate = delay(run, respond(run))
        assert estimate is not None
        assert estimate.told
        assert abs(estimate.samples) < 0.2


@pytest.mark.parametrize("edge", [20.0, 45.0, 150.0])
def test_noise_of_another_band_is_found(faulty, edge):
    command = noise_of(np.random.default_rng(50), edge, 0.00127)
    moved = displacement_of(command, SPECIMENS[0], 5.0)
    found = faulty.channel(0, "command", command).matrix
    changed = type(faulty)(found).channel(0, "displacement", moved)
    assert changed.found()["run-0", "band"] == "doubt"
    assert ("run-0", "band") not in changed.run(0, kind="other").found()


def test_a_sample_rate_too_low_for_the_band_is_found(faulty):
    command = noise_of(np.random.default_rng(51), 80.0, 0.00127, 400.0)
    moved = displacement_of(command, SPECIMENS[0], 5.0, 400.0)
    found = faulty.run(0, sample_rate=400.0, channels={"command": command, "displacement": moved}).found()
    assert found["run-0", "sample-rate"] == "doubt"


@pytest.mark.parametrize(("lag", "doubted"), [(1.0, True), (10.0, False)])
def test_held_steps_are_doubted_only_where_they_are_answered_within_two_samples(lag, doubted):
    """A held command is known between the samples, whatever its spectrum; how the machine follows must be seen."""
    command = np.repeat(np.random.default_rng(52).uniform(-1, 1, 60), 40)
    output, held = np.zeros(len(command)), np.exp(-1 / lag)
    for k in range(1, len(command)):
        output[k] = held * output[k - 1] + (1 - held) * command[k - 1]
    channels = {"command": command, "displacement": output}
    run = Run("r", "", 10.0, channels, dict.fromkeys(channels, "m"), hold="zoh")
    found = [
        finding.code for finding in check(Matrix(Actuator("X"), (run,))) if finding.run and finding.severity != "note"
    ]
    assert found == (["sample-rate"] if doubted else [])


def test_the_column_of_another_run_is_found(faulty):
    found = faulty.channel(6, "displacement", faulty.matrix.runs[4].measured[::-1].copy()).found()
    assert found["run-6", "unrelated"] == "doubt"


def test_the_same_samples_under_two_names_are_found(faulty):
    twin = faulty.run(1, channels=faulty.matrix.runs[0].channels).found()
    assert twin["run-1", "duplicate-run"] == "doubt"
    verifies = faulty.run(2, channels=faulty.matrix.runs[0].channels).found()
    assert verifies["run-2", "duplicate-run"] == "fault"


def test_one_command_twice_under_the_same_conditions_is_a_repeat_and_no_doubt(faulty):
    labelled_alike = faulty.run(1, gain=5.0)
    assert (None, "repeat") not in labelled_alike.found()  # the commands are others
    noise = 1e-6 * np.random.default_rng(60).standard_normal(faulty.matrix.runs[0].length)
    channels = {"command": faulty.matrix.runs[0].command, "displacement": faulty.matrix.runs[0].measured + noise}
    again = labelled_alike.run(1, channels=channels)
    assert again.found() == {(None, "repeat"): "note"}
    assert "runs run-0 and run-1 repeat the same command under the same conditions" in again.text("repeat")


def test_one_command_twice_with_nothing_stated_counts_as_a_repeat_and_says_what_to_state(faulty):
    bare = faulty.all_runs(gain=None, specimen=None, amplitude=None)
    assert (None, "repeat") not in bare.found()  # every run has its own command
    same = {"command": faulty.matrix.runs[0].channels["command"], "displacement": 1.1 * bare.matrix.runs[1].measured}
    twice = bare.run(1, channels=same)
    assert twice.found()[None, "repeat"] == "note"
    assert "runs run-0 and run-1 have the same command, and no label separates them" in twice.text("repeat")
    assert "state it: specimen, gain" in twice.text("repeat")


def test_a_machine_that_turns_is_asked_for_nothing_of_a_cylinder(faulty):
    """Neither a piston area nor a loop gain nor a specimen is missed of a motor, nor of a damper that is moved."""
    runs = [
        replace(
            run,
            gain=None,
            specimen=None,
            amplitude=None,
            output="velocity",
            units={"command": "N*m", "velocity": "rad/s"},
            channels={"command": run.command, "velocity": run.measured},
        )
        for run in faulty.matrix.runs
    ]
    moved = [
        replace(
            run,
            output="force",
            units={"velocity": "m/s", "force": "N"},
            channels={"velocity": run.command, "force": run.measured},
        )
        for run in runs
    ]
    moved[1] = replace(moved[1], channels={**moved[1].channels, "velocity": moved[0].channels["velocity"]})
    for of in (runs, moved):
        bare = replace(faulty.matrix, runs=tuple(of), actuator=replace(faulty.matrix.actuator, piston_area=None))
        codes = {finding.code for finding in check(bare)}
        assert not codes & {"no-piston-area", "no-gain", "no-specimen", "one-condition"}, codes
        assert ("repeat" in codes) is (of is moved)


def test_an_output_in_unknown_units_is_asked_for_nothing_of_a_cylinder(faulty):
    """Steps of an encoder for each second that a voltage makes: no ratio of a cylinder follows from a piston area."""
    runs = [
        replace(
            run,
            gain=None,
            specimen=None,
            output="velocity",
            units={"command": "V", "velocity": "1"},
            channels={"command": run.command, "velocity": run.measured},
        )
        for run in faulty.matrix.runs
    ]
    bare = replace(faulty.matrix, runs=tuple(runs), actuator=replace(faulty.matrix.actuator, piston_area=None))
    assert not {finding.code for finding in check(bare)} & {"no-piston-area", "no-specimen", "one-condition"}


def test_a_motion_called_command_that_a_force_answers_is_neither_a_controllers_nor_asked_for_a_specimen():
    """A specimen under load control: its motion follows the force, as a controller's command does."""
    rng = np.random.default_rng(3)
    force, motion = np.zeros(3000), np.zeros(3000)
    for k in range(2, 3000):
        motion[k] = 1.6 * motion[k - 1] - 0.64 * motion[k - 2] + 0.1 * rng.standard_normal() - 0.3 * force[k - 1]
        force[k] = 0.5 * motion[k] + 0.3 * motion[k - 1] + 0.02 * rng.standard_normal()
    codes = {}
    for unit in ("m", "V"):
        units = {"command": unit, "force": "N"}
        run = Run("r", "", 100.0, {"command": motion, "force": force}, units, output="force")
        codes[unit] = {finding.code for finding in check(Matrix(Actuator("A"), (run,)))}
    asked = {"closed-loop", "no-specimen", "one-condition"}
    assert asked <= codes["V"]
    assert not asked & codes["m"]


@pytest.mark.parametrize(("unit", "ratio"), [("Pa", "m0/Ap, c0/Ap and k0/Ap"), ("rad/s", "Z0/A^3")])
def test_a_command_that_no_loop_compares_is_asked_for_no_loop_gain(faulty, unit, ratio):
    """A pressure that drives a mass, and the speed of a pump: the ratios are those of the machine in question."""
    runs = [replace(run, gain=None, units={**run.units, "command": unit}) for run in faulty.matrix.runs]
    bare = replace(faulty.matrix, runs=tuple(runs), actuator=replace(faulty.matrix.actuator, piston_area=None))
    said = {finding.code: finding.text for finding in check(bare)}
    assert "no-gain" not in said
    assert ratio in said["no-piston-area"]


def test_missing_runs_to_verify_and_to_fit_are_found(faulty):
    assert faulty.all_runs(use="fit").found() == {(None, "no-verify-runs"): "doubt"}
    assert faulty.all_runs(use="verify").found() == {(None, "no-fit-runs"): "fault"}


def test_what_is_not_stated_is_said_with_what_follows(faulty):
    matrix = replace(faulty.matrix, actuator=replace(faulty.matrix.actuator, piston_area=None))
    open_ended = type(faulty)(matrix).all_runs(gain=None, specimen=None, amplitude=None)
    codes = {code for _, code in open_ended.found()}
    assert codes == {"no-piston-area", "no-gain", "no-specimen", "one-condition"}
    assert set(open_ended.found().values()) == {"note"}
    assert "Z0/A^2" in open_ended.text("no-piston-area")
    assert "run-0, run-1, run-2 and 6 more" in open_ended.text("no-gain")


def test_a_verification_outside_the_gains_of_the_fit_is_said(faulty):
    assert faulty.run(2, gain=12.0, use="verify").found()["run-2", "extrapolation"] == "note"


@pytest.mark.parametrize(("share", "severity"), [(0.02, None), (0.2, "note"), (3.0, "doubt")])
def test_an_offset_is_said(faulty, share, severity):
    samples = faulty.matrix.runs[0].measured
    found = faulty.channel(0, "displacement", samples + share * samples.std()).found()
    assert found.get(("run-0", "offset")) == severity


def test_a_force_against_its_specimen_is_found(faulty):
    run = faulty.matrix.runs[0]
    x = displacement_of(run.command, SPECIMENS[0], 5.0)
    acceleration = np.gradient(np.gradient(x)) * run.sample_rate**2
    force = SPECIMENS[0].stiffness * x + SPECIMENS[0].mass * acceleration
    assert faulty.channel(0, "force", force, "N").found() == {}
    assert faulty.channel(0, "force", -force, "N").found() == {("run-0", "force-sign"): "doubt"}


def test_values_that_the_machine_cannot_reach_are_found(faulty):
    matrix = replace(faulty.matrix, actuator=replace(faulty.matrix.actuator, stroke=0.001, supply_pressure=2e7))
    pressure = 3e7 * np.sin(np.arange(8192.0))
    found = type(faulty)(matrix).channel(0, "load_pressure", pressure, "Pa").found()
    assert found["run-0", "beyond-stroke"] == "fault"
    assert found["run-0", "beyond-supply"] == "doubt"


def test_faults_come_first(faulty):
    severities = [finding.severity for finding in check(faulty.all_runs(use="verify", gaps=1).matrix)]
    assert severities == ["fault"] + ["doubt"] * 9


def test_every_finding_is_a_line_that_names_its_run(faulty):
    found = check(faulty.all_runs(gaps=1, clock_jitter=0.9, amplitude=1.0, use="fit").matrix)
    assert len(found) > 20
    for finding in found:
        assert "\n" not in finding.text
        assert finding.run is None or finding.run in finding.text
        assert finding.key in MESSAGES
        assert json.loads(json.dumps(finding.values)) == finding.values


def test_very_short_and_unitless_records_are_checked_without_error(healthy):
    for length in (8, 16, 40, 300):
        runs = [
            replace(run, channels={name: values[:length] for name, values in run.channels.items()})
            for run in healthy.runs
        ]
        found = check(replace(healthy, runs=tuple(runs)))
        assert ("few-samples" in {one.code for one in found}) == (length < 17)  # six of the runs are to fit
    for output in ("1", "m"):
        run = replace(
            healthy.runs[0], units={"command": "1", "displacement": output}, time_unit="sample", sample_rate=1.0
        )
        check(Matrix(healthy.actuator, (run,)))


def test_the_summary_counts_what_is_there(healthy):
    summary = describe(healthy)
    assert (summary.serial, summary.fit_runs, summary.verify_runs, summary.specimens) == ("SW-1", 6, 3, 3)
    assert summary.gains == (5.0, 6.0, 10.0)
    assert summary.duration == 18.0
    first = summary.runs[0]
    assert (first.id, first.samples, first.duration, first.mass) == ("run-0", 8192, 2.0, 0.87)
    assert first.rms["command"] == pytest.approx(0.00127)
    unknown = replace(healthy, runs=(replace(healthy.runs[0], specimen=None, time_unit="sample"),))
    assert describe(unknown).duration is None
    assert describe(unknown).runs[0].mass is None


DOUBTED = {
    "mr_damper": {"turned-sign"},  # its README: turned in sign
    "rack": {"no-verify-runs"},  # one record, fitted only
    "wheel_loader": {"missing-input"},  # the lever that lowers the boom
}
"""What the README of a measured record confirms."""


def test_measured_records_raise_no_doubt_but_what_is_known_of_them(measured_data, full):
    """No step that is answered too quickly where a counter does not see the sign, no lever clipped at its stop.

    In the short form every third.
    """
    folders = sorted(path.parent for path in measured_data.glob("*/matrix.yaml"))
    assert len(folders) >= 21
    for folder in folders if full else folders[::3]:
        found = {finding.code for finding in check(read_matrix(folder)) if finding.severity != "note"}
        assert found == DOUBTED.get(folder.name, set()), folder.name


@pytest.mark.parametrize(("unit", "top", "doubted"), [("1", 1.0, False), ("1", 0.8, True), ("V", 1.0, True)])
def test_a_share_of_full_scale_may_end_at_full_scale(faulty, unit, top, doubted):
    """A lever at its stop is not cut off; one that never gets there is, and so are volts."""
    time = np.arange(8192) / 4096
    lever = np.clip(1.6 * np.sin(2 * np.pi * 3 * time), -top, top)
    run = faulty.channel(0, "command", lever, unit).run(0, kind="other", amplitude=None)
    assert (("run-0", "clipping") in run.found()) is doubted


def test_a_delay_is_not_told_where_none_fits_as_well(monkeypatch):
    """One run alone: what lies between half a sample early and one late says nothing of a delay."""
    u = np.random.default_rng(3).standard_normal(2000)
    run = Run("r", "", 100.0, {"command": u, "displacement": u}, {"command": "N", "displacement": "m"})
    for shortest, told in ((-0.5, False), (0.5, True)):
        monkeypatch.setattr("ident.checks.delay.delay", lambda *_, low=shortest: Delay(0.8, low, 1.0, 0.05))
        assert bool(list(delays([(run, None)]))) is told


def test_the_offset_and_the_unknowns_of_the_measured_machine_are_noted(measured_data):
    codes = {finding.code for finding in check(read_matrix(measured_data / "mts_actuator"))}
    assert codes == {"offset", "no-piston-area", "no-gain", "no-specimen", "one-condition"}
