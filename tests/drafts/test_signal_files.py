"""Files of one signal each are the runs that their names tell, on one clock."""

from __future__ import annotations

import numpy as np
import pytest

from ident.drafts.answers import Answer, Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from ident.drafts.signal_files import named_runs, with_runs_joined
from ident.drafts.text import drafted, gathered
from ident.errors import Unusable

TIME = np.arange(200) / 100


def of(value, time=TIME, head=""):
    """A text of a signal and its times, below a heading."""
    rows = [f"{t:.6f}{',' if head else ' '}{x:.9f}" for t, x in zip(time, value(np.asarray(time)), strict=True)]
    return "\n".join([*([head] if head else []), *rows, ""]).encode()


def sine(t):
    return np.sin(9 * t)


def cosine(t):
    return np.cos(9 * t)


@pytest.mark.parametrize(
    ("names", "runs"),
    [
        (
            ("pos1_A.txt", "vel1_A.txt", "tau1_A.txt", "pos1_B.txt", "vel1_B.txt"),
            {"1_A": ["pos", "vel", "tau"], "1_B": ["pos", "vel"]},
        ),
        (("command_mm.txt", "position_mm.txt"), {"run": ["command_mm", "position_mm"]}),
        (("A/pos.txt", "A/vel.txt", "B/pos.txt", "B/vel.txt"), {"A": ["pos", "vel"], "B": ["pos", "vel"]}),
        (("load_test_2_pos.csv", "load_test_2_vel.csv"), {"load_test_2": ["pos", "vel"]}),
        (
            ("current_A.csv", "vel_A.csv", "current_B.csv", "vel_B.csv"),
            {"A": ["current", "vel"], "B": ["current", "vel"]},
        ),
        (("SCOPE_CH1.csv", "SCOPE_CH2.csv"), {"SCOPE": ["CH1", "CH2"]}),
        (("PositionRun1.csv", "VelocityRun1.csv"), {"Run1": ["Position", "Velocity"]}),
        (("est_pos1_05_exp1.txt", "est_q1_05_exp1.txt"), {"est_1_05_exp1": ["pos", "q"]}),
        (("run1_pos.csv", "run2_pos.csv"), {}),
        (("a.csv", "b.csv", "c.csv"), {}),
    ],
)
def test_a_run_is_the_files_whose_names_differ_by_the_signal(names, runs):
    assert {run: list(signals.values()) for run, signals in named_runs(names).items()} == runs


def test_several_runs_of_several_files_are_a_matrix():
    """Neither the order of the files nor a file that is a run by itself matters."""
    files = [
        ("vel1_B.txt", of(cosine)),
        ("pos1_A.txt", of(sine)),
        ("whole.csv", b"t,x,y\n0,1,2\n1,3,4\n"),
        ("pos1_B.txt", of(sine)),
        ("vel1_A.txt", of(cosine)),
    ]
    whole = with_runs_joined(files)
    assert [name for name, _ in whole] == ["1_B.csv", "1_A.csv", "whole.csv"]
    assert whole[2] == files[2]
    runs = [read_raw(data, name) for name, data in whole[:2]]
    answers = Answers("S", {"command": Answer("vel", "deg/s"), "displacement": Answer(unit="deg")}, Answer(unit="s"))
    draft = Draft(runs, answers)
    assert "1_A.csv is joined from pos1_A.txt, vel1_A.txt" in draft.doubts
    matrix = drafted(gathered(draft, [data for _, data in whole[:2]]))
    assert [run.id for run in matrix.runs] == ["1_B", "1_A"]
    for run in matrix.runs:
        assert run.sample_rate == pytest.approx(100)
        np.testing.assert_allclose(run.measured, np.radians(sine(TIME)), atol=1e-9)


@pytest.mark.parametrize("signals", [("d1", "u"), ("a6", "d1", "u")])
def test_the_remark_that_tells_of_files_without_names_has_no_names_of_columns(signals):
    """It has as many commas as the table; the columns keep the names that their files gave them."""
    values = [f"{value:.6f}" for value in np.sin(TIME)]
    files = [(f"{one}_{run}.txt", "\n".join(values).encode()) for run in ("A", "B") for one in signals]
    whole = with_runs_joined(files)
    assert [name for name, _ in whole] == ["A.csv", "B.csv"]
    for name, data in whole:
        assert tuple(one.name for one in read_raw(data, name).columns) == signals


