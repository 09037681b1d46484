"""Raw files described: what they state is found, what they do not state is asked, nothing is silently wrong."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
import scipy

from ident.drafts.answers import NONE, Answer, Answers, FileAnswers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from ident.drafts.text import drafted, gathered
from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.column_names import channel_of
from ident.readers.description import describe
from ident.readers.limits import LIMITS
from ident.units.quantity import unit_scale
from tests.readers.lab_files import FILES
from tests.short_form import short_form

FOLDERS = ("crane_actuator", "dc_motor", "emps", "excavator_boom", "mr_damper", "mts_actuator")


def raw(text: str, name: str = "run.csv"):
    return read_raw(text.encode(), name)


def table(*head: str, samples: int = 40) -> str:
    """Lines above, then three columns: a clock of 100 Hz, a command, a response."""
    rows = [f"{n / 100:g},{np.sin(n):.6f},{np.sin(n - 1):.6f}" for n in range(samples)]
    return "\n".join([*head, *rows, ""])


@pytest.fixture(params=short_form(FOLDERS, *(folder for folder in FOLDERS if folder != "mts_actuator")))
def measured(request, measured_data):
    """A folder of measured data: its description, its matrix, its raw files and what they hold."""
    folder = measured_data / request.param
    told = describe((folder / "matrix.yaml").read_bytes(), LIMITS)
    names = list(dict.fromkeys(run.labels.file for run in told.runs))
    contents = [(folder / name).read_bytes() for name in names]
    return folder, told, [read_raw(data, name) for data, name in zip(contents, names, strict=True)], contents


def of_file(told, file):
    """The truth about a file: the run that reads it."""
    return next(run for run in told.runs if run.labels.file == file.name)


def test_what_is_found_in_measured_files_is_the_truth_or_asked(measured):
    """Every column, unit and rate that is found is that of the folder's matrix.yaml; everything else is asked."""
    _, told, files, _ = measured
    draft = Draft(files, Answers())
    asked = {one.key for one in draft.missing}
    for file in files:
        known, truth = draft.known(file), of_file(told, file)
        for channel, answer in known.channels.items():
            right = truth.channels[channel]
            assert file.table.number(answer.column, "") == file.table.number(right.column, "")
            assert f"unit {channel}" in asked if not answer.unit else scale_of(answer.unit, right.scale) == right.scale
        if known.rate:
            assert float(known.rate.removesuffix(" Hz")) == truth.labels.sample_rate
        elif known.time.column == "":
            assert "rate" in asked
        assert file.skip_rows == truth.dialect.skip_rows
    assert "serial" in asked
    with pytest.raises(Unusable) as refused:
        gathered(draft, [b""] * len(files))
    assert refused.value.code == "not-stated"


def scale_of(unit, like):
    return unit_scale(unit, like.unit, "")


def test_with_what_was_asked_the_measured_matrix_comes_out(measured):
    """Only what is missing is answered, from matrix.yaml: the samples and the clock of every channel are the same."""
    folder, told, files, contents = measured
    answers = Answers()
    for _ in range(20):
        missing = Draft(files, answers).missing
        if not missing:
            break
        answers = answered(answers, missing[0].key, folder, of_file(told, files[0]))
    draft = Draft(files, answers)
    found, wanted = drafted(gathered(draft, contents)), read_matrix(folder)
    for run in wanted.runs:
        mine = next(one for one in found.runs if one.file.removeprefix("runs/") == run.file.removeprefix("runs/"))
        described = next(one for one in told.runs if one.labels.id == run.id)
        assert mine.sample_rate == pytest.approx(run.sample_rate, rel=1e-6)
        assert mine.time_unit == run.time_unit
        assert mine.output == run.output
        if run.evened:  # resampled to the clock of the whole record
            continue
        part = slice(*described.rows) if described.rows else slice(None)
        for channel in mine.channels:
            np.testing.assert_allclose(mine.channels[channel][part], run.channels[channel], rtol=1e-12)


