"""How a text table is laid out is found from its rows; what cannot be told is refused in one line, or asked."""

from __future__ import annotations

import numpy as np
import pytest

from ident.drafts.answers import Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_raw
from ident.errors import Unusable
from ident.readers.dialect import Dialect
from ident.readers.layout import recognise
from ident.readers.limits import LIMITS
from ident.readers.numeral import in_thousands
from ident.readers.text import read_text
from ident.readers.time_stamp import seconds

RNG = np.random.default_rng(5)
ROWS = RNG.normal(scale=30, size=(40, 2))


def lines(form: str = "{:.4f}", delimiter: str = ",", rows: np.ndarray = ROWS) -> list[str]:
    return [delimiter.join(form.format(value) for value in row) for row in rows]


def read(text: str | bytes, skip_rows: int = 0):
    return read_text(
        text if isinstance(text, bytes) else text.encode(), "run.csv", LIMITS, Dialect(skip_rows=skip_rows)
    )


def test_a_row_of_numbers_above_and_a_remark_sign_before_the_names_are_no_row_and_no_name():
    """numpy writes the names behind #; both spellings name the column."""
    table = read("\n".join(["3,4", "", "# u [V], x [mm]", *lines()]))
    assert table.names == ("u [V]", "x [mm]")
    assert table.number("# u [V]", "") == 0
    np.testing.assert_allclose(table.load([0, 1]), ROWS.T, atol=1e-4)


def test_commas_in_quotes_are_decimal_signs_and_those_between_them_separate():
    text = ["u,x", *(",".join(f'"{value:.4f}"'.replace(".", ",") for value in row) for row in ROWS)]
    np.testing.assert_allclose(read("\n".join(text)).load([0, 1]), ROWS.T, atol=1e-4)


@pytest.mark.parametrize("head", ["", "u,x\n"])
def test_a_comma_that_separates_and_is_the_decimal_sign_is_refused(head):
    text = head + "\n".join(",".join(f"{value:.4f}".replace(".", ",") for value in row) for row in ROWS)
    with pytest.raises(Unusable, match="export it with semicolons") as refused:
        read(text)
    assert refused.value.code == "comma-twice"


def test_whole_numbers_at_first_do_not_hide_a_decimal_comma_further_down():
    """Beyond the head, too: the sign is looked for in all rows."""
    for count in (20, 2000):
        text = ["u;x", *(f"{n};{n % 7}" for n in range(count)), *(f"{n};{n % 7},25" for n in range(50))]
        (x,) = read("\n".join(text)).load([1])
        assert x[-1] == 49 % 7 + 0.25
        assert len(x) == count + 50


def test_thousands_parted_by_points_among_decimal_commas_are_refused_with_their_line():
    text = ["u;x", *lines("{:.4f}", ";")]
    text = [line.replace(".", ",") for line in text]
    text[7] = "1.234;0,5"
    with pytest.raises(Unusable, match=r"line 8 holds '1\.234'.*thousands"):
        read("\n".join(text)).load([0])


def test_names_that_are_fewer_than_the_columns_go_by_number_and_it_is_said():
    """A comma in a name, or a column of row numbers without one: which name is which column's cannot be told."""
    rows = "\n".join(f"{n},{line}" for n, line in enumerate(lines()))
    table = read("u,x\n" + rows)
    assert table.names == ("0", "1", "2")
    assert "2 names for 3 columns" in table.notices[0]
    with pytest.raises(Unusable, match="no column 'u'"):
        table.number("u", "")
    assert read("Force, kN,Travel, mm\n" + "\n".join(lines())).names == ("0", "1")


@pytest.mark.parametrize("bad", ["bad", "1.2.3"])
def test_a_cell_that_is_no_number_is_named_by_its_line_wherever_the_column_is_asked_about(bad):
    text = ["time [s],command [V],position [mm]", *(f"{n / 100},{n % 9},{n % 5}" for n in range(40))]
    text[11] = f"0.1,{bad},0"
    told = f"line 12 holds '{bad}'"
    with pytest.raises(Unusable, match=told):
        read("\n".join(text)).load([1])
    draft = Draft([read_raw("\n".join(text).encode(), "run.csv")], Answers("A"))
    (missing,) = draft.missing
    assert missing.key == "channel command"
    assert told in missing.question


@pytest.mark.parametrize(
    ("end", "rows"), [("5.00", 39), ("5.0000,1", 39), ("5.0000,1.", 39), ("5.0000,1.2345", 40), ("5.0000,1.0\n", 40)]
)
def test_a_last_row_that_ends_within_a_number_is_left_out_and_told(end, rows):
    """Where every other row has as many digits and the file does not end with its line."""
    text = "\n".join(["u,x", *lines()[:39], end])
    table = read(text)
    assert len(table.load([0])[0]) == rows
    assert any("line 41, the last one, is cut off" in notice for notice in table.notices) == (rows == 39)


