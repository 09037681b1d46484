"""Every file type holds the same matrix."""

from __future__ import annotations

import hashlib
import io

import numpy as np
import pytest
from scipy.io import savemat
from scipy.io.matlab import MatlabObject

from ident.errors import Unusable
from ident.readers import read_matrix, read_table
from ident.readers.dialect import FOUND
from ident.readers.limits import LIMITS


def test_every_file_type_reads_to_the_same_run_in_si(matrix, columns, kind):
    run = read_matrix(matrix.write(kind)).runs[0]
    assert np.allclose(run.command, 1e-3 * columns["u"], rtol=1e-14, atol=0)
    assert np.allclose(run.measured, 9e-4 * np.roll(columns["u"], 2), rtol=1e-13, atol=0)
    assert run.command.dtype == np.float64
    assert run.command.flags.c_contiguous
    assert run.command.flags.owndata
    assert (run.sample_rate, run.gain, run.specimen.stiffness, run.amplitude) == (1000.0, 7.0, 36300.0, 0.00127)
    assert run.units == {"command": "m", "displacement": "m"}


def test_a_column_may_be_given_by_its_number(matrix, columns, kind):
    matrix.change("column: u", "column: 1").change("column: x", "column: 2")
    names = sorted(columns) if kind in ("h5", "mat73") else list(columns)  # HDF5 lists its datasets by name
    assert names == ["t", "u", "x"]
    assert np.allclose(read_matrix(matrix.write(kind)).runs[0].command, 1e-3 * columns["u"], rtol=1e-14, atol=0)


def test_a_missing_column_is_named_with_what_there_is(matrix, kind):
    matrix.change("column: x", "column: nothing")
    with pytest.raises(Unusable, match="there is no column 'nothing'") as refused:
        read_matrix(matrix.write(kind))
    assert refused.value.code == "missing-column"
    assert refused.value.where == "matrix.yaml, run first channels.displacement"
    assert refused.value.what.startswith("there is no column 'nothing' in runs/first.")
    assert "t, " in refused.value.remedy


def test_folder_description_and_archive_are_one_matrix(matrix, kind):
    folder = matrix.write(kind)
    found = [read_matrix(path) for path in (folder, folder / "matrix.yaml", matrix.pack(), matrix.pack("packed/"))]
    raw = (folder / "matrix.yaml").read_bytes() + next((folder / "runs").iterdir()).read_bytes()
    assert {each.data_hash for each in found} == {hashlib.sha256(raw).hexdigest()}
    for each in found[1:]:
        assert np.array_equal(each.runs[0].measured, found[0].runs[0].measured)


@pytest.mark.parametrize("dtype", ["int16", "uint8", "float32", ">f8", "int64"])
def test_any_number_type_becomes_float64(matrix, columns, dtype):
    counts = np.arange(400) % 200
    matrix.columns = {name: counts.astype(dtype) for name in columns}
    assert np.array_equal(read_matrix(matrix.write("npz")).runs[0].command, 1e-3 * counts)


@pytest.mark.parametrize("kind", ["npz", "mat5", "mat73", "h5"])
def test_columns_of_a_matrix_are_named_by_their_number(matrix, columns, kind):
    both = np.column_stack([columns["u"], columns["x"]])
    matrix.columns = {"data": both}
    if kind == "mat73":  # the writer adds a dimension, and MATLAB stores columns first
        import h5py

        matrix.write(kind)
        with h5py.File(matrix.path / "runs/first.mat", "r+") as file:
            del file["data"]
            file["data"] = both.T
            file["data"].attrs["MATLAB_class"] = np.bytes_("double")
    elif kind == "h5":
        import h5py

        matrix.text = matrix.text.replace("first.csv", "first.h5")
        with h5py.File(matrix.path / "runs/first.h5", "w") as file:
            file.create_dataset("data", data=both, chunks=(64, 2), compression="lzf")
    else:
        matrix.write(kind)
    matrix.change("column: u", "column: data/0").change("column: x", "column: data.1").describe()
    assert np.allclose(read_matrix(matrix.path).runs[0].measured, 1e-3 * columns["x"], rtol=1e-14, atol=0)


@pytest.mark.parametrize("kind", ["npz", "mat5", "h5"])
def test_rows_are_signals_where_a_matrix_is_ten_times_as_wide_as_high(matrix, columns, kind):
    """As the block To File of Simulink saves them, the time first; any number of samples."""
    rows = np.stack([columns["t"], columns["u"], columns["x"]])
    matrix.columns = {"data": rows}
    matrix.change("column: u", "column: data/1").change("column: x", "column: data/2")
    run = read_matrix(matrix.write(kind)).runs[0]
    assert np.allclose(run.command, 1e-3 * columns["u"], rtol=1e-14, atol=0)