def answered(answers, key, folder, truth):
    """The answers with the next one, as matrix.yaml has it."""
    from ident.readers.strict_yaml import read_yaml

    kind, _, name = key.partition(" ")
    stated = read_yaml((folder / "matrix.yaml").read_bytes(), "")["runs"][0]
    if kind == "serial":
        return replace(answers, serial="SW-1", output=truth.outputs[0])
    if kind == "rate":
        return replace(answers, rate=stated["sample_rate"])
    if name == "time":
        return replace(answers, time=Answer(stated.get("time", {"column": "time"})["column"], "s"))
    assert name in truth.channels, f"{key} is asked, which the truth does not have"
    entry = stated["channels"][name]
    return replace(answers, channels={**answers.channels, name: Answer(entry["column"], entry["unit"])})


@pytest.mark.parametrize(
    "head",
    [
        ("time [s],Command (V),Position [mm]",),
        ("time,command,position", "s,V,mm"),
        ("Bench 4", "Operator: A", "time,cmd,disp", "(s),(V),(mm)"),
    ],
)
def test_units_of_headers_and_of_a_row_below_them_are_found(head):
    """Nothing but the serial number is asked."""
    file = raw(table(*head))
    draft = Draft([file], Answers())
    assert [one.key for one in draft.missing] == ["serial"]
    known = draft.known(file)
    assert {name: answer.unit for name, answer in known.channels.items()} == {"command": "V", "displacement": "mm"}
    assert known.time.unit == "s"
    made = drafted(gathered(Draft([file], Answers(serial="SW-1")), [table(*head).encode()])).runs[0]
    assert (made.sample_rate, made.units) == (100.0, {"command": "V", "displacement": "m"})


@pytest.mark.parametrize("end", ["", ";"])
@pytest.mark.parametrize("title", ["+++++ Data log +++++", "", "Motor 1 of 4, 9 V"])
def test_a_table_without_names_below_a_title_is_read_from_its_first_row(title, end):
    """What is not cut into fields as the samples are names none of them."""
    lines = [f"{k};{np.sin(k / 9):.6f};{np.sin(k / 9 - 1):.6f}{end}" for k in range(200)]
    content = "\n".join(["Bench 4", "Duty cycle [%]", "Speed: [deg/s]", title, *lines]).encode()
    file = read_raw(content, "run.txt")
    assert ([column.number for column in file.columns], file.skip_rows) == ([0, 1, 2], 4)
    answers = Answers("SW-1", {"command": Answer(1, "V"), "velocity": Answer(2, "deg/s")}, Answer(0, "ms"))
    run = drafted(gathered(Draft([file], answers), [content])).runs[0]
    assert (run.length, run.sample_rate, run.units["velocity"]) == (200, 1000.0, "rad/s")


@pytest.mark.parametrize("form", ["uff", "lvm", "mts", "xlsx"])
def test_files_that_state_units_are_asked_only_what_a_column_is(form):
    ending, made, (time, u, x) = FILES[form]
    file = read_raw(made(), f"run{ending}")
    answers = Answers("SW-1", {"command": Answer(u), "displacement": Answer(x)}, Answer(time, "s"))
    draft = Draft([file], answers)
    assert not draft.missing
    assert drafted(gathered(draft, [made()])).runs[0].units == {"command": "V", "displacement": "m"}


@pytest.mark.parametrize(
    ("head", "asked"),
    [
        ("time,command,position", {"unit time", "unit command", "unit displacement"}),
        ("time [s],cmd 1 [V],cmd 2 [V]", {"channel command", "channel displacement"}),
        ("n,command [V],position [widget]", {"rate", "unit displacement"}),
        ("time [s],command [V],position [1]", {"unit displacement"}),
    ],
)
def test_what_could_be_another_thing_is_asked(head, asked):
    """Units that are not stated or not known, two columns of one name's kind, a time that is none."""
    assert {one.key for one in Draft([raw(table(head))], Answers(serial="x")).missing} == asked