def test_the_line_of_names_that_matrix_yaml_states_is_the_one_that_is_found():
    """So that what was described is what is read."""
    above = ["Bench 4;;", "Date;12.03.2026;", ""]
    text = "\n".join([*above, "time;command;position", "s;V;mm", *(f"{n};{n % 5};{n % 3}" for n in range(30))]).encode()
    found = recognise(text, "run.csv")
    assert (found.skip_rows, found.heading.units) == (3, ("s", "V", "mm"))
    stated = recognise(text, "run.csv", Dialect(skip_rows=3))
    assert (stated.heading.names, stated.heading.units, stated.below) == (
        found.heading.names,
        found.heading.units,
        found.below,
    )


@pytest.mark.parametrize(
    ("stamps", "step"),
    [
        ([f"2026-03-12T09:30:00.{n:03d}Z" for n in range(30)], 0.001),
        (["2026-03-12 23:59:59.900", *(f"2026-03-13 00:00:0{n // 10}.{n % 10}00" for n in range(29))], 0.1),
        ([f"12.03.2026 09:30:{n:02d}" for n in range(30)], 1.0),
        ([f"09:30:{n:02d},500" for n in range(30)], 1.0),
        ([f"3/12/2026 09:30:{n:02d} PM" for n in range(30)], 1.0),
        ([f"2026-03-12 09:30:00:{10 * n:03d}" for n in range(30)], 0.01),  # milliseconds behind a colon
    ],
)
def test_time_stamps_are_seconds_since_the_first(stamps, step):
    np.testing.assert_allclose(seconds(stamps, 2, "run.csv"), step * np.arange(30), atol=1e-9)
    table = read("\n".join(["time;u", *(f"{stamp};{n % 7}" for n, stamp in enumerate(stamps))]))
    np.testing.assert_allclose(table.load([0])[0], step * np.arange(30), atol=1e-9)
    assert table.units == ("s", "")


def test_days_that_cannot_be_told_from_months_and_zones_that_change_are_refused():
    for stamps in (
        ["3/12/2026 23:59:59", "4/12/2026 00:00:00"],
        ["09:30:00Z", "09:30:01+01:00"],
        ["09:30:00", "later"],
    ):
        with pytest.raises(Unusable):
            seconds(stamps, 2, "run.csv")


def test_times_of_day_without_a_date_go_on_beyond_midnight():
    """As of a test that ran two nights; a time that falls by less is out of order, and stays so."""
    hours = ["22:00:00", "23:59:59.5", "00:00:00.5", "12:00:00", "23:00:00", "01:00:00"]
    assert seconds(hours, 2, "").tolist() == [0.0, 7199.5, 7200.5, 50400.0, 90000.0, 97200.0]
    assert seconds(["10:00:00", "09:59:59"], 2, "").tolist() == [0.0, -1.0]


def test_windows_1252_and_two_bytes_a_sign_without_a_mark_keep_the_units():
    text = "\n".join(["Zeit [s];Weg [µm]", *(f"{n};{n % 7}" for n in range(20))])
    for encoding in ("cp1252", "utf-8", "utf-16", "utf-16-le", "utf-16-be"):
        assert read(text.encode(encoding)).names == ("Zeit [s]", "Weg [µm]")


@pytest.mark.parametrize("heading", ["时间(s),位移(mm)", "\n时间,力值\n(s),(N)"])
def test_chinese_without_a_mark_is_read_as_it_was_written(heading):
    rows = "\n".join([heading, *(f"{n},{n % 7}" for n in range(20))])
    assert read(rows.encode("gb18030")).names == read(rows.encode()).names
    assert read(rows.encode()).names[0].startswith("时间")


@pytest.mark.parametrize("heading", ["t,h (W/m²·K)", "t,Größe (µm)", "t,VERZÖGERUNG_ÜBER_ÄHNLICH", "été,forcé"])
def test_signs_of_units_and_accents_are_no_chinese(heading):
    """Signs of units and two accents in a row are bytes that are a Chinese character, too."""
    assert read("\n".join([heading, *(f"{n},{n % 7}" for n in range(20))]).encode("cp1252")).names[1] in heading


@pytest.mark.parametrize(
    ("above", "rate"),
    [
        ("Abtastrate;1000 Hz", 1000.0),
        ("Sampling period,1.0 ms,", 1000.0),
        ("Abtastintervall: 0,5 ms", 2000.0),
        ("sampling frequency = 4.096 kHz", 4096.0),
        ("Sample 1", None),
        ("Samples: 30", None),
        ("Sample rate: 100", None),
        ("sample" + " " * 60_000 + "x", None),
    ],
)
def test_a_rate_or_an_interval_above_the_table_is_found_where_it_carries_a_unit(above, rate):
    text = "\n".join([above, "", "n,command [V],position [mm]", *(f"{n},{n % 7},{n % 3}" for n in range(30))])
    found = read_raw(text.encode(), "run.csv").rate
    assert (found and found.value) == (None if rate is None else pytest.approx(rate))


