"""Small raw files of many programs, each three ways: `servoident init`, a draft over HTTP, and `read_matrix`.

What is right for each stands in ../shared/cases/README.md; the samples are read here by numpy alone.
"""

from __future__ import annotations

import shlex
from dataclasses import dataclass, field

import numpy as np
import pytest

from ident.errors import Unusable
from ident.readers import read_matrix
from tests.cases import CASES as MATRICES
from tests.cases import FOLDER, RATE

API = "/api/v1"
SAMPLES = 1500
COMMA = dict.fromkeys(("command", "displacement"), "mm")
FILES = {file.name: file for one in MATRICES for file in one.files}


@dataclass(frozen=True)
class Case:
    """A file by its name, the units in which its columns are, and what has to be said besides a serial.

    `asked` are the keys of what is missing, `told` is a part of what is said of it.
    """

    name: str
    units: tuple[str, str, str] = ("s", "mm", "mm")
    asked: frozenset[str] = frozenset()
    told: str = ""

    @property
    def columns(self) -> tuple[str, str, str]:
        """The names of its time, command and displacement."""
        return FILES[self.name].columns


UNITS = frozenset({"unit command", "unit displacement", "unit time"})
IN_MS = ("ms", "mm", "mm")
CASES = (
    Case("comma_plain.csv", asked=UNITS),
    Case("comma_units_row.csv"),
    Case("comma_units_in_names.csv"),
    Case("comma_preamble.csv"),
    Case("comma_tabs.txt", asked=UNITS),
    Case("units_a.csv", IN_MS),
    Case("units_b.csv"),
    Case("names_a.csv", IN_MS, told="'time_ms' is read in ms"),
    Case("names_b.csv", told="'t_s' is read in s"),
    Case("two_header_rows.csv", IN_MS),
    Case("interval_rows.csv", told="has no unit; seconds are assumed"),
    Case("iso_time.csv"),
    Case("cut_last_row.csv", asked=UNITS, told="line 1502, the last one, is cut off (2 of 3 fields) and was left out"),
)


@pytest.fixture(params=CASES, ids=lambda case: case.name)
def case(request) -> Case:
    if not (FOLDER / request.param.name).is_file():
        pytest.skip(f"no small files: {FOLDER} does not hold {request.param.name}")
    found: Case = request.param
    return found


def is_right(runs, case: Case) -> None:
    """One run at 1 kHz of 1.5 s, every sample of it as it stands in the file."""
    (run,) = runs
    assert run.sample_rate == pytest.approx(RATE, rel=1e-6)
    assert (run.length, run.units) == (SAMPLES, {"command": "m", "displacement": "m"})
    np.testing.assert_allclose([run.command, run.measured], FILES[case.name].truth(), rtol=1e-12)


def test_init_reads_it_or_asks_for_exactly_what_the_file_does_not_state(servoident, case, tmp_path):
    refused = servoident("init", FOLDER / case.name, "--out", tmp_path / "m")
    assert refused.returncode == 2
    options = {
        "unit command": "--channel command=:UNIT",
        "unit displacement": "--channel displacement=:UNIT",
        "unit time": "--time :UNIT",
    }
    asked = {"--serial SERIAL", *(options[key] for key in case.asked)}
    command = refused.stderr.strip().rpartition(f" --out {tmp_path / 'm'} ")[2]
    assert {f"--{option}" for option in f" {command}".split(" --")[1:]} == asked
    given = ["--channel", "command=:mm", "--channel", "displacement=:mm", "--time", ":s"] if case.asked else []
    done = servoident("init", FOLDER / case.name, "--serial", "A", *given, "--out", tmp_path / "m")
    assert done.returncode == 0, done.stderr
    assert case.told in done.stdout
    is_right(read_matrix(tmp_path / "m").runs, case)


def test_a_draft_over_http_reads_it_or_asks_for_exactly_what_the_file_does_not_state(service, case, tmp_path):
    content = (FOLDER / case.name).read_bytes()
    draft = service.post(f"{API}/drafts", files=[("files", (case.name, content))]).json()
    assert {one["key"] for one in draft["missing"]} == {"serial", *case.asked}
    roles = {column["role"]: (column["name"], column["unit"]) for column in draft["files"][0]["columns"]}
    for role, name, unit in zip(("time", "command", "displacement"), case.columns, case.units, strict=True):
        assert roles[role] == (name, "" if case.asked else unit)
    assert any(case.told in doubt for doubt in draft["doubts"])
    unit = {"unit": "mm"}
    given = {"channels": {"command": unit, "displacement": unit}, "time": {"unit": "s"}} if case.asked else {}
    answers = {"serial": case.name, **given}
    described = service.post(f"{API}/drafts/{draft['id']}", json=answers).json()["description"]
    made = service.post(f"{API}/drafts/{draft['id']}/matrix", json=answers)
    assert made.status_code == 201, made.text
    assert [run["sample_rate"] for run in made.json()["runs"]] == [pytest.approx(RATE, rel=1e-6)]
    (tmp_path / "matrix.yaml").write_text(described, encoding="utf-8")
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs" / case.name).write_bytes(content)
    is_right(read_matrix(tmp_path).runs, case)