def test_a_rate_above_the_table_counts_where_its_unit_or_its_interval_tells_what_it_is():
    """A bare number is none; what was taken is said."""
    columns = "n,command [V],position [mm]"
    for head, rate in (("Sampling Rate: 2 kHz", "2000 Hz"), ("Sample rate: 100\nSampling interval: 0.01", "100 Hz")):
        draft = Draft([raw(table(head, columns))], Answers())
        assert draft.known(draft.files[0]).rate == rate
        assert any(rate in doubt for doubt in draft.doubts)
    bare = raw(table("Sampling Rate: 100", columns))
    assert not Draft([bare], Answers()).known(bare).rate


def test_answers_that_fit_no_file_are_refused():
    file = raw(table("time [s],command [V],position [mm]"))
    for channels, code in (
        ({"command": Answer("volts")}, "missing-column"),
        ({"force": Answer("position [mm]", "N"), "displacement": Answer("position [mm]", "mm")}, "column-twice"),
    ):
        with pytest.raises(Unusable) as refused:
            _ = Draft([file], Answers(channels=channels)).missing
        assert refused.value.code == code
    other = raw(table("time [s],setpoint [V],way [mm]"), "b.csv")
    answers = Answers(channels={"command": Answer("command [V]")})
    with pytest.raises(Unusable, match=r"add --channel 'command@b\.csv=setpoint \[V\]'"):
        _ = Draft([file, other], answers).missing
    with pytest.raises(Unusable, match="no channel 'motion'"):
        Answers(channels={"motion": Answer("x")})
    said = Draft([file], Answers(channels={"force": Answer("position [mm]", "N")}))  # more than its name says
    assert said.known(file).channels.keys() == {"command", "force"}
    assert "'position [mm]' is force in N, as was said; the file states mm" in said.doubts
    assert not any("taken for displacement" in doubt for doubt in said.doubts)
    taken = Draft([file], Answers(channels={"displacement": Answer(NONE)}))
    assert {one.key for one in taken.missing} == {"serial", "channel displacement"}


def test_a_name_is_a_channel_only_where_it_is_the_whole_of_it():
    known = {"Cmd": "command", "Load Cell [kN]": "force", "bench/Position": "displacement", "RPM": "velocity"}
    assert {name: channel_of(name) for name in known} == known
    assert not any(map(channel_of, ("Boom Cmd", "position of the valve", "CHANNEL0", "loader", "x")))


def steps(rng) -> np.ndarray:
    """Levels of a knob, each held for some tens of samples."""
    return np.repeat(rng.integers(-5, 6, 30) / 10, rng.integers(10, 60, 30))


@pytest.mark.parametrize(
    ("command", "hold"),
    [
        (steps, "zoh"),
        (lambda rng: 0.3 * np.sign(rng.standard_normal(150)), "zoh"),
        (lambda rng: rng.standard_normal(900), "linear"),
        (lambda _: np.round(np.linspace(0, 1, 20_000) * 500) / 500, "linear"),  # a slow ramp in few bits rests too
        (lambda _: np.zeros(100), "linear"),
    ],
    ids=["levels", "switched", "noise", "slow ramp", "nothing"],
)
def test_a_command_that_rests_and_jumps_is_taken_as_held_and_it_is_said(command, hold):
    """What an answer says of it goes before what it looks like."""
    samples = command(np.random.default_rng(3))
    text = "\n".join(["time (s),command (V),speed (rpm)", *(f"{n / 100:g},{u:g},1" for n, u in enumerate(samples)), ""])
    draft = Draft([raw(text)], Answers(serial="M", channels={"velocity": Answer("speed (rpm)")}))
    assert draft.known(draft.files[0]).hold == hold
    assert draft.description()["runs"][0].get("hold", "linear") == hold
    assert any(f"hold: {hold}" in doubt for doubt in draft.doubts)
    said = replace(draft, answers=replace(draft.answers, common={"hold": "linear"}))
    assert said.description()["runs"][0]["hold"] == "linear"
    assert not any("hold:" in doubt for doubt in said.doubts)