def test_signals_with_clocks_of_their_own_are_brought_to_the_fastest_and_it_is_said():
    """Over the time that all cover, in seconds where one clock counts milliseconds; sin and cos tell how well."""
    slow = 1000 * (np.arange(120) / 50 - 0.1)
    files = [
        ("pos.txt", of(sine, TIME + 0.0037, "time [s],value")),
        ("vel.txt", of(lambda t: cosine(t / 1000), slow, "time [ms],value")),
    ]
    ((name, data),) = with_runs_joined(files)
    read = read_raw(data, name)
    assert "their times differ, so all signals were resampled to 100 Hz" in read.remarks[0]
    time, position, velocity = (read.samples(number) for number in range(3))
    assert (read.columns[0].unit, time[0], len(time)) == ("s", pytest.approx(0.0037), 200)
    np.testing.assert_allclose(position, sine(time), atol=2e-3)
    np.testing.assert_allclose(velocity, cosine(time), atol=2e-3)


def test_a_time_in_a_file_of_its_own_is_the_time():
    files = [("time.txt", b"0.0\n0.1\n0.2\n"), ("pos.txt", b"1\n2\n3\n"), ("cmd.txt", b"4\n5\n6\n")]
    ((_, data),) = with_runs_joined(files)
    assert data.decode().splitlines()[1:3] == ['"time","pos","cmd"', "0.0,1.0,4.0"]


@pytest.mark.parametrize(
    ("files", "code"),
    [
        ([("pos.txt", of(sine)), ("vel.txt", of(sine, TIME + 9))], "unequal-times"),
        ([("pos.txt", of(sine)), ("vel.txt", of(sine, TIME * 2, "time [s],v"))], "unequal-times"),
        ([("pos.txt", of(sine)), ("vel.txt", of(sine, np.arange(40) / 20 * 50))], "bad-resample"),
        ([("pos.txt", b"1\n2\n3\n"), ("vel.txt", b"1\n2\n")], "unequal-lengths"),
        ([("pos.txt", of(sine)), ("vel.txt", b"1\n2\n")], "unequal-lengths"),
        ([("a.txt", b"1\n2\n"), ("a.txt", b"1\n2\n")], "duplicate-file"),
    ],
)
def test_files_that_are_no_run_are_refused_in_a_line(files, code):
    with pytest.raises(Unusable) as refused:
        with_runs_joined(files)
    assert refused.value.code == code
    assert "\n" not in str(refused.value)


def test_a_file_of_two_signals_is_not_joined_though_its_name_says_one():
    files = [(f"{name}.csv", b"t,x,y\n0,1,2\n1,3,4\n2,4,5\n") for name in ("position", "velocity")]
    assert with_runs_joined(files) == files


def test_everything_that_is_missing_is_asked_in_one_command_that_names_what_can_be_known():
    """The column of times that has no name, and the one column that is left for the command."""
    rows = "\n".join(f"{n / 100},{n % 7},{n % 5}" for n in range(50))
    plain = Draft([read_raw(rows.encode(), "a.csv")], Answers())
    assert plain.options == (
        "--serial SERIAL",
        "--channel command=COLUMN:UNIT",
        "--channel displacement=COLUMN:UNIT",
        "--time 0:UNIT",
    )
    named = Draft(
        [read_raw(f"t,x pos,the drive\n{rows}".encode(), "a.csv")], Answers("S", {"displacement": Answer("x pos")})
    )
    assert named.options == ("--channel command='the drive':UNIT", "--channel displacement=:UNIT", "--time :UNIT")
    stated = Draft(
        [read_raw(f"t [s],x pos [mm],the drive [V]\n{rows}".encode(), "a.csv")],
        Answers("S", {"displacement": Answer("x pos [mm]")}),
    )
    assert stated.options == ("--channel command='the drive [V]'",)
    assert [one.is_whole for one in (plain, named, stated)] == [False, False, True]


def test_one_column_that_is_left_is_not_named_for_two_channels():
    rows = "\n".join(f"{20 + n},{n % 7}" for n in range(50))
    heated = Draft([read_raw(f"temperature (degC),strain\n{rows}".encode(), "a.csv")], Answers("S"))
    assert heated.options == ("--channel command=COLUMN:UNIT", "--channel displacement=COLUMN:UNIT", "--rate 'RATE Hz'")


def test_what_is_missing_of_some_files_is_asked_of_each_of_them():
    rows = "\n".join(f"{n},{n % 7}" for n in range(50))
    files = [
        read_raw(f"{names}\n{rows}".encode(), name)
        for names, name in (("cmd [mm],pos", "a.csv"), ("cmd [mm],pos", "b.csv"), ("cmd [mm],pos [mm]", "c.csv"))
    ]
    draft = Draft(files, Answers("S", rate="1 kHz"))
    assert draft.options == ("--channel displacement@a.csv=:UNIT", "--channel displacement@b.csv=:UNIT")
