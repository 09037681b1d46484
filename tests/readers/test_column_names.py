"""What names of columns say: channels in four languages, times, units; one that could be two things says none."""

from __future__ import annotations

import pytest

from ident.drafts.answers import Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from ident.readers.column_names import (
    MEASURED,
    PAIRS,
    TIMES,
    WORDS,
    channel_of,
    is_time,
    said,
    suffix,
    without_common_words,
)

CHANNELS = {
    "x_soll": "command",
    "Sollwert": "command",
    "xSoll": "command",
    "Lagesollwert [mm]": "command",
    "Führungsgröße": "command",
    "consigne": "command",
    "Riferimento": "command",
    "PositionCommand": "command",
    "x_ref": "command",
    "setpoint_mm": "command",
    "Istwert": "displacement",
    "x_ist": "displacement",
    "Weg_mm": "displacement",
    "Déplacement (mm)": "displacement",
    "mesure": "displacement",
    "posizione": "displacement",
    "Position feedback": "displacement",
    "ActualPosition": "displacement",
    "Istwert [kN]": "force",
    "mesure [mm/s]": "velocity",
    "Force_kN": "force",
    "Kraft": "force",
    "Drehzahl": "velocity",
    "vitesse": "velocity",
    "Druckdifferenz": "load_pressure",
    "p_A": "pressure_a",
    "yout [m]": "displacement",
    "y_m": "displacement",
    "Ventilstrom": "current",
    "Öltemperatur": "temperature",
    "位移": "displacement",
    "力值(kN)": "force",
    "Ch 1 Kraft Sollwert": "command",
    "Ch 1 Kraft": "force",
    "Kanal 2 Weg [mm]": "displacement",
    "Axial Force Command": "command",
    "force_setpoint_kN": "command",
    "指令_mm": "command",
    "阻尼力\uff08N\uff09": "force",
}
NONE = (
    "u",
    "y",
    "x",
    "r",
    "output",
    "yout",
    "Istwert [bar]",
    "AI7",
    "Status",
    "Weg der Last",
    "Ch 1",
    "CH1 y",
    "t_command",
    "p_s",
    "in",
)
UNITS = {
    "Time_ms": "ms", "t_s": "s", "Force_kN": "kN", "Weg_mm": "mm", "speed_mm_s": "mm/s", "v_mm_per_s": "mm/s",
    "speed_rpm": "rpm", "Time ms": "ms", "Flow_l_min": "l/min", "temperature_degC": "degC", "force_N": "N",
    "x_m": "", "u_V": "V", "p_A": "", "pressure_A": "", "p_s": "", "F_N": "", "x_soll": "", "pos_kN": "", "time_mm": "",
}  # fmt: skip


@pytest.mark.parametrize(("name", "channel"), CHANNELS.items())
def test_the_words_of_benches_are_channels(name, channel):
    assert channel_of(name) == channel
    assert not is_time(name)


@pytest.mark.parametrize("name", NONE)
def test_a_name_that_could_be_another_thing_is_no_channel(name):
    assert channel_of(name) == ""


@pytest.mark.parametrize(
    "name", ["Time_ms", "t_s", "Zeit [s]", "temps", "tempo", "tout", "X_Value", "Elapsed Time", "时间 (s)"]
)
def test_a_time_is_known_in_any_of_these_languages(name):
    assert is_time(name)
    assert channel_of(name) == ""


@pytest.mark.parametrize(("name", "unit"), UNITS.items())
def test_a_unit_ends_a_name_where_what_is_named_may_be_measured_in_it(name, unit):
    assert suffix(name)[1] == unit


def test_no_word_means_two_things_and_each_is_written_as_it_is_looked_for():
    words = [word for of_channel in WORDS.values() for word in of_channel]
    everything = [*words, *MEASURED, *TIMES, *(name for pair in PAIRS for name in pair[:1])]
    assert len(set(everything)) == len(everything)
    assert all(said(word) == word for word in everything)


def known(*names: str):
    rows = [
        ",".join(str(round(((n + 1) * (k + 3)) % 7 / 1000 * k + n, 6)) for k in range(len(names))) for n in range(20)
    ]
    file = read_raw("\n".join([",".join(names), *rows, ""]).encode(), "run.csv")
    return file, Draft([file], Answers())


def test_the_input_of_a_model_is_the_command_where_its_output_is_there():
    """The names of MATLAB; u alone may be a displacement."""
    file, draft = known("u_V", "y_mm")
    assert {name: (a.column, a.unit) for name, a in draft.known(file).channels.items()} == {
        "command": ("u_V", "V"),
        "displacement": ("y_mm", "mm"),
    }
    file, draft = known("t", "u", "x")
    assert not draft.known(file).channels


def test_what_all_names_have_in_common_says_nothing_of_a_column():
    """EXP_Time and EXP_PosRef are a time and a command; a name that is known as it stands is kept."""
    for names in (("EXP_Time", "EXP_PosRef", "EXP_PosFb"), ("Time_01", "PosRef_01", "PosFb_01")):
        file, draft = known(*names)
        assert draft.known(file).time.column == names[0]
        found = {name: answer.column for name, answer in draft.known(file).channels.items()}
        assert found == {"command": names[1], "displacement": names[2]}
    file, draft = known("Axis 1 Time [s]", "Axis 1 Force [kN]", "Axis 1 Position [mm]")
    assert {name: answer.unit for name, answer in draft.known(file).channels.items()} == {
        "force": "kN",
        "displacement": "mm",
    }
    file, draft = known("Tiempo [s]", "Axial Force [kN]", "Axial Displacement [mm]", "Axial Count [1]")
    assert {*draft.known(file).channels} == {"force", "displacement"}
    assert without_common_words(("Time", "Ch 1 Force", "Ch 1 Displacement")) == ("Time", "Force", "Displacement")
    assert without_common_words(("Time", "Motor A", "Motor B")) == ("Time", "Motor A", "Motor B")
    assert without_common_words(("cmd_pos", "cmd_vel")) == ("cmd_pos", "cmd_vel")
    assert without_common_words(("pos_mm", "ref_mm")) == ("pos_mm", "ref_mm")
    assert without_common_words(("run_a", "run_b_a")) == ("run_a", "run_b_a")


def test_metres_end_a_name_where_another_name_ends_with_a_unit_and_it_is_said():
    """Alone, pos_m may be the position that was measured."""
    for names, unit in ((("time_s", "cmd_V", "pos_m"), "m"), (("time", "cmd", "pos_m"), "")):
        file, draft = known(*names)
        assert file.columns[2].unit == unit
        assert any("'pos_m' is read in m, because of its name" in doubt for doubt in draft.doubts) == bool(unit)
