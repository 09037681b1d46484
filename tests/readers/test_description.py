"""A description that cannot be used says which field, and what to write instead."""

from __future__ import annotations

import pytest

from ident.errors import Unusable
from ident.matrix import Controller
from ident.readers import read_matrix
from ident.readers.channel_description import describe_channel, describe_channels
from ident.readers.description import describe
from ident.readers.limits import LIMITS, Limits

CASES = [  # what is written, by what it is replaced, code, words of the message
    ("kN/m, damping", ", damping", "missing-unit", "run first specimen stiffness: 36.3 has no unit"),
    ("497 mm^2", "497", "missing-unit", "actuator piston_area"),
    ("0.05 in", "0.05", "missing-unit", "run first amplitude"),
    ("sample_rate: 1000 Hz", "sample_rate: 1000", "missing-unit", "run first sample_rate"),
    ("{column: u, unit: mm}", "{column: u}", "missing-unit", "run first channels.command unit"),
    ("{column: u, unit: mm}", "{column: u, unit: furlong}", "unknown-unit", "channels.command unit"),
    ("497 mm^2", "497 mm^2x", "unknown-unit", "actuator piston_area"),
    ("{column: x, unit: mm}", "{column: x, unit: kN}", "wrong-dimension", "channels.displacement unit"),
    ("0.87 kg", "0.87 N", "wrong-dimension", "specimen mass"),
    ("1000 Hz", "1000 rad/s", "wrong-dimension", "use 1/s"),
    ("0.87 kg", "-0.87 kg", "negative-mass", "specimen mass"),
    ("36.3 kN/m", "-36.3 kN/m", "negative-stiffness", "specimen stiffness"),
    ("0 N*s/m", "-1 N*s/m", "negative-damping", "specimen damping"),
    ("497 mm^2", "0 mm^2", "not-positive", "piston_area"),
    ("1000 Hz", "0 Hz", "not-positive", "sample_rate"),
    ("0.05 in", "1e999 in", "not-finite", "amplitude"),
    ("gain: 7", "gain: 0", "zero-gain", "run first gain"),
    ("gain: 7", "gain: -7", "negative-gain", "run first gain"),
    ("gain: 7", "gain: nan", "not-a-quantity", "run first gain"),
    ("kind: blwn", "kind: noise", "unknown-kind", "speed-continuous"),
    ("kind: blwn", "hold: cubic", "unknown-hold", "linear, zoh"),
    ("kind: blwn", "use: train", "unknown-use", "fit, verify"),
    ("kind: blwn", "output: force", "unknown-output", "command, displacement"),
    ("kind: blwn", "output: command", "unknown-output", "response"),
    ("gain: 7", "gian: 7", "unknown-key", "did you mean gain?"),
    ("displacement: {", "displacment: {", "unknown-key", "did you mean displacement?"),
    ("displacement: {", "gain: {", "unknown-key", "take it out of channels: it stands beside channels"),
    ("gain: 7", "gain: 7\n    gain: 8", "duplicate-key", "'gain' is given twice"),
    ("command: {column: u, unit: mm}", "force: {column: u, unit: N}", "missing-command", "channels"),
    ("sample_rate: 1000 Hz", "kind: other", "duplicate-key", "kind"),
    ("    sample_rate: 1000 Hz\n", "", "clock", "neither"),
    ("sample_rate: 1000 Hz", "sample_rate: 1 kHz\n    time: {column: t, unit: s}", "clock", "both"),
    ("id: first", "id: ../first", "bad-id", "../first"),
    ("    file: runs/first.csv\n", "", "missing-field", "'file' is missing"),
    ("file: runs/first.csv", "file: ../first.csv", "outside-folder", "run first file"),
    ("file: runs/first.csv", "file: /etc/passwd", "outside-folder", "run first file"),
    ("file: runs/first.csv", "file: 'runs\\first.csv'", "outside-folder", "run first file"),
    ("file: runs/first.csv", "file: C:/first.csv", "outside-folder", "run first file"),
    ("gain: 7", "rows: [10, 5]", "bad-rows", "run first rows"),
    ("gain: 7", "rows: [10]", "not-a-pair", "run first rows"),
    ("gain: 7", "trend: curve", "unknown-trend", "none, mean, line"),
    ("kind: blwn", "kind: static\n    trend: mean", "bench-trend", "run first trend"),
    ("gain: 7", "skip_rows: -1", "not-a-number", "run first skip_rows"),
    ("gain: 7", "position_range: [2 mm, 1 mm]", "empty-range", "position_range"),
    ("unit: mm}\n      displacement", "unit: mm, scale: 0}\n      displacement", "zero-scale", "command scale"),
    ("unit: mm}\n      displacement", "unit: mm, invert: maybe}\n      displacement", "not-a-truth", "command invert"),
    ("column: u", "column: -1", "missing-column", "command column"),
    ("actuator: {serial: SW-1, ", "actuator: {", "missing-field", "'serial' is missing"),
    ("actuator: {serial: SW-1, ", "actuator: {serial: &a SW-1, ", "yaml-alias", "line 1"),
    ("gain: 7", "gain: *a", "yaml-alias", "line 7"),
    ("gain: 7", "gain: !!python/object/apply:os.system [echo]", "yaml-tag", "line 7"),
    ("gain: 7", "gain: [7", "not-yaml", "line"),
    ("gain: 7", "gain: " + "[" * 2000, "too-deep", "line 7"),
    ("actuator: {serial: SW-1, piston_area: 497 mm^2}", "actuator: SW-1", "not-a-mapping", "actuator"),
    ("gain: 7", "gain: 7\n---\n", "not-yaml", "more than one document"),
]