def test_a_text_may_be_called_a_log(matrix, columns):
    matrix.write("csv")
    (matrix.path / "runs/first.csv").rename(matrix.path / "runs/first.log")
    matrix.change("first.csv", "first.log").describe()
    assert np.allclose(read_matrix(matrix.path).runs[0].command, 1e-3 * columns["u"], rtol=1e-14, atol=0)


def test_the_columns_of_a_matrix_are_its_signals_up_to_nine_times_its_height(matrix, columns):
    matrix.columns = {"data": np.tile(columns["u"][:40], (40, 9))}
    table = read_table(next((matrix.write("npz") / "runs").iterdir()).read_bytes(), "f.npz", FOUND, LIMITS)
    assert len(table.names) == 360


def test_fields_of_a_structure_and_groups_are_found_by_their_last_name(matrix, columns):
    from nptdms import ChannelObject, TdmsWriter
    from scipy.io import savemat

    matrix.change("first.csv", "first.mat").describe()
    savemat(matrix.path / "runs/first.mat", {"log": dict(columns)}, do_compression=True)
    assert np.allclose(read_matrix(matrix.path).runs[0].command, 1e-3 * columns["u"], rtol=1e-14, atol=0)
    matrix.change("column: u", "column: log.u").describe()
    assert np.allclose(read_matrix(matrix.path).runs[0].command, 1e-3 * columns["u"], rtol=1e-14, atol=0)
    matrix.change("first.mat", "first.tdms").change("log.u", "u").describe()
    with TdmsWriter(matrix.path / "runs/first.tdms") as writer:
        writer.write_segment([ChannelObject(group, name, columns[name]) for group in "ab" for name in "ux"])
    with pytest.raises(Unusable) as refused:
        read_matrix(matrix.path)
    assert refused.value.code == "ambiguous-column"


def test_two_runs_may_take_parts_of_one_file(matrix, columns):
    second = matrix.text.partition("  - id: first")[2].replace("gain: 7", "rows: [100, 400]")
    matrix.change("gain: 7", "rows: [0, 100]")
    matrix.text += "  - id: second" + second
    found = read_matrix(matrix.write()).runs
    assert [run.length for run in found] == [100, 300]
    assert np.array_equal(np.concatenate([run.command for run in found]), 1e-3 * columns["u"])


def test_rows_beyond_the_file_are_refused(matrix):
    with pytest.raises(Unusable) as refused:
        read_matrix(matrix.change("gain: 7", "rows: [0, 401]").write())
    assert str(refused.value) == (
        "matrix.yaml, run first rows: [0, 401] ends after the last sample of runs/first.csv, which has 400; "
        "write [0, 400]"
    )
    with pytest.raises(Unusable, match=r"give a part of \[0, 400\]"):
        read_matrix(matrix.change("rows: [0, 401]", "rows: [400, 500]").write())


def test_scale_offset_and_invert_act_in_this_order(matrix, columns):
    matrix.change("{column: u, unit: mm}", "{column: u, unit: mm, scale: 2, offset: 0.5, invert: true}")
    assert np.allclose(read_matrix(matrix.write()).runs[0].command, -1e-3 * (2 * columns["u"] + 0.5), rtol=1e-13)
    matrix.change("offset: 0.5", "offset: 0.5 cm").change("invert: true", "invert: false").describe()
    assert np.allclose(read_matrix(matrix.path).runs[0].command, 1e-3 * (2 * columns["u"] + 5), rtol=1e-13)


def test_a_type_that_nobody_can_read_is_refused_with_the_list(matrix):
    matrix.change("first.csv", "first.rpc").describe()
    (matrix.path / "runs/first.rpc").write_bytes(b"PK")
    with pytest.raises(Unusable, match=r"\.parquet") as refused:
        read_matrix(matrix.path)
    assert refused.value.code == "unknown-type"


def test_an_object_of_iddata_has_its_input_its_output_and_its_rate():
    """As the System Identification Toolbox saves it: an object of an old class whose samples stand in cells."""
    cell = np.empty((1, 1), object)
    held = {}
    for field, samples in (("InputData", np.repeat([50, 80], 20)), ("OutputData", np.linspace(2.0, 38.0, 40))):
        held[field] = cell.copy()
        held[field][0, 0] = samples[:, None]
    fields = [(name, object) for name in (*held, "Ts", "InputName")]
    made = np.empty((1, 1), fields)
    made[0, 0] = (*held.values(), np.array([[0.01]]), "u1")
    file = io.BytesIO()
    savemat(file, {"pump": MatlabObject(made, "iddata")})
    table = read_table(file.getvalue(), "pump.mat", FOUND, LIMITS)
    assert table.rate == pytest.approx(100.0)
    numbers = [table.number(name, "") for name in ("InputData", "OutputData")]
    for loaded, field in zip(table.load(numbers), held, strict=True):
        np.testing.assert_array_equal(loaded, held[field][0, 0].ravel())