def test_the_time_of_simulink_is_in_seconds_unless_another_unit_is_said():
    """A file that it writes names its clock `tout` and states no unit; a time of another name is asked for its own."""
    rows = [f"{n / 100:g},{np.sin(n):.6f},{np.sin(n - 1):.6f}" for n in range(40)]
    draft = Draft([raw("\n".join(["tout,command (V),speed (rpm)", *rows, ""]))], Answers(serial="M"))
    assert draft.description()["runs"][0]["time"] == {"column": "tout", "unit": "s"}
    assert any("'tout' is used as time in s" in doubt for doubt in draft.doubts)
    said = replace(draft, answers=Answers(serial="M", time=Answer("", "ms")))
    assert said.description()["runs"][0]["time"] == {"column": "tout", "unit": "ms"}
    other = Draft([raw("\n".join(["time,command (V),speed (rpm)", *rows, ""]))], Answers(serial="M"))
    assert any("unit of the time" in missing.question for missing in other.missing)


def test_of_two_clocks_the_one_as_long_as_the_record_is_taken_before_a_rate_of_another_signal():
    """A workspace of MATLAB holds the step `TS` and the clock of another simulation beside those of the record."""
    t = np.arange(200) / 100
    held = {"Time": np.arange(500) / 1000, "time": t[:, None], "position": np.sin(t), "command": np.cos(t), "TS": 1e-3}
    with BytesIO() as packed:
        scipy.io.savemat(packed, held)
        draft = Draft([read_raw(packed.getvalue(), "run.mat")], Answers(serial="M"))
    assert draft.known(draft.files[0]).time == Answer("time", "")
    assert draft.known(draft.files[0]).rate == ""


def test_of_a_record_without_a_command_the_motion_is_said_to_be_linear_between_samples():
    text = "\n".join(["time (s),travel (mm),load (N)", *(f"{n / 100:g},{np.sin(n / 9):g},1" for n in range(90)), ""])
    channels = {"displacement": Answer("travel (mm)"), "force": Answer("load (N)")}
    draft = Draft([raw(text)], Answers(serial="D", channels=channels, common={"output": "force"}))
    (told,) = [doubt for doubt in draft.doubts if "hold:" in doubt]
    assert told.startswith("the motion that drives is assumed to be linear")


def test_where_some_files_look_held_and_others_do_not_they_are_named():
    def file(name: str, samples: np.ndarray):
        rows = [f"{n / 100:g},{u:g},1" for n, u in enumerate(samples)]
        return raw("\n".join(["time (s),command (V),speed (rpm)", *rows, ""]), name)

    rng = np.random.default_rng(3)
    files = [file("knob.csv", steps(rng)), file("noise.csv", rng.standard_normal(900))]
    draft = Draft(files, Answers(serial="M", channels={"velocity": Answer("speed (rpm)")}))
    (told,) = [doubt for doubt in draft.doubts if "hold:" in doubt]
    assert told.startswith("the command of knob.csv rests and jumps")


def test_a_command_whose_spectrum_ends_is_said_to_be_band_limited():
    """The description leaves it open: reading chooses by the same rule."""
    k, rng = np.arange(600), np.random.default_rng(3)
    smooth = np.sin(np.multiply.outer(k, rng.uniform(0.1, 2.2, 40)) + 6.3 * rng.random(40)).sum(axis=1)
    text = "\n".join(
        ["time (s),command (V),speed (rpm)", *(f"{n / 100:g},{u:.9g},{n}" for n, u in enumerate(smooth)), ""]
    )
    draft = Draft([raw(text)], Answers(serial="M", channels={"velocity": Answer("speed (rpm)")}))
    assert any("hold: band-limited" in doubt for doubt in draft.doubts)
    assert "hold" not in draft.description()["runs"][0]
    assert drafted(gathered(draft, [text.encode()])).runs[0].hold == "band-limited"


def test_no_measured_command_is_taken_as_held_that_was_not(measured):
    _, told, files, _ = measured
    draft = Draft(files, Answers())
    for file in files:
        assert draft.known(file).hold in ("linear", of_file(told, file).labels.hold)