@pytest.mark.parametrize(("old", "new", "code", "words"), CASES, ids=[f"{case[2]}-{case[1][:24]}" for case in CASES])
def test_each_mistake_has_its_own_code_and_names_the_field(matrix, old, new, code, words):
    with pytest.raises(Unusable) as refused:
        describe(matrix.change(old, new).text.encode(), LIMITS)
    assert refused.value.code == code
    assert words in str(refused.value)
    assert refused.value.where.startswith("matrix.yaml")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    "text", ["", "runs: []\nactuator: {serial: A}", "[]", "actuator: {serial: A}", "\xff", "a: b: c"]
)
def test_a_text_that_describes_nothing_is_refused(text):
    with pytest.raises(Unusable):
        describe(text.encode("latin-1"), LIMITS)


def test_two_runs_of_one_id_are_refused_whatever_the_case(matrix):
    matrix.text += matrix.text.partition("runs:\n")[2].replace("id: first", "id: FIRST")
    with pytest.raises(Unusable, match="two runs are called 'FIRST'") as refused:
        describe(matrix.text.encode(), LIMITS)
    assert refused.value.code == "duplicate-id"


def test_a_serial_that_looks_like_a_number_keeps_its_digits(matrix):
    for serial in ("0012", "1.10", "12:30", "yes", "2014-01-01", "1e3"):
        text = matrix.text.replace("SW-1", serial)
        assert describe(text.encode(), LIMITS).actuator.serial == serial


def test_a_description_and_a_number_of_runs_beyond_the_limits_are_refused(matrix):
    matrix.text += "#" * (5 << 20)
    matrix.describe()
    with pytest.raises(Unusable, match="5 MB") as refused:
        read_matrix(matrix.path)
    assert refused.value.code == "too-large"
    matrix.text = matrix.text.rstrip("#")
    matrix.text += matrix.text.partition("runs:\n")[2].replace("id: first", "id: second")
    with pytest.raises(Unusable, match="2 runs where 1"):
        describe(matrix.text.encode(), Limits(runs=1))


def test_everything_optional_may_be_left_out():
    text = """
actuator: {serial: A}
runs:
  - {id: only, file: a.csv, sample_rate: 1 1/sample, channels: {command: {column: 0, unit: "1"},
     displacement: {column: 1, unit: 1}}}
"""
    run = describe(text.encode(), LIMITS).runs[0].labels
    assert (run.sample_rate, run.time_unit, run.units["command"]) == (1.0, "sample", "1")
    assert (run.gain, run.specimen, run.amplitude, run.Kp) == (None, None, None, 1.0)
    assert (run.kind, run.hold, run.output, run.use) == ("other", "linear", "displacement", "fit")


