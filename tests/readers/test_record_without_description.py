"""A record without a matrix.yaml: what its caller states goes the way of a description, and nothing is guessed."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from ident.errors import Unusable
from ident.readers import from_arrays, from_table, read_matrix

N = 64
U, X = np.sin(np.arange(N)), np.sin(np.arange(N) - 0.5)
UNITS = {"command": "mm", "displacement": "in"}


@pytest.fixture
def file(tmp_path):
    """A file with a column of time, whose other columns are called as nobody's channels."""
    path = tmp_path / "kp7.csv"
    rows = "".join(f"{k / 1000},{u!r},{x!r}\n" for k, (u, x) in enumerate(zip(U.tolist(), X.tolist(), strict=True)))
    path.write_text("t,u,x\n" + rows)
    return path


COLUMNS = {"command": "u", "displacement": "x"}


def test_file_arrays_and_table_of_one_record_are_one_run(file):
    stated = {"units": UNITS, "columns": COLUMNS, "time": {"column": "t", "unit": "s"}, "gain": 7, "id": "a"}
    columns = {"t": np.arange(N) / 1000, "u": U, "x": X}
    read = [
        read_matrix(file, **stated),
        read_matrix(str(file), **stated),
        from_arrays(columns, **stated),
        from_table(pa.table(columns), **stated),
    ]
    for matrix in read:
        (run,) = matrix.runs
        np.testing.assert_allclose(run.command, 1e-3 * U, rtol=1e-12)
        np.testing.assert_allclose(run.measured, 0.0254 * X, rtol=1e-12)
        assert run.sample_rate == pytest.approx(1000)
        assert (run.gain, run.id, run.units) == (7, "a", {"command": "m", "displacement": "m"})
    assert read[2].data_hash == read[3].data_hash != read[0].data_hash


class Stream:
    """A table of a library that only hands its columns on."""

    def __init__(self, table):
        self.__arrow_c_stream__ = table.__arrow_c_stream__


def test_whatever_speaks_arrow_is_a_table():
    table = pa.table({"command": U, "displacement": X})
    matrix = from_table(Stream(table), units=UNITS, sample_rate="1 kHz")
    np.testing.assert_array_equal(matrix.runs[0].command, 1e-3 * U)
    with pytest.raises(Unusable, match=r"dict does not speak __arrow_c_stream__.*from_arrays"):
        from_table({"command": U}, units=UNITS, sample_rate="1 kHz")


@pytest.mark.parametrize(
    ("stated", "said"),
    [
        ({}, "make a data set of it: servoident init .*state them, as units=.*the file has t, u, x"),
        ({"units": UNITS, "columns": COLUMNS}, "neither sample_rate nor time is given"),
        ({"units": {"command": "mm"}, "columns": COLUMNS, "sample_rate": "1 kHz"}, "no unit of displacement is stated"),
        ({"units": UNITS, "sample_rate": "1 kHz"}, "there is no column 'command'"),
        ({"units": UNITS, "columns": COLUMNS, "sample_rate": "1000"}, "'?1000'? has no unit"),
        ({"units": {**UNITS, "command": "furlong"}, "columns": COLUMNS, "sample_rate": "1 kHz"}, "'furlong' is not"),
        ({"units": UNITS, "columns": COLUMNS, "sample_rate": "1 kHz", "gian": 7}, "unknown key 'gian'"),
        ({"units": UNITS, "columns": COLUMNS, "sample_rate": "1 kHz", "gain": 0}, "the loop is open"),
    ],
)
def test_what_is_missing_or_wrong_is_said_with_its_remedy(file, stated, said):
    with pytest.raises(Unusable, match=said):
        read_matrix(file, **stated)


def test_an_array_of_two_dimensions_and_one_of_words_are_refused():
    for wrong, said in ((np.ones((N, 2)), "has the shape"), (np.array(["a"] * N), "not numbers")):
        with pytest.raises(Unusable, match=said):
            from_arrays({"command": wrong, "displacement": X}, units=UNITS, sample_rate="1 kHz")


def test_records_of_one_actuator_add_up(file):
    stated = {"units": UNITS, "columns": COLUMNS, "sample_rate": "1 kHz"}
    first, second = read_matrix(file, **stated), read_matrix(file, **stated, id="kp9", gain=9)
    both = first + second
    assert [run.id for run in both.runs] == ["kp7", "kp9"]
    assert len({first.data_hash, second.data_hash, both.data_hash}) == 3
    with pytest.raises(Unusable, match="two runs are called 'kp7'"):
        first + first
    with pytest.raises(Unusable, match="actuators unnamed and B differs"):
        first + read_matrix(file, **stated, id="b", actuator={"serial": "B"})


def test_nothing_is_stated_of_a_whole_matrix(tmp_path):
    with pytest.raises(Unusable, match="units is stated of a whole matrix"):
        read_matrix(tmp_path, units=UNITS)
