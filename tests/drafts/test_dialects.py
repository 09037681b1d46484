"""How a text is laid out can be stated where it is not found: delimiter, decimal sign, header rows, encoding."""

from __future__ import annotations

import numpy as np
import pytest

from ident.drafts.answers import Answer, Answers
from ident.drafts.draft import Draft
from ident.drafts.raw_file import read_or_shown, read_raw
from ident.drafts.text import as_yaml, drafted, gathered
from ident.errors import Unusable
from ident.readers import read_matrix
from ident.readers.dialect import ENCODINGS, Dialect

TIMES = np.arange(60) / 100
COMMAND = np.round(np.sin(TIMES * 20), 4)
POSITION = np.round(np.sin(TIMES * 20 - 0.3), 4)
CHANNELS = {"command": Answer(1, "mm"), "displacement": Answer(2, "mm")}
SAID = Answers(serial="SW-1", channels=CHANNELS, time=Answer(0, "s"))


def text(*head: str, delimiter: str = ";", comma: bool = True) -> str:
    """A text of three columns below some lines."""
    fields = ([f"{value:.4f}" for value in row] for row in zip(TIMES, COMMAND, POSITION, strict=True))
    rows = [delimiter.join(field.replace(".", ",") if comma else field for field in row) for row in fields]
    return "\n".join([*head, *rows, ""])


@pytest.mark.parametrize(
    ("content", "dialect"),
    [
        # the line of an operator below the names looks as a row: what is found begins too early
        (text("t;u;x", "1;2;3", "0;0;0", "7;8;9"), Dialect(header_rows=4)),
        # one column to whoever takes the blank for the delimiter, three to whoever takes the semicolon
        (text("t;u;x", delimiter=" ;", comma=False), Dialect(delimiter="semicolon", decimal="point")),
        (text("Zeit;Soll;Weg in mm"), Dialect(decimal="comma", delimiter="semicolon", header_rows=1)),
        (text("t|u|x", delimiter="|", comma=False), Dialect(delimiter="pipe", decimal="point", header_rows=1)),
        (text("t\tu\tx", delimiter="\t"), Dialect(delimiter="tab", decimal="comma")),
        (text("t u x", delimiter="   ", comma=False), Dialect(delimiter="space")),
    ],
)
def test_what_is_stated_is_read_and_stands_in_the_description(content, dialect):
    """The samples are those that were written, and the matrix that the description makes has them too."""
    file = read_raw(content.encode(), "run.csv", stated=dialect)
    np.testing.assert_array_equal([file.samples(n) for n in range(3)], [TIMES, COMMAND, POSITION])
    draft = Draft([file], SAID)
    run = drafted(gathered(draft, [content.encode()])).runs[0]
    np.testing.assert_allclose([run.command, run.measured], 1e-3 * np.array([COMMAND, POSITION]), rtol=1e-12)
    for key, value in dialect.entries.items():
        assert f"{key}: {value}" in as_yaml(draft)
    assert Draft([read_raw(text("t;u;x").encode(), "run.csv")], SAID).description()["runs"][0].get("dialect") is None


def test_header_rows_change_which_rows_are_samples():
    """Without them three rows more are read, so that the first case above does state something."""
    content = text("t;u;x", "1;2;3", "0;0;0", "7;8;9").encode()
    assert len(read_raw(content, "run.csv").samples(0)) == 63
    assert len(read_raw(content, "run.csv", stated=Dialect(header_rows=4)).samples(0)) == 60


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_an_encoding_is_read_as_stated(encoding):
    """The name of a column and the µ of its unit are those that were written, where the encoding has them."""
    sign = "Weg 行程" if encoding in ("shift-jis", "gb18030") else "Давление" if "1251" in encoding else "Weg für x"
    content = text(f"t;u;{sign}").encode(ENCODINGS[encoding])
    file = read_raw(content, "run.csv", stated=Dialect(encoding=encoding))
    assert [column.name for column in file.columns] == ["t", "u", sign]
    assert file.head.dialect == Dialect(0, "semicolon", "comma", 1, encoding)


def test_the_head_says_the_dialect_that_was_found():
    file = read_raw(("\ufeff" + text("Bench 4", "", "t;u;x")).encode(), "run.csv")
    assert file.head.dialect == Dialect(2, "semicolon", "comma", 3, "utf-8")
    assert file.head.lines[:4] == ("\ufeffBench 4".lstrip("\ufeff"), "", "t;u;x", "0,0000;0,0000;-0,2955")


@pytest.mark.parametrize(
    ("dialect", "code"),
    [
        (Dialect(delimiter="comma", decimal="comma"), "comma-twice"),
        (Dialect(header_rows=500), "bad-rows"),
        (Dialect(header_rows=1, skip_rows=3), "bad-rows"),
        (Dialect(delimiter="pipe", decimal="point"), "no-columns"),
    ],
)
def test_a_dialect_that_cannot_be_is_refused_and_shown_with_the_lines_of_the_file(dialect, code):
    """Where a person describes the file it is a question with the problem; everywhere else an error."""
    content = text("t;u;x").encode()
    with pytest.raises(Unusable) as refused:
        read_raw(content, "run.csv", stated=dialect)
    assert refused.value.code == code
    (file,) = read_or_shown(content, "run.csv", dialect)
    assert (file.columns, file.head.lines[0]) == ((), "t;u;x")
    missing = Draft([file], Answers(serial="SW-1")).missing
    assert [one.key for one in missing] == ["dialect"]
    assert refused.value.what in missing[0].question


def test_a_binary_has_no_dialect(tmp_path):
    np.savez(tmp_path / "run.npz", command=COMMAND, displacement=POSITION)
    units = {"command": "mm", "displacement": "mm"}
    with pytest.raises(Unusable) as refused:
        read_matrix(tmp_path / "run.npz", units=units, sample_rate="100 Hz", dialect={"decimal": "comma"})
    assert (refused.value.code, refused.value.where) == ("bad-dialect", "dialect")


def test_the_library_reads_a_bare_file_in_a_stated_dialect(tmp_path):
    (tmp_path / "run.csv").write_text(text("t;u;x", "1;2;3", "0;0;0", "7;8;9"))
    stated = {"units": {"command": "mm", "displacement": "mm"}, "columns": {"command": "u", "displacement": "x"}}
    dialect = {"header_rows": 4}
    run = read_matrix(tmp_path / "run.csv", **stated, time={"column": "t", "unit": "s"}, dialect=dialect).runs[0]
    np.testing.assert_allclose(run.command, 1e-3 * COMMAND, rtol=1e-12)
    with pytest.raises(Unusable) as refused:
        read_matrix(tmp_path / "run.csv", **stated, sample_rate="1 Hz", dialect={"delimiter": "semi"})
    assert (refused.value.code, refused.value.remedy) == ("unknown-delimiter", "did you mean semicolon?")