def test_a_bench_record_may_have_a_current_for_its_input(matrix):
    matrix.change("command: {column: u, unit: mm}", "current: {column: u, unit: mA}").change(
        "kind: blwn", "kind: static"
    )
    matrix.change(
        "amplitude: 0.05 in", "position_range: [-50 mm, 50 mm]\n    rated_current: 20 mA\n    frequency: 2 Hz"
    )
    run = describe(matrix.text.encode(), LIMITS).runs[0].labels
    assert (run.position_range, run.rated_current, run.frequency) == ((-0.05, 0.05), 0.02, 2.0)
    assert run.units["current"] == "A"


def test_the_controller_and_a_limits_file_are_read(matrix):
    matrix.text += "controller: {kp: 160.18 1/s, kv: 243.45 V*s/m}\nlimits: sheet.yaml\n"
    with pytest.raises(Unusable, match="sheet") as refused:
        read_matrix(matrix.write())
    assert refused.value.code == "missing-file"
    (matrix.path / "sheet.yaml").write_text("a: b")
    found = read_matrix(matrix.path)
    assert (found.controller, found.limits) == (Controller(160.18, 243.45), "sheet.yaml")


def test_samples_per_second_are_hertz(matrix):
    for rate in ("1000 sample/s", "1 kHz", "1000 Sa/s", "60000 1/min"):
        text = matrix.text.replace("1000 Hz", rate)
        assert describe(text.encode(), LIMITS).runs[0].labels.sample_rate == pytest.approx(1000, rel=1e-15)


@pytest.mark.parametrize(
    ("command", "output", "wanted"),
    [
        ("N*m", ("velocity", "rpm"), {"command": "N*m", "velocity": "rad/s"}),
        ("Nm", ("displacement", "deg"), {"command": "N*m", "displacement": "rad"}),
        ("deg", ("displacement", "deg"), {"command": "rad", "displacement": "rad"}),
        ("%", ("displacement", "mm"), {"command": "1", "displacement": "m"}),
        ("L/min", ("displacement", "mm"), {"command": "m^3/s", "displacement": "m"}),
        ("V", ("force", "N*m"), {"command": "V", "force": "N*m"}),
    ],
)
def test_a_command_has_any_unit_and_what_turns_is_measured_as_an_angle(command, output, wanted):
    name, unit = output
    found = describe_channels({"command": {"column": 0, "unit": command}, name: {"column": 1, "unit": unit}}, "run a")
    assert {channel: one.scale.unit for channel, one in found.items()} == wanted


@pytest.mark.parametrize(
    ("answers", "output"),
    [
        ("velocity: {column: 1, unit: rpm}", "velocity"),
        ("force: {column: 1, unit: N}", "force"),
        ("velocity: {column: 1, unit: m/s}, displacement: {column: 2, unit: m}", "displacement"),
    ],
)
def test_what_alone_was_recorded_of_the_answer_is_the_output(answers, output):
    text = f"""
actuator: {{serial: A}}
runs:
  - {{id: only, file: a.csv, sample_rate: 10 Hz, channels: {{command: {{column: 0, unit: V}}, {answers}}}}}
"""
    assert describe(text.encode(), LIMITS).runs[0].labels.output == output


def test_which_of_several_answers_is_the_output_is_asked_for():
    text = """
actuator: {serial: A}
runs:
  - {id: only, file: a.csv, sample_rate: 10 Hz, channels: {command: {column: 0, unit: V},
     velocity: {column: 1, unit: m/s}, force: {column: 2, unit: N}}}
"""
    with pytest.raises(Unusable, match="choose from command, velocity, force"):
        describe(text.encode(), LIMITS)


def test_a_bare_number_is_no_angle_and_an_angle_no_length():
    assert describe_channel({"column": 0, "unit": "1"}, "displacement", "x").scale.unit == "1"
    assert describe_channel({"column": 0, "unit": "1"}, "displacement", "x").zeroed is None
    assert describe_channel({"column": 0, "unit": "1", "zeroed": False}, "displacement", "x").zeroed is False
    assert describe_channel({"column": 0, "unit": "deg"}, "displacement", "x").scale.factor == pytest.approx(0.0174533)
    with pytest.raises(Unusable, match="does not measure velocity or angular velocity"):
        describe_channel({"column": 0, "unit": "deg"}, "velocity", "x")
    with pytest.raises(Unusable, match="does not measure a quantity that is known here"):
        describe_channel({"column": 0, "unit": "m^4/s"}, "command", "x")
