"""`servoident init`, as a user runs it."""

from __future__ import annotations

import gzip
import os
import subprocess
import sys

import numpy as np
import pytest

from ident.readers import read_matrix
from tests.cases import CASES


@pytest.fixture
def record(tmp_path):
    """A record whose columns nobody can name and whose units nobody can know."""
    t = np.arange(400) / 200
    rows = np.column_stack([t, np.sin(9 * t), np.sin(9 * t - 0.1)])
    np.savetxt(tmp_path / "a.csv", rows, "%.6f", ",", header="time,c0,c1", comments="")
    return tmp_path / "a.csv"


def test_off_a_terminal_everything_that_is_missing_is_listed_and_nothing_written(servoident, record, tmp_path):
    done = servoident("init", record, "--out", tmp_path / "m")
    assert done.returncode == 2
    for option in ("--serial SERIAL", "--channel command=COLUMN:UNIT", "--channel displacement=", "--time :UNIT"):
        assert option in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "m").exists()


def test_with_answers_as_options_a_matrix_is_written_that_check_takes(servoident, record, tmp_path):
    """Commented, with the doubts of the check; a second time it is not written over."""
    given = ("--serial", "SW-1", "--channel", "command=c0:mm", "--channel", "displacement=2:mm", "--time", "time:s",
             "--gain", "7", "--area", "497 mm^2", "--out", tmp_path / "m")  # fmt: skip
    done = servoident("init", record, *given)
    assert done.returncode == 0, done.stderr
    assert "specimen is not given" in done.stdout
    assert "hold: linear" in done.stdout
    text = (tmp_path / "m" / "matrix.yaml").read_text()
    assert text.startswith("# ")
    run = read_matrix(tmp_path / "m").runs[0]
    assert (run.sample_rate, run.gain, run.units) == (200.0, 7.0, {"command": "m", "displacement": "m"})
    assert servoident("check", tmp_path / "m").returncode == 0
    again = servoident("init", record, *given)
    assert (again.returncode, "there is a matrix.yaml" in again.stderr) == (2, True)


KNOWN = ("--channel", "command=c0:mm", "--channel", "displacement=2:mm", "--time", "time:s")