def test_numbers_whose_thousands_may_be_parted_are_those_of_three_digits_behind_one_to_three():
    assert all(map(in_thousands, ("1.234", "12,345", "-123.456", "1,234,567")))
    assert not any(map(in_thousands, ("0.123", "1234.567", "1.23", "1.2345", "1,234.5", "123")))


@pytest.mark.parametrize(("blank", "names"), [(0, ("u", "x")), (2, ("u", "x")), (3, ("0", "1"))])
def test_names_may_be_parted_from_the_rows_by_two_blank_lines(blank, names):
    assert read("\n".join(["Bench", "", "u,x", *[""] * blank, *lines()])).names == names


def test_commas_that_may_all_part_thousands_are_read_as_decimal_signs_and_it_is_said():
    """A number such as 0,123 leaves no doubt."""
    rows = [f"{n},{100 + n};{n + 3},{200 + n}" for n in range(1, 30)]
    doubted, sure = (read("\n".join(["u;x", *lines])) for lines in (rows, [*rows, "0,123;4,567"]))
    assert doubted.load([0])[0][0] == 1.101
    assert any("separates thousands" in notice for notice in doubted.notices)
    assert not sure.notices


SECOND = ["Data Acquisition\t\tTime:\t12.5\ts", "Force", "kN", "1.5", "-3.5"]
"""Another table, of fewer columns."""


@pytest.mark.parametrize(
    ("foot", "said"),
    [
        (["Maximum\t29.5\t31.25"], "line 42,"),
        (["", "End of test", "approved by:\tthe laboratory"], "lines 43 to 44,"),
        (["", *SECOND], "lines 43 to 47,"),
        (["# stopped\tby hand"], "line 42, below the table, is"),
        (["% 12.5\t3.5"], "line 42,"),
    ],
)
def test_a_result_a_remark_or_another_table_below_the_table_is_told_and_left_out(foot, said):
    """Testing machines write them there; no row begins with a word."""
    table = read("\n".join(["u\tx", *lines(delimiter="\t"), *foot, ""]))
    np.testing.assert_allclose(table.load([0, 1]), ROWS.T, atol=1e-4)
    assert any(said in notice and "below the table" in notice for notice in table.notices)


@pytest.mark.parametrize("bad", ["oops\t1.5", "1.5\toops"])
def test_a_word_among_the_rows_is_no_foot(bad):
    """A row follows: which line is wrong is said when the column is loaded."""
    some = lines(delimiter="\t")
    table = read("\n".join(["u\tx", *some[:20], bad, *some[20:], ""]))
    assert not any("below the table" in notice for notice in table.notices)
    with pytest.raises(Unusable, match="line 22"):
        table.load([0, 1])


@pytest.mark.parametrize("first", ["2,1080e+01", "1.5x"])
def test_a_last_row_that_begins_with_a_number_is_no_foot(first):
    some = [line.replace(".", ",") for line in lines(delimiter="\t")]
    table = read("\n".join(["u\tx", *some, first]))
    assert not any("below the table" in notice for notice in table.notices)


def test_a_last_row_with_a_word_for_a_number_is_a_row_with_a_flaw():
    table = read("\n".join(["u\tx", *lines(delimiter="\t"), "1.5\toops", ""]))
    with pytest.raises(Unusable, match="line 42"):
        table.load([1])


@pytest.mark.parametrize("delimiter", ["\t", "; ", " ", ", "])
@pytest.mark.parametrize("names", [(), ("command", "position")])
def test_lines_that_are_signals_are_columns(delimiter, names):
    """As long as a record is, far beyond the longest line of a table; the same numbers in columns are read alike."""
    record = np.random.default_rng(3).normal(scale=30, size=(9000, 2))
    rows = [[*names[n : n + 1], *map("{:.4f}".format, signal)] for n, signal in enumerate(record.T)]
    table = read("\n".join(map(delimiter.join, rows)) + "\n")
    assert table.names == (names or ("0", "1"))
    assert table.notices[0] == "run.csv: each of its lines was read as a signal"
    np.testing.assert_allclose(table.load([0, 1]), record.T, atol=1e-4)


def test_one_long_line_is_one_signal_and_a_short_table_stays_as_it_is():
    (x,) = read("   " + "   ".join(f"{value:.7e}" for value in ROWS[:, 0])).load([0])
    np.testing.assert_allclose(x, ROWS[:, 0], atol=1e-6)
    assert len(read("\n".join(["u,x", *lines(rows=ROWS[:5])])).load([0])[0]) == 5
    assert len(read("\n".join(lines(rows=np.ones((5, 8))))).load([7])[0]) == 5