def test_a_channel_may_be_the_difference_of_two_columns():
    """Two commands, each for one way; what the file states of a difference is the unit of both."""
    ways = [n // 8 % 3 - 1 for n in range(40)]
    rows = [f"{n / 100:g},{max(way, 0)},{max(-way, 0)},{n % 7}" for n, way in enumerate(ways)]
    text = "\n".join(["time [s],out [V],in [V],x [mm]", *rows, ""])
    channels = {"command": Answer("out [V] - in [V]"), "displacement": Answer("x [mm]")}
    draft = Draft([raw(text)], Answers(serial="A", channels=channels))
    known = draft.known(draft.files[0])
    assert known.channels["command"] == Answer("out [V] - in [V]", "V")
    assert known.hold == "zoh"
    assert not draft.missing
    np.testing.assert_array_equal(drafted(gathered(draft, [text.encode()])).runs[0].command, ways)
    broken = raw(text.replace("\n0.39,", "\n0.39,?"))
    with pytest.raises(Unusable, match=r"does not hold numbers throughout.*repair it, or cut the file"):
        Draft([broken], draft.answers).known(broken)


def lagged(rate: float, scale: float, head: str, unit: str) -> str:
    """A second of a command and its answer: the time in a unit of which a second has `scale`."""
    rows = [f"{scale * n / rate:.6f},{np.sin(n):.6f},{np.sin(n - 1):.6f}" for n in range(int(rate))]
    return "\n".join([head, *([unit] if unit else []), *rows, ""])


IN_MS = lagged(100, 1000, "time,u,x", "ms,mm,mm")
IN_S = lagged(100, 1, "time,u,x", "s,mm,mm")
OTHER_NAMES = lagged(100, 1, "clock,drive,way", "")
SAID = {"command": Answer("u"), "displacement": Answer("x")}


def test_each_file_keeps_the_unit_that_it_states():
    """One has its time in ms, one in s: both last a second, and nothing is asked or doubted of it."""
    texts = [IN_MS, IN_S]
    draft = Draft([raw(IN_MS, "a.csv"), raw(IN_S, "b.csv")], Answers(serial="S", channels=SAID))
    assert not draft.missing
    assert [draft.known(file).time.unit for file in draft.files] == ["ms", "s"]
    made = drafted(gathered(draft, [text.encode() for text in texts]))
    assert [(run.sample_rate, run.duration) for run in made.runs] == [(100.0, 1.0), (100.0, 1.0)]


def test_a_unit_said_of_all_files_against_what_one_of_them_states_is_doubted_with_its_name():
    files = [raw(IN_MS, "a.csv"), raw(IN_S, "b.csv")]
    for time in (Answer("time", "ms"), Answer("", "ms")):
        doubts = Draft(files, Answers(serial="S", channels=SAID, time=time)).doubts
        assert "b.csv: 'time' is time in ms, as was said; the file states s" in doubts
        assert not any("the file states ms" in doubt for doubt in doubts)


def test_a_column_that_is_no_channel_is_said():
    """It may be one that nobody thought of, such as the voltage of a damper's coil."""
    text = "time_s,displacement_mm,force_N,voltage_V,stage\n" + "".join(
        f"{k / 100},{np.sin(k)},{np.cos(k)},{k % 2},{k // 3}\n" for k in range(100)
    )
    said = Answers(serial="S", output="force")
    assert "no channel is taken from 'voltage_V', 'stage'" in Draft([raw(text, "a.csv")], said).doubts
    with_coil = replace(said, channels={"current": Answer("voltage_V", "V")})
    assert "no channel is taken from 'stage'" in Draft([raw(text, "a.csv")], with_coil).doubts


def test_numbers_with_the_prefix_of_a_unit_behind_them_are_named_with_what_to_write():
    """A letter m may stand for metres, too, so it is not read."""
    rows = "".join(f"{n / 10};{20 + n / 10:.1f}m;1.{n}k\n" for n in range(9))
    of_some = Draft([raw("time (s);current;pressure\n" + rows, "a.csv")], Answers(serial="S"))
    said = "'current' is left out: line 2 holds '20.0m', a number with a letter behind it; write plain numbers"
    assert any(said in one for one in of_some.doubts)
    with pytest.raises(Unusable, match=r"no column holds numbers throughout; 'current' is left out: .* '20\.0m'"):
        raw("current;pressure\n" + "".join(row.partition(";")[2] + "\n" for row in rows.split()), "b.csv")


def test_files_with_other_names_have_columns_units_and_clocks_of_their_own():
    """What is said of a file outweighs what is said of all; each is asked for what it lacks, by its name."""
    files = [raw(IN_MS, "a.csv"), raw(OTHER_NAMES, "b.csv"), raw(OTHER_NAMES, "c.csv")]
    draft = Draft(files, Answers(serial="S", files={"a.csv": FileAnswers(SAID)}))
    assert {(one.key, one.files) for one in draft.missing} == {
        ("channel command", ("b.csv", "c.csv")),
        ("channel displacement", ("b.csv", "c.csv")),
        ("rate", ("b.csv", "c.csv")),
    }
    assert any(one.question.endswith(", of b.csv, c.csv") for one in draft.missing)
    with pytest.raises(Unusable, match=r"--channel command@b\.csv=COLUMN:UNIT"):
        draft.description()
    of_b = FileAnswers({"command": Answer("drive", "cm"), "displacement": Answer("way", "in")}, Answer("clock", "s"))
    of_c = FileAnswers({"command": Answer("drive", "mm"), "displacement": Answer("way", "mm")}, rate="200 Hz")
    said = Answers("S", SAID, Answer("time"), files={"b.csv": of_b, "c.csv": of_c})
    made = drafted(gathered(Draft(files, said), [text.encode() for text in (IN_MS, OTHER_NAMES, OTHER_NAMES)]))
    assert [run.sample_rate for run in made.runs] == [100.0, 100.0, 200.0]
    sizes = [(np.ptp(run.command), np.ptp(run.measured)) for run in made.runs]
    np.testing.assert_allclose(sizes[0], sizes[2])
    np.testing.assert_allclose(sizes[1], np.array(sizes[2]) * (10, 25.4))


def test_a_column_of_times_that_is_none_leaves_the_rate_to_be_said():
    """A counter called time; and an answer about a file that is not there is refused."""
    files = [raw(IN_MS, "a.csv")]
    not_it = Draft(files, Answers(serial="S", channels=SAID, time=Answer(NONE)))
    assert [one.key for one in not_it.missing] == ["rate"]
    with pytest.raises(Unusable, match=r"'d\.csv' is none of the files"):
        Draft(files, Answers(files={"d.csv": FileAnswers()}))
    with pytest.raises(Unusable, match="no channel 'motion'"):
        FileAnswers({"motion": Answer("x")})


def test_a_current_beside_a_speed_is_no_command_unless_the_kind_is_of_a_bench():
    """A log of a motor: what drove it is asked, and not refused when the description is read."""
    text = table("Time (s),Current (A),Speed (RPM)")
    draft = Draft([raw(text)], Answers(serial="A1"))
    assert [one.key for one in draft.missing] == ["channel command"]
    answered = Draft([raw(text)], Answers(serial="A1", channels={"command": Answer("Current (A)", "A")}))
    assert not answered.missing
    assert not any("command" in one.key for one in Draft([raw(text)], Answers(common={"kind": "static"})).missing)


def test_a_first_column_without_a_name_that_increases_in_equal_steps_is_the_time():
    """Its unit is asked; one that counts the rows is no clock, and its unit is not asked."""
    timed = Draft([raw(table(",cmd_mm,pos_mm"))], Answers())
    assert [one.key for one in timed.missing] == ["serial", "unit time"]
    assert any("no name" in doubt for doubt in timed.doubts)
    lines = ["", *(f"{n},{np.sin(n):.6f},{np.sin(n - 1):.6f}" for n in range(40)), ""]
    counted = Draft([raw(",cmd_mm,pos_mm" + "\n".join(lines))], Answers())
    assert [one.key for one in counted.missing] == ["serial", "rate"]


def test_of_columns_that_only_increase_the_one_that_begins_nearest_to_zero_is_offered_as_the_time():
    """A spreadsheet without names: its first column is a date in days, its second one the time that has passed."""
    rows = [f"{44257.5 + n / 864000:.9f},{n / 10:g},{np.sin(n):.6f},{np.cos(n):.6f}" for n in range(40)]
    file = raw("\n".join(rows))
    with pytest.raises(Unusable, match=r"--time 1:UNIT"):
        Draft([file], Answers(serial="AX-1")).description()


def test_of_two_columns_of_one_name_the_one_whose_unit_fits_is_suggested():
    """Force (V) is the amplifier's voltage; of two forces in N none is suggested."""
    rows = [f"{n / 100:g},{np.sin(n):.6f},{np.sin(n - 1):.6f},{np.cos(n):.6f},0.{n}" for n in range(10, 50)]
    for other, found in (("V", 4), ("kN", None)):
        head = f"Time (s),Command (mm),Position (mm),Force ({other}),Force (N)"
        file = raw("\n".join([head, *rows, ""]))
        channels = Draft([file], Answers()).known(file).channels
        assert (channels["force"].column if "force" in channels else None) == (found and "Force (N)")


def test_the_rate_and_the_units_of_a_tdms_are_found(tmp_path):
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(tmp_path / "run.tdms") as writer:
        of_all = {"wf_increment": 0.002}
        writer.write_segment(
            [
                ChannelObject("g", name, np.sin(np.arange(40.0)), of_all | {"unit_string": unit})
                for name, unit in (("command", "V"), ("position", "mm"))
            ]
        )
    file = read_raw((tmp_path / "run.tdms").read_bytes(), "run.tdms")
    known = Draft([file], Answers()).known(file)
    assert (known.rate, known.channels["command"].unit, known.channels["displacement"].unit) == ("500 Hz", "V", "mm")


@pytest.mark.parametrize(
    ("unit", "output"), [("bar", "load_pressure"), ("degC", "temperature"), ("mm", "displacement")]
)
def test_the_one_column_left_is_offered_as_an_output_that_its_unit_measures(unit, output):
    """A level that nobody calls by a name of its own: a pressure in bar was offered as a displacement."""
    draft = Draft([raw(table(f"Time (s),Command (V),Reading 7 ({unit})"))], Answers(serial="A1"))
    assert draft.options == (f"--channel {output}='Reading 7 ({unit})'",)


def test_a_line_of_units_may_hold_the_one_of_a_quantity_without_a_unit():
    """The units beside it are read; what 1 stands for is asked, since a file may not choose unknown units."""
    file = raw(table("time,command,force", "s,1,kN"))
    known = Draft([file], Answers()).known(file)
    assert (known.time.unit, known.channels["command"].unit, known.channels["force"].unit) == ("s", "", "kN")


def test_where_the_force_was_said_to_be_the_output_the_motion_is_asked_for():
    """Not the command: a name that is misspelt is no displacement by itself."""
    text = table("Time (s),Displacment (mm),Force (kN)")
    draft = Draft([raw(text)], Answers(serial="A1", output="force"))
    assert [one.key for one in draft.missing] == ["channel displacement"]
    assert draft.options == ("--channel displacement='Displacment (mm)'",)


def test_a_channel_with_few_values_is_taken_only_where_it_is_said():
    """Of a stand whose load cell reads once in 20 samples: with it 20 of 400 samples had all channels."""
    rows = [f"{n / 100:g},{n % 7},{n % 5},{n if n % 20 == 0 else ''}" for n in range(400)]
    text = "\n".join(["time (s),command (V),speed (rpm),force (N)", *rows, ""])
    draft = Draft([raw(text)], Answers(serial="M"))
    assert draft.description()["runs"][0]["channels"].keys() == {"command", "velocity"}
    assert any("'force (N)' is not used as force: it has values in 5.00 %" in doubt for doubt in draft.doubts)
    said = replace(draft, answers=Answers(serial="M", channels={"force": Answer("force (N)")}))
    assert "force" in said.description()["runs"][0]["channels"]
    assert not any("not used" in doubt for doubt in said.doubts)