def test_without_a_folder_it_is_named_as_the_serial_number(servoident, record, tmp_path, monkeypatch):
    """What is missing is told first, all at once; a serial number that names no folder is refused."""
    monkeypatch.chdir(tmp_path)
    assert "--serial SERIAL" in servoident("init", record).stderr
    assert servoident("init", record, "--serial", "SW-3", *KNOWN).returncode == 0
    assert read_matrix(tmp_path / "SW-3").actuator.serial == "SW-3"
    again = servoident("init", record, "--serial", "SW-3", *KNOWN)
    assert (again.returncode, "name another folder with --out" in again.stderr) == (2, True)
    for serial in ("../SW-3", ".", "..", "a/b"):
        refused = servoident("init", record, "--serial", serial, *KNOWN)
        assert (refused.returncode, "name one with --out" in refused.stderr) == (2, True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["SW-3", "a.csv"]


@pytest.mark.parametrize(("file", "name"), [("b.csv", "b"), ("b.csv", "b.csv"), ("b.csv.gz", "b")])
def test_a_run_to_verify_is_named_with_its_suffixes_or_without(servoident, record, tmp_path, file, name):
    second = record.read_bytes().replace(b",0.9", b",0.8")
    (tmp_path / file).write_bytes(gzip.compress(second) if file.endswith(".gz") else second)
    (tmp_path / "c.csv").write_bytes(record.read_bytes().replace(b",0.9", b",0.7"))
    files = [record, tmp_path / file, tmp_path / "c.csv"]
    made = servoident("init", *files, "--serial", "SW-4", *KNOWN, "--verify", name, "--out", tmp_path / "m")
    assert made.returncode == 0, made.stderr
    assert [run.file for run in read_matrix(tmp_path / "m").of_use("verify")] == [f"runs/{file}"]


def test_a_run_to_verify_that_is_none_of_the_files_or_two_is_refused(servoident, record, tmp_path):
    (tmp_path / "a.txt").write_bytes(record.read_bytes())
    files = (record, tmp_path / "a.txt", "--serial", "SW-5", *KNOWN, "--out", tmp_path / "m")
    for name, what in (("d", "'d' is none of the files"), ("a", "'a' is more than one of the files")):
        refused = servoident("init", *files, "--verify", name)
        assert (refused.returncode, what in refused.stderr, "a.csv, a.txt" in refused.stderr) == (2, True, True)
    assert not (tmp_path / "m").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminal")
def test_on_a_terminal_what_is_missing_is_asked(record, tmp_path):
    """One question after another; an answer that names no column is asked again."""
    import pty

    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "app.cli", "init", str(record), "--out", str(tmp_path / "m")]
    with subprocess.Popen(command, stdin=theirs, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        os.write(ours, b"SW-2\nnothing\nc0:mm\nc1:mm\ns\n")
        said, errors = running.communicate(timeout=120)
    os.close(ours)
    os.close(theirs)
    assert running.returncode == 0, errors
    assert "there is no column 'nothing'" in errors
    assert said.count("is the command") == 2
    assert read_matrix(tmp_path / "m").actuator.serial == "SW-2"


def test_a_folder_stands_for_the_records_in_it(servoident, tmp_path):
    folder = tmp_path / "raw"
    folder.mkdir()
    done = servoident("init", folder)
    assert (done.returncode, "the folder holds no records" in done.stderr) == (2, True)
    for name in ("b.csv", "a.csv", "notes.md"):
        (folder / name).write_text(
            "time_s,command_mm,displacement_mm\n" + "".join(f"{i / 100},{i},{i}\n" for i in range(9))
        )
    done = servoident("init", folder)
    assert f"replace the words in capitals, and type: servoident init {folder} --serial SERIAL" in done.stderr
    done = servoident("fit", folder)
    assert f"write one with `servoident init {folder}`" in done.stderr


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_files_of_any_form_are_one_matrix(servoident, case, tmp_path):
    """What is said of all files, and what of some of them by their name or a pattern, with @."""
    said = []
    for at, file in enumerate(case.files):
        pattern = file.name if at else f"{file.name[:4]}*{file.name[5:]}"
        time, *channels = (f"{column}:{unit}" for column, unit in zip(file.columns, file.units, strict=True))
        said += ["--time", f"@{pattern}={time}"]
        for channel, value in zip(("command", "displacement"), channels, strict=True):
            said += ["--channel", f"{channel}@{pattern}={value}"]
    made = servoident("init", *case.paths(), "--serial", "CASE", *said, "--out", tmp_path / "m")
    assert made.returncode == 0, made.stderr
    case.right(read_matrix(tmp_path / "m").runs)


def test_a_rate_and_columns_of_some_files_are_said_with_their_name(servoident, record, tmp_path):
    """One answer for all, another for a file; a file that is not there is refused, as is half an option."""
    (tmp_path / "b.csv").write_bytes(record.read_bytes().replace(b"time,c0,c1", b"n,first,second"))
    files = (record, tmp_path / "b.csv")
    some = ("--channel", "command=c0:mm", "--channel", "displacement=2:mm", "--time", "@a*=time:s",
            "--channel", "command@b=first:in", "--channel", "displacement@b=second:cm", "--serial", "S")  # fmt: skip
    missing = servoident("init", *files, *some, "--out", tmp_path / "m")
    assert missing.stderr.endswith(" --time @b.csv=n:UNIT\n")
    made = servoident("init", *files, *some, "--rate", "@b.csv=50 Hz", "--out", tmp_path / "m")
    assert made.returncode == 0, made.stderr
    first, second = read_matrix(tmp_path / "m").runs
    assert (first.sample_rate, second.sample_rate) == (200.0, 50.0)
    np.testing.assert_allclose(second.command, 25.4 * first.command)
    np.testing.assert_allclose(second.measured, 10 * first.measured)
    for option, what in (("command@z=first:in", "'z' is none of the files"), ("command@b", "write --channel NAME=")):
        refused = servoident("init", *files, *KNOWN, "--channel", option)
        assert (refused.returncode, what in refused.stderr) == (2, True)
    refused = servoident("init", *files, *KNOWN, "--rate", "@b.csv")
    assert (refused.returncode, "write --rate @FILE=VALUE" in refused.stderr) == (2, True)


def test_command_and_output_in_files_of_their_own_are_to_be_joined(servoident, record, tmp_path):
    """Two loggers of several columns each: no option says that two files are one run."""
    other = tmp_path / "b.csv"
    other.write_text(record.read_text())
    done = servoident("init", record, other, "--serial", "SW-1", "--channel", "command@a.csv=c0:mm", "--channel",
                      "displacement@b.csv=c1:mm", "--time", "time:s", "--out", tmp_path / "m")  # fmt: skip
    assert done.returncode == 2
    assert "servoident join A.csv B.csv --out run.csv" in done.stderr
    assert done.stderr.count("\n") == 1


def test_the_layout_of_a_text_is_stated_as_an_option(servoident, tmp_path):
    """Of all files or of some; what stands in matrix.yaml is what was stated, and a word that is none is refused."""
    rows = "".join(f"{n / 100:g};{n % 7};{n % 5}\n" for n in range(50))
    (tmp_path / "a.csv").write_text(f"time [s];command [mm];position [mm]\n1;1;1\n2;2;2\n3;3;3\n{rows}")
    made = servoident("init", tmp_path / "a.csv", "--serial", "A", "--out", tmp_path / "m",
                      "--dialect", "header_rows=4", "--dialect", "@a*=delimiter=semicolon")  # fmt: skip
    assert made.returncode == 0, made.stderr
    assert "dialect: {delimiter: semicolon, header_rows: 4}" in (tmp_path / "m" / "matrix.yaml").read_text()
    for stated, said in (("delimiter=dot", "'dot' is not a delimiter"), ("signs=comma", "a dialect has no 'signs'")):
        refused = servoident("init", tmp_path / "a.csv", "--serial", "A", "--dialect", stated)
        assert refused.returncode == 2
        assert said in refused.stderr


def test_a_share_of_each_run_is_validation_data(servoident, record, tmp_path):
    given = ("--serial", "SW-1", *KNOWN, "--out", tmp_path / "m", "--validation")
    done = servoident("init", record, *given, "0.25")
    assert done.returncode == 0, done.stderr
    assert "split: {validation: [300, 400]}" in (tmp_path / "m" / "matrix.yaml").read_text()
    assert [(run.id, run.use) for run in read_matrix(tmp_path / "m").runs] == [("a", "fit"), ("a.validation", "verify")]
    refused = servoident("init", record, *given[:-3], "--validation", "30")
    assert refused.returncode == 2
    assert "a share of 30 of every run cannot be validation data" in refused.stderr


def test_a_run_to_verify_that_is_named_by_itself_is_one_of_the_runs(servoident, record, tmp_path):
    """A file that is there need not be named twice."""
    (tmp_path / "b.csv").write_bytes(record.read_bytes().replace(b",0.9", b",0.8"))
    given = ("--serial", "SW-6", *KNOWN, "--verify", tmp_path / "b.csv", "--out", tmp_path / "m")
    made = servoident("init", record, *given)
    assert made.returncode == 0, made.stderr
    matrix = read_matrix(tmp_path / "m")
    assert [[run.id for run in matrix.of_use(use)] for use in ("fit", "verify")] == [["a"], ["b"]]
