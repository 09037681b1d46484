"""Text as laboratories' loggers write it."""

from __future__ import annotations

import numpy as np
import pytest

from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.dialect import Dialect
from ident.readers.limits import LIMITS, Limits
from ident.readers.text import read_text

VALUES = np.round(np.random.default_rng(0).normal(size=(50, 2)), 6)


def read(text: str | bytes, columns=("a", "b"), skip_rows: int = 0):
    table = read_text(text.encode() if isinstance(text, str) else text, "file", LIMITS, Dialect(skip_rows=skip_rows))
    return np.column_stack(table.load([table.number(name, "column") for name in columns]))


def rows(delimiter: str, end: str = "\n", header: bool = True) -> str:
    lines = [delimiter.join(f"{value:.6f}" for value in row) for row in VALUES]
    return end.join(([delimiter.join("ab")] if header else []) + lines) + end


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " ", "   ", ", ", " ,  "])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_the_delimiter_and_line_ends_are_found(delimiter, end):
    assert np.array_equal(read(rows(delimiter, end)), VALUES)


def test_decimal_commas_are_read_where_another_sign_separates():
    assert np.array_equal(read(rows(";").replace(".", ",")), VALUES)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_byte_order_marks_are_skipped(encoding):
    assert np.array_equal(read(rows(",").encode(encoding)), VALUES)


def test_a_header_block_and_rows_that_trail_words_are_read():
    lines = rows(", ", "\r\n").splitlines()
    lines[1] += ", DAQ Start"
    lines[-1] += ", DAQ Pause, DAQ Stop"
    text = "Header Size: 2\r\nRate: 1000\r\n" + "\r\n".join(lines) + "\r\n"
    assert np.array_equal(read(text, skip_rows=2), VALUES)


def test_quoted_names_and_numbers_are_read():
    text = rows(",").replace("a,b", '"a","b"')
    assert np.array_equal(read(text), VALUES)


def test_samples_without_a_line_of_names_are_all_kept_and_said():
    table = read_text(rows(",", header=False).encode(), "file", LIMITS)
    assert np.array_equal(np.column_stack(table.load([0, 1])), VALUES)
    assert "no line of column names" in table.notices[0]


def test_a_delimiter_at_the_end_of_every_line_is_no_name():
    """Small controllers print it; the name of a column of its own would make a name of the first samples."""
    table = read_text(rows(";", header=False).replace("\n", ";\n").encode(), "file", LIMITS)
    assert table.names == ("0", "1")
    assert np.array_equal(np.column_stack(table.load([0, 1])), VALUES)
    assert read_text(b",0,1\n0,0.1,0.2\n1,0.3,0.4\n", "file", LIMITS).names == ("", "0", "1")  # an index has none


def test_a_name_that_stands_twice_must_be_given_by_number():
    with pytest.raises(Unusable) as refused:
        read(rows(",").replace("a,b", "a,a"))
    assert refused.value.code == "ambiguous-column"


def test_the_declared_limit_of_a_column_holds():
    table = read_text(rows(",").encode(), "file", Limits(channel=8 * 49))
    with pytest.raises(Unusable) as refused:
        table.load([0])
    assert refused.value.code == "too-large"


@pytest.mark.parametrize("text", [b"\0\1\2", b"\n\n\n", b"a" * 100_000, b"PK\3\4\0\0\n\0\0"])
def test_what_is_no_table_is_refused(text):
    with pytest.raises(Unusable):
        read(text)


def test_what_reading_assumed_of_many_files_is_said_once(tmp_path):
    runs = []
    for number in range(3):
        np.savetxt(tmp_path / f"{number}.txt", np.random.default_rng(number).standard_normal((200, 2)))
        runs.append(
            f"  - {{id: r{number}, file: {number}.txt, sample_rate: 100 Hz,"
            " channels: {command: {column: 0, unit: mm}, displacement: {column: 1, unit: mm}}}\n"
        )
    (tmp_path / "matrix.yaml").write_text(f"actuator: {{serial: A}}\nruns:\n{''.join(runs)}")
    (notice,) = read_matrix(tmp_path).notices
    assert notice == (
        "0.txt has no line of column names: its first line was read as samples; so it was with 2 more files"
    )