def test_read_matrix_reads_it_under_the_names_of_its_columns(case):
    """Without a word of the units it says which columns they seem to be, with the units that the file states."""
    time, command, displacement = case.columns
    with pytest.raises(Unusable, match="does not state its units") as refused:
        read_matrix(FOLDER / case.name)
    unit = "UNIT" if case.asked else "mm"
    assert f"units={dict.fromkeys(('command', 'displacement'), unit)}" in refused.value.remedy
    assert f"columns={ {'command': command, 'displacement': displacement} }" in refused.value.remedy
    assert f"'column': {time!r}" in refused.value.remedy
    matrix = read_matrix(
        FOLDER / case.name,
        units={"command": case.units[1], "displacement": case.units[2]},
        columns={"command": command, "displacement": displacement},
        time={"column": time, "unit": case.units[0]},
    )
    is_right(matrix.runs, case)
    assert "cut off" not in case.told or any(case.told in one for one in matrix.notices)


def test_a_time_stamp_is_in_seconds_and_in_nothing_else():
    if not (FOLDER / "iso_time.csv").is_file():
        pytest.skip("no small files")
    with pytest.raises(Unusable, match="seconds") as refused:
        read_matrix(
            FOLDER / "iso_time.csv",
            units=COMMA,
            columns={"command": 1, "displacement": 2},
            time={"column": 0, "unit": "ms"},
        )
    assert refused.value.code == "time-stamps"


def test_two_files_of_other_names_and_units_are_one_matrix(servoident, tmp_path):
    """What each states of itself holds for itself."""
    for pair in ("units", "names"):
        files = [FOLDER / f"{pair}_{one}.csv" for one in "ab"]
        if not files[0].is_file():
            pytest.skip("no small files")
        done = servoident("init", *files, "--serial", "A", "--out", tmp_path / pair)
        assert done.returncode == 0, done.stderr
        for run in read_matrix(tmp_path / pair).runs:
            assert (run.sample_rate, run.duration) == (pytest.approx(RATE), pytest.approx(1.5, abs=2e-3))


def test_files_of_one_signal_are_a_run_of_which_the_rate_alone_is_asked(servoident, service, tmp_path):
    """By `init`, on the page's way and by `join`: the joined samples are those of the files."""
    files = sorted((FOLDER / "one_file_a_signal").glob("*.txt"))
    if len(files) != 2:
        pytest.skip("no small files")
    asked = servoident("init", *files, "--serial", "A", "--out", tmp_path / "m")
    assert asked.returncode == 2
    command = asked.stderr.strip().rpartition("servoident ")[2]
    assert command.endswith("--rate 'RATE Hz'")
    assert servoident(*shlex.split(command.replace("RATE", "1000"))).returncode == 0
    sent = [("files", (file.name, file.read_bytes())) for file in files]
    draft = service.post(f"{API}/drafts", files=sent).json()
    assert ([one["name"] for one in draft["files"]], [one["key"] for one in draft["missing"]]) == (
        ["run.csv"],
        ["serial", "rate"],
    )
    assert any("joined from command_mm.txt, position_mm.txt" in one for one in draft["doubts"])
    joined = ("join", *files, "--out", tmp_path / "run.csv")
    assert servoident(*joined).returncode == 0
    assert servoident(*joined).returncode == 2  # nothing is written over
    assert (tmp_path / "run.csv").read_bytes() == (tmp_path / "m/runs/one_file_a_signal.csv").read_bytes()
    (run,) = read_matrix(tmp_path / "m").runs
    np.testing.assert_allclose([run.command, run.measured], [1e-3 * np.loadtxt(file) for file in files], rtol=1e-12)


@dataclass(frozen=True)
class Log:
    """The tables of a drive's log: columns by position."""

    given: tuple[str, ...] = (
        "--channel",
        "command=1:V",
        "--channel",
        "displacement=3:m",
        "--channel",
        "velocity=5:m/s",
        "--time",
        "0:s",
    )
    tests: tuple[str, ...] = field(default=("slow-forward", "slow-backward", "fast-forward", "fast-backward"))


def test_a_log_of_several_tests_is_as_many_runs_whose_columns_are_asked_by_position(servoident, service, tmp_path):
    import json

    file, log = FOLDER / "sysid_log.json", Log()
    if not file.is_file():
        pytest.skip("no small files")
    truth = json.loads(file.read_text())
    refused = servoident("init", file, "--serial", "A", "--out", tmp_path / "m")
    assert refused.returncode == 2
    assert "which column of sysid_log.json (slow-forward/0, slow-forward/1" in refused.stderr
    done = servoident("init", file, "--serial", "A", *log.given, "--out", tmp_path / "m")
    assert done.returncode == 0, done.stderr
    draft = service.post(f"{API}/drafts", files=[("files", (file.name, file.read_bytes()))]).json()
    assert {one["key"] for one in draft["missing"]} == {"serial", "channel command", "channel displacement", "rate"}
    made = service.post(
        f"{API}/drafts/{draft['id']}/matrix",
        json={
            "serial": "LOG",
            "time": {"column": 0, "unit": "s"},
            "channels": {"command": {"column": 1, "unit": "V"}, "displacement": {"column": 3, "unit": "m"}},
        },
    )
    assert [run["id"] for run in made.json()["runs"]] == list(log.tests), made.text
    runs = read_matrix(tmp_path / "m").runs
    assert [run.id for run in runs] == list(log.tests)
    for run in runs:
        rows = np.array(truth[run.id])
        assert (run.sample_rate, run.units["velocity"]) == (pytest.approx(50), "m/s")
        np.testing.assert_allclose([run.command, run.measured, run.channels["velocity"]], rows[:, [1, 3, 5]].T)
    alone = read_matrix(
        file,
        units={"command": "V", "displacement": "m"},
        sample_rate="50 Hz",
        columns={"command": "fast-forward/1", "displacement": "fast-forward/3"},
    )
    np.testing.assert_allclose(alone.runs[0].measured, np.array(truth["fast-forward"])[:, 3])
